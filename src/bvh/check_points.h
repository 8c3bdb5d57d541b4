// Arrays of points: which is missing, and parts of them.
#ifndef SHEAF_BVH_CHECK_POINTS_H_
#define SHEAF_BVH_CHECK_POINTS_H_

#include <cstddef>

#include "sheaf/error.h"
#include "sheaf/queries.h"
#include "src/bvh/check_arrays.h"
#include "src/bvh/ray_block.h"

namespace sheaf {

template <typename Real>
Status CheckPoints(const PointArraysOf<Real>& points, std::size_t count) {
  if (count == 0) return Done{};
  if (!points.x) return NullArray("x");
  if (!points.y) return NullArray("y");
  if (!points.z) return NullArray("z");
  return Done{};
}

// The points from number `first` on.
template <typename Real>
PointArraysOf<Real> SkipPoints(PointArraysOf<Real> points, std::size_t first) {
  const std::size_t bytes = StrideOf<Real>(points.stride) * first;
  for (const Real** array : {&points.x, &points.y, &points.z}) {
    *array = reinterpret_cast<const Real*>(reinterpret_cast<const std::byte*>(*array) + bytes);
  }
  return points;
}

}  // namespace sheaf

#endif  // SHEAF_BVH_CHECK_POINTS_H_
