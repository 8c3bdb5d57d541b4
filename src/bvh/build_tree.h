// Builds the tree over primitives: binned SAH, top down, eight children at once.
#ifndef SHEAF_BVH_BUILD_TREE_H_
#define SHEAF_BVH_BUILD_TREE_H_

#include "sheaf/error.h"
#include "simd/tree.h"
#include "src/bvh/tree.h"

namespace sheaf {

// Fails with kUsage where there are more than kMaxTreePrimitives of a kind.
Status CheckCounts(const CountsByKind<std::uint64_t>& counts);

// Primitives with a NaN (a sphere's radius, a triangle's vertex) are never hit and left out. The
// tree depends on the primitives alone, not on `threads` (0: one a core). Fails as
// CheckCounts does, and with kUsage where a coordinate is infinite.
template <typename Real>
Result<Tree<Real>> BuildTree(const GeometryView<Real>& geometry, int threads = 0);

}  // namespace sheaf

#endif  // SHEAF_BVH_BUILD_TREE_H_
