// New boxes for an old tree, whose primitives have moved.
#ifndef SHEAF_BVH_REFIT_TREE_H_
#define SHEAF_BVH_REFIT_TREE_H_

#include <cstdint>
#include <vector>

#include "simd/tree.h"
#include "src/bvh/tree.h"

namespace sheaf {

// What rays pay for a tree by the surface area heuristic: of each node and each leaf the cost times
// the area of its box, in areas of the whole; giants, which cost every tree the same, are left out.
// 0 where the whole has no area.
template <typename Real>
double CostOfTree(const TreeView<Real>& tree);

// Where the primitives of an id lie in the arrays of their kind: those of an object lie in turn.
struct ObjectIndex {
  std::vector<std::uint32_t> first;  // primitive of each object, and the number of all
  std::vector<std::uint32_t> index;  // of it in its kind's arrays
};

// Whether exactly the primitives of `geometry` without NaN are in the tree.
template <typename Real>
bool HasSamePrimitives(const TreeView<Real>& tree, const GeometryView<Real>& geometry,
                       const ObjectIndex& objects);

// Takes the fields of all primitives from `geometry`, none of which is infinite, and fits boxes and
// orders to them. For trees with HasSamePrimitives. It is then one that FindTreeDefect finds sound,
// and does not depend on the number of threads, which are those of the caller's arena.
template <typename Real>
void RefitTree(const GeometryView<Real>& geometry, const ObjectIndex& objects, Tree<Real>& tree);

}  // namespace sheaf

#endif  // SHEAF_BVH_REFIT_TREE_H_
