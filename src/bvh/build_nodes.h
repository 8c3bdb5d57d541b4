// The nodes of a tree, top down, eight children at once; subtrees side by side.
#ifndef SHEAF_BVH_BUILD_NODES_H_
#define SHEAF_BVH_BUILD_NODES_H_

#include <memory>
#include <vector>

#include "simd/tree.h"
#include "src/bvh/primitive_box.h"

namespace sheaf::bvh {

// One node with its branches, or a whole subtree without any. What is no branch of `nodes` refers
// to leaves and to positions in `nodes`.
struct Branch {
  std::vector<TreeNode> nodes;
  std::unique_ptr<Branch> child[kTreeWidth];
};

// Builds over at least one box; reorders `boxes`. Leaves refer to positions in the arrays that
// `indices` lists by kind, which receive the index of the primitive at each position. Runs on the
// threads of the caller's arena; the result does not depend on them.
std::unique_ptr<Branch> BuildNodes(PrimitiveBoxes& boxes,
                                   std::uint32_t* const (&indices)[kKindCount]);

}  // namespace sheaf::bvh

#endif  // SHEAF_BVH_BUILD_NODES_H_
