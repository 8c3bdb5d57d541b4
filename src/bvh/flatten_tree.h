// From branches to the arrays of a Tree.
#ifndef SHEAF_BVH_FLATTEN_TREE_H_
#define SHEAF_BVH_FLATTEN_TREE_H_

#include "simd/tree.h"
#include "src/bvh/build_nodes.h"
#include "src/bvh/tree.h"

namespace sheaf::bvh {

// Strings the branches together, depth first; drops each branch once it is copied. Returns the
// number of nodes.
std::uint32_t FlattenNodes(std::unique_ptr<Branch> root, AlignedArray<TreeNode>& nodes);

// Writes the leaf blocks of a tree whose ids are as yet indices into `geometry`, and replaces these
// by ids.
template <typename Real>
void WriteLeaves(const GeometryView<Real>& geometry, Tree<Real>& tree);

}  // namespace sheaf::bvh

#endif  // SHEAF_BVH_FLATTEN_TREE_H_
