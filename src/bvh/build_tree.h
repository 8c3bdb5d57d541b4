// Builds the tree over spheres and triangles: binned SAH, top down, eight children at once.
#ifndef SHEAF_BVH_BUILD_TREE_H_
#define SHEAF_BVH_BUILD_TREE_H_

#include "sheaf/error.h"
#include "simd/tree.h"
#include "src/bvh/tree.h"

namespace sheaf {

// Primitives with a NaN (a sphere's radius, a triangle's vertex) are never hit and left out. The
// tree depends on the primitives alone, not on `threads` (0: one a core). Fails with kUsage where
// there are more than kMaxTreePrimitives of a kind or a coordinate is infinite.
template <typename Real>
Result<Tree<Real>> BuildTree(const GeometryView<Real>& geometry, int threads = 0);

}  // namespace sheaf

#endif  // SHEAF_BVH_BUILD_TREE_H_
