// Rays against primitives of any kind: one overload a kind of each function.
#ifndef SHEAF_SCALAR_PRIMITIVES_H_
#define SHEAF_SCALAR_PRIMITIVES_H_

#include <optional>

#include "simd/primitives.h"
#include "src/scalar/disk.h"
#include "src/scalar/ray.h"
#include "src/scalar/sphere.h"
#include "src/scalar/surface.h"
#include "src/scalar/triangle.h"

namespace sheaf::scalar {

// What the tests of a ray share.
template <typename Real>
struct RayTerms {
  TriangleShear<Real> shear;

  explicit RayTerms(const Ray<Real>& ray) : shear(ShearOf(ray.direction)) {}
};

// HitPrimitive: the hit of primitive `i` in [t_min, t_max], with t, u and v.

template <typename Real>
SHEAF_INLINE std::optional<Hit<Real>> HitPrimitive(const Ray<Real>& ray,
                                                   const RayTerms<Real>& terms,
                                                   const TriangleArrays<Real>& triangles,
                                                   std::uint32_t i) {
  const auto hit = HitTriangle(ray, terms.shear, triangles, i);
  if (!hit) return std::nullopt;
  return Hit<Real>{hit->t, triangles.id[i], hit->u, hit->v};
}

template <typename Real>
SHEAF_INLINE std::optional<Hit<Real>> HitPrimitive(const Ray<Real>& ray,
                                                   const RayTerms<Real>& /*terms*/,
                                                   const SphereArrays<Real>& spheres,
                                                   std::uint32_t i) {
  const auto hit = HitSphere(ray, spheres, i);
  if (!hit) return std::nullopt;
  return Hit<Real>{hit->t, spheres.id[i], hit->leaves, hit->t_rest};
}

template <typename Real>
SHEAF_INLINE std::optional<Hit<Real>> HitPrimitive(const Ray<Real>& ray,
                                                   const RayTerms<Real>& /*terms*/,
                                                   const DiskArrays<Real>& disks, std::uint32_t i) {
  const auto hit = HitDisk(ray, disks, i);
  if (!hit) return std::nullopt;
  return Hit<Real>{hit->t, disks.id[i], hit->u, hit->v};
}

// SurfaceAt: what the ray sees of primitive `i`, which it hits.

template <typename Real>
Surface<Real> SurfaceAt(const Ray<Real>& ray, const Hit<Real>& hit,
                        const TriangleArrays<Real>& triangles, std::uint32_t i) {
  return TriangleSurface(ray, hit, triangles, i);
}

template <typename Real>
Surface<Real> SurfaceAt(const Ray<Real>& ray, const Hit<Real>& hit,
                        const SphereArrays<Real>& spheres, std::uint32_t i) {
  return SphereSurface(ray, hit, spheres, i);
}

template <typename Real>
Surface<Real> SurfaceAt(const Ray<Real>& ray, const Hit<Real>& hit, const DiskArrays<Real>& disks,
                        std::uint32_t i) {
  return DiskSurface(ray, hit, disks, i);
}

template <typename Real>
Surface<Real> SurfaceAt(const Ray<Real>& ray, const Hit<Real>& hit,
                        const GeometryView<Real>& geometry, std::uint32_t place) {
  Surface<Real> surface{};
  ForEachKind(geometry, [&](const auto& arrays) {
    if (arrays.kKind == KindOf(place)) surface = SurfaceAt(ray, hit, arrays, IndexIn(place));
  });
  return surface;
}

}  // namespace sheaf::scalar

#endif  // SHEAF_SCALAR_PRIMITIVES_H_
