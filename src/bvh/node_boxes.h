// The boxes in a tree's nodes.
#ifndef SHEAF_BVH_NODE_BOXES_H_
#define SHEAF_BVH_NODE_BOXES_H_

#include <algorithm>
#include <cstdint>

#include "simd/tree.h"
#include "src/bvh/float4.h"

namespace sheaf::bvh {

inline Box4 ChildBox(const TreeNode& node, std::uint32_t child) {
  Box4 box;
  for (int axis = 0; axis < 3; ++axis) {
    box.lower[axis] = node.bounds[axis][child];
    box.upper[axis] = node.bounds[3 + axis][child];
  }
  return box;
}

inline void StoreChild(const Box4& box, std::uint32_t child, TreeNode& node) {
  for (int axis = 0; axis < 3; ++axis) {
    node.bounds[axis][child] = box.lower[axis];
    node.bounds[3 + axis][child] = box.upper[axis];
  }
}

// Around its children. Absent ones have a box of nothing.
inline Box4 BoxOfNode(const TreeNode& node) {
  Box4 box;
  for (int axis = 0; axis < 3; ++axis) {
    box.lower[axis] = *std::min_element(node.bounds[axis], node.bounds[axis] + kTreeWidth);
    box.upper[axis] = *std::max_element(node.bounds[3 + axis], node.bounds[3 + axis] + kTreeWidth);
  }
  return box;
}

}  // namespace sheaf::bvh

#endif  // SHEAF_BVH_NODE_BOXES_H_
