// Fits a tree to primitives that have moved: its shape stays, its boxes are made anew.
#ifndef SHEAF_BVH_REFIT_TREE_H_
#define SHEAF_BVH_REFIT_TREE_H_

#include <cstdint>
#include <vector>

#include "simd/primitives.h"
#include "simd/tree.h"
#include "src/bvh/tree.h"

namespace sheaf::bvh {

// Where primitives lie in the arrays of a geometry, by their ids, which are below their number.
class PlacesById {
 public:
  template <typename Real>
  explicit PlacesById(const GeometryView<Real>& geometry);

  // As MakePlace has it.
  std::uint32_t operator[](std::uint32_t id) const {
    return places_.empty() ? MakePlace(only_kind_, id) : places_[id];
  }

 private:
  PrimitiveKind only_kind_ = PrimitiveKind{};
  std::vector<std::uint32_t> places_;  // empty where all are of one kind: in the order of their ids
};

// Whether the tree is over the primitives of the geometry, `hittable` of which a ray can hit.
template <typename Real>
bool IsTreeOver(const GeometryView<Real>& geometry, std::uint32_t hittable,
                const PlacesById& places, const Tree<Real>& tree);

// Writes the primitives into the leaves of a tree over them, and boxes around them. What is not
// moved leaves a tree that BuildTree has just made as it is, to the bit. No coordinate is infinite.
// Runs on the threads of the caller's arena.
template <typename Real>
void RefitTree(const GeometryView<Real>& geometry, const PlacesById& places, Tree<Real>& tree);

// What a ray through the root's box costs, by the surface area heuristic (Goldsmith and Salmon
// 1987) and the costs of find_split.h; giants, which cost every tree the same, are left out. It
// does not depend on the number of threads. 0 where there is nothing else.
template <typename Real>
double CostOfTree(const Tree<Real>& tree);

}  // namespace sheaf::bvh

#endif  // SHEAF_BVH_REFIT_TREE_H_
