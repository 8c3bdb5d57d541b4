// The owning arrays behind a TreeView.
#ifndef SHEAF_BVH_TREE_H_
#define SHEAF_BVH_TREE_H_

#include <cstddef>

#include "simd/tree.h"
#include "src/bvh/float4.h"
#include "src/core/aligned_array.h"

namespace sheaf {

// The primitives of one kind by leaves: see BlockView.
template <typename Real>
struct PrimitiveBlocks {
  AlignedArray<Real> fields;       // with room for a vector more
  AlignedArray<std::uint32_t> id;  // the same
  std::uint32_t count = 0;
};

// A tree as BuildTree leaves it; see TreeView. Needs none of the arrays it was built from.
template <typename Real>
struct Tree {
  AlignedArray<TreeNode> nodes;
  PrimitiveBlocks<Real> blocks[kKindCount];  // by kind
  std::uint32_t node_count = 0;
  float lower[3], upper[3];          // of all but giants: see TreeView
  float all_lower[3], all_upper[3];  // with them

  PrimitiveBlocks<Real>& of(PrimitiveKind kind) { return blocks[IndexOf(kind)]; }
  const PrimitiveBlocks<Real>& of(PrimitiveKind kind) const { return blocks[IndexOf(kind)]; }
  // Of all primitives, and of all but giants; where there are none, the boxes of none.
  void SetBounds(const bvh::Box4& all, const bvh::Box4& others);
  TreeView<Real> view() const;
  std::size_t bytes() const;  // all arrays
};

// Levels of nodes. Every node comes before its children.
std::uint32_t DepthOf(const TreeNode* nodes, std::uint32_t count);

}  // namespace sheaf

#endif  // SHEAF_BVH_TREE_H_
