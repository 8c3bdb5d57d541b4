// The owning arrays behind a TreeView.
#ifndef SHEAF_BVH_TREE_H_
#define SHEAF_BVH_TREE_H_

#include <cstddef>

#include "simd/tree.h"
#include "src/core/aligned_array.h"

namespace sheaf {

// A tree as BuildTree leaves it; see TreeView. Needs none of the arrays it was built from.
template <typename Real>
struct Tree {
  AlignedArray<TreeNode> nodes;
  AlignedArray<Real> triangles, spheres;               // leaf blocks, with room for a vector more
  AlignedArray<std::uint32_t> triangle_id, sphere_id;  // the same
  std::uint32_t node_count = 0, triangle_count = 0, sphere_count = 0;
  float lower[3], upper[3];

  TreeView<Real> view() const;
  std::size_t bytes() const;  // all arrays
};

}  // namespace sheaf

#endif  // SHEAF_BVH_TREE_H_
