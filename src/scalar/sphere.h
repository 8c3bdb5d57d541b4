// A sphere: where a ray hits it, after Haines, Guenther, Akenine-Moeller, "Precision Improvements
// for Ray/Sphere Intersection" (Ray Tracing Gems, chapter 7), computed wide and rounded once.
//
// In float alone this test misjudges 3 % of near-tangent hits at 10^4 radii; wide, t is within an
// ULP of the exact root at any distance (docs/numerics.md).
#ifndef SHEAF_SCALAR_SPHERE_H_
#define SHEAF_SCALAR_SPHERE_H_

#include <cmath>
#include <optional>

#include "simd/primitives.h"
#include "simd/query.h"
#include "simd/roundoffs.h"
#include "src/scalar/ray.h"
#include "src/scalar/surface.h"

namespace sheaf::scalar {

// Parameters where a line meets a sphere, near <= far, before rounding. A root may be NaN where the
// origin itself is the point of tangency.
template <typename Real>
struct SphereRoots {
  Wide<Real> near, far;
};

// Nothing where the line misses. A NaN radius always misses.
template <typename Real>
SHEAF_INLINE std::optional<SphereRoots<Real>> IntersectSphere(Vec3<Real> origin,
                                                              Vec3<Real> direction,
                                                              Vec3<Real> center, Real radius) {
  using W = Wide<Real>;
  const Vec3<W> f = origin.template To<W>() - center.template To<W>();
  const Vec3<W> d = direction.template To<W>();
  const W r = static_cast<W>(radius);

  // The discriminant from the vector to the closest point keeps its bits where |f| >> r.
  const W a = Dot(d, d);
  const W b = -Dot(f, d);
  const Vec3<W> l = f + d * (b / a);
  const W delta = r * r - Dot(l, l);
  if (!(delta >= 0)) return std::nullopt;  // NaN misses

  // The root without cancellation; the other one from the product of the roots.
  const W root = std::sqrt(a * delta);
  const W c = Dot(f, f) - r * r;
  if (b >= 0) {
    const W q = b + root;
    return SphereRoots<Real>{c / q, q / a};
  }
  const W q = b - root;
  return SphereRoots<Real>{q / a, c / q};
}

template <typename Real>
struct SphereHit {
  Real t;
  Real leaves;  // 1, or 0 where the ray enters
  Real t_rest;  // what rounding took from t
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

// With `t_rest`, the root has bits enough for a normal without the rounding of t.
template <typename Real>
Surface<Real> SphereSurface(const Ray<Real>& ray, const Hit<Real>& hit,
                            const SphereArrays<Real>& spheres, std::uint32_t i) {
  using W = Wide<Real>;
  const Vec3<Real> center = {spheres.center_x[i], spheres.center_y[i], spheres.center_z[i]};
  const Vec3<W> c = center.template To<W>();
  const Vec3<W> d = ray.direction.template To<W>();
  const SphereHit<Real> sphere = {hit.t, hit.u, hit.v};
  const bool leaves = sphere.leaves != 0;
  const W t = static_cast<W>(sphere.t) + static_cast<W>(sphere.t_rest);
  const Vec3<W> out = NormalizeWide((ray.origin.template To<W>() - c) + d * t);
  const W r = static_cast<W>(spheres.radius[i]);
  const Vec3<W> position = c + out * r;

  Surface<Real> surface;
  surface.position = position.template To<Real>();
  surface.shadow_end = surface.position;
  surface.normal = (leaves ? -out : out).template To<Real>();
  surface.face = surface.normal;
  surface.direction = ray.direction;
  // Where c + r n cancels, the error is that of its wide terms.
  const Vec3<W> terms = {std::abs(c.x) + r, std::abs(c.y) + r, std::abs(c.z) + r};
  surface.offset =
      static_cast<Real>(static_cast<W>(kPositionRoundoffs<Real>) * AbsDot(out, position) +
                        kTermRoundoffs<W> * AbsDot(out, terms));
  surface.source = hit.primitive | (leaves ? kInsideBit : 0);
  return surface;
}

}  // namespace sheaf::scalar

#endif  // SHEAF_SCALAR_SPHERE_H_
