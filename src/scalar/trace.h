// The nearest hit of a ray, and whether it hits anything, over every primitive.
#ifndef SHEAF_SCALAR_TRACE_H_
#define SHEAF_SCALAR_TRACE_H_

#include "simd/primitives.h"
#include "simd/query.h"
#include "src/scalar/primitives.h"
#include "src/scalar/ray.h"

namespace sheaf::scalar {

// Calls f(hit) for the primitives of a kind that the ray hits, until f returns false.
template <typename Real, typename Arrays, typename F>
SHEAF_INLINE void ForEachHit(const Ray<Real>& ray, const RayTerms<Real>& terms,
                             const Arrays& arrays, F f) {
  for (std::uint32_t i = 0; i < arrays.count; ++i) {
    if (const auto hit = HitPrimitive(ray, terms, arrays, i)) {
      if (!f(*hit)) return;
    }
  }
}

// Equal t: the lowest primitive id wins, so that the order of tests cannot change a picture.
template <typename Real>
Hit<Real> TraceClosest(const GeometryView<Real>& geometry, Ray<Real> ray) {
  MakeFinite(ray);
  Hit<Real> closest{ray.t_max};
  if (!IsTraceable(ray)) return closest;
  const RayTerms<Real> terms(ray);
  ForEachKind(geometry, [&](const auto& arrays) {
    ForEachHit(ray, terms, arrays, [&](const Hit<Real>& hit) {
      if (hit.t < closest.t || hit.primitive < closest.primitive) closest = hit;
      // Lowering t_max to the closest hit so far keeps the interval test and the tie-break apart.
      ray.t_max = closest.t;
      return true;
    });
  });
  return closest;
}

template <typename Real>
bool TraceOccluded(const GeometryView<Real>& geometry, Ray<Real> ray) {
  MakeFinite(ray);
  if (!IsTraceable(ray)) return false;
  const RayTerms<Real> terms(ray);
  bool is_occluded = false;
  ForEachKind(geometry, [&](const auto& arrays) {
    if (is_occluded) return;
    ForEachHit(ray, terms, arrays, [&](const Hit<Real>&) {
      is_occluded = true;
      return false;
    });
  });
  return is_occluded;
}

}  // namespace sheaf::scalar

#endif  // SHEAF_SCALAR_TRACE_H_
