// The nearest hit of a ray, and whether it hits anything, over every primitive.
#ifndef SHEAF_SCALAR_TRACE_H_
#define SHEAF_SCALAR_TRACE_H_

#include "simd/query.h"
#include "simd/tree.h"
#include "src/scalar/intersect_sphere.h"
#include "src/scalar/intersect_triangle.h"
#include "src/scalar/ray.h"

namespace sheaf::scalar {

template <typename Real>
struct Hit {
  Real t;
  std::uint32_t primitive = kNoPrimitive;
  Real u = 0, v = 0;  // see HitFields of simd/streams.h
};

template <typename Real>
struct SphereHit {
  Real t;
  Real u;  // 0: the ray enters, 1: it leaves
  Real v;  // what rounding took from t
};

// The first root of one sphere in [t_min, t_max]; the source sphere shows its far root or nothing.
template <typename Real>
SHEAF_INLINE std::optional<SphereHit<Real>> HitSphere(const Ray<Real>& ray,
                                                      const SphereArrays<Real>& spheres,
                                                      std::uint32_t i) {
  const std::uint32_t id = spheres.id[i];
  if (ray.source == id) return std::nullopt;
  const auto roots = IntersectSphere(
      ray.origin, ray.direction,
      Vec3<Real>{spheres.center_x[i], spheres.center_y[i], spheres.center_z[i]}, spheres.radius[i]);
  if (!roots) return std::nullopt;
  const Real near = static_cast<Real>(roots->near), far = static_cast<Real>(roots->far);
  const auto rest = [](Wide<Real> root, Real t) {
    return static_cast<Real>(root - static_cast<Wide<Real>>(t));
  };
  // A NaN root is in no interval.
  if (ray.source != (id | kInsideBit) && ray.t_min <= near) {
    if (near <= ray.t_max) return SphereHit<Real>{near, Real(0), rest(roots->near, near)};
    return std::nullopt;
  }
  if (ray.t_min <= far && far <= ray.t_max) {
    return SphereHit<Real>{far, Real(1), rest(roots->far, far)};
  }
  return std::nullopt;
}

template <typename Real>
Vec3<Real> TriangleVertex(const TriangleArrays<Real>& triangles, std::uint32_t i, int vertex) {
  return {triangles.vertex[vertex][0][i], triangles.vertex[vertex][1][i],
          triangles.vertex[vertex][2][i]};
}

// The hit of one triangle in [t_min, t_max]; the source triangle is never hit.
template <typename Real>
SHEAF_INLINE std::optional<TriangleHit<Real>> HitTriangle(const Ray<Real>& ray,
                                                          const TriangleShear<Real>& shear,
                                                          const TriangleArrays<Real>& triangles,
                                                          std::uint32_t i) {
  if ((ray.source & ~kInsideBit) == triangles.id[i]) return std::nullopt;
  const Vec3<Real> vertices[3] = {TriangleVertex(triangles, i, 0), TriangleVertex(triangles, i, 1),
                                  TriangleVertex(triangles, i, 2)};
  const auto hit = IntersectTriangle(ray.origin, ray.direction, shear, vertices);
  if (!hit || !(ray.t_min <= hit->t && hit->t <= ray.t_max)) return std::nullopt;
  return TriangleHit<Real>{hit->t, hit->u, hit->v};
}

// Equal t: the lowest primitive id wins, so that the order of tests cannot change a picture.
template <typename Real>
Hit<Real> TraceClosest(const GeometryView<Real>& geometry, Ray<Real> ray) {
  MakeFinite(ray);
  Hit<Real> closest{ray.t_max};
  if (!IsTraceable(ray)) return closest;
  // Lowering t_max to the closest hit so far keeps the interval test and the tie-break apart.
  auto keep = [&](std::uint32_t id, Real t, Real u, Real v) {
    if (t < closest.t || id < closest.primitive) closest = {t, id, u, v};
    ray.t_max = closest.t;
  };
  for (std::uint32_t i = 0; i < geometry.spheres.count; ++i) {
    if (const auto hit = HitSphere(ray, geometry.spheres, i)) {
      keep(geometry.spheres.id[i], hit->t, hit->u, hit->v);
    }
  }
  if (geometry.triangles.count == 0) return closest;
  const TriangleShear<Real> shear = ShearOf(ray.direction);
  for (std::uint32_t i = 0; i < geometry.triangles.count; ++i) {
    if (const auto hit = HitTriangle(ray, shear, geometry.triangles, i)) {
      keep(geometry.triangles.id[i], hit->t, hit->u, hit->v);
    }
  }
  return closest;
}

template <typename Real>
bool TraceOccluded(const GeometryView<Real>& geometry, Ray<Real> ray) {
  MakeFinite(ray);
  if (!IsTraceable(ray)) return false;
  for (std::uint32_t i = 0; i < geometry.spheres.count; ++i) {
    if (HitSphere(ray, geometry.spheres, i)) return true;
  }
  if (geometry.triangles.count == 0) return false;
  const TriangleShear<Real> shear = ShearOf(ray.direction);
  for (std::uint32_t i = 0; i < geometry.triangles.count; ++i) {
    if (HitTriangle(ray, shear, geometry.triangles, i)) return true;
  }
  return false;
}

}  // namespace sheaf::scalar

#endif  // SHEAF_SCALAR_TRACE_H_
