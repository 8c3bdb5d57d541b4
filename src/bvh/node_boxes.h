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

// Absent children come last.
inline std::uint32_t CountChildren(const TreeNode& node) {
  const auto* const end = std::find(node.child, node.child + kTreeWidth, kNoChild);
  return static_cast<std::uint32_t>(end - node.child);
}

inline Box4 BoxOfNode(const TreeNode& node) {
  Box4 box;
  for (std::uint32_t i = 0; i < CountChildren(node); ++i) box.Include(ChildBox(node, i));
  return box;
}

}  // namespace sheaf::bvh

#endif  // SHEAF_BVH_NODE_BOXES_H_
