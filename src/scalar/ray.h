// A ray, what it hits, and which rays can hit anything at all.
#ifndef SHEAF_SCALAR_RAY_H_
#define SHEAF_SCALAR_RAY_H_

#include <cstdint>

#include "simd/query.h"
#include "simd/streams.h"
#include "src/core/vec3.h"

namespace sheaf::scalar {

template <typename Real>
struct Ray {
  Vec3<Real> origin;
  Vec3<Real> direction;                 // any length; t counts in lengths of it
  std::uint32_t source = kNoPrimitive;  // see simd/query.h
  Real t_min = kDefaultTMin<Real>;
  Real t_max = kDefaultTMax<Real>;
  std::uint32_t instance = kNoInstance;  // that the source belongs to
};

// Ray `i` of a stream, with the interval of everything in front.
template <typename Real>
Ray<Real> RayAt(const RayView<Real>& rays, std::uint32_t i) {
  return {{rays.origin_x[i], rays.origin_y[i], rays.origin_z[i]},
          {rays.direction_x[i], rays.direction_y[i], rays.direction_z[i]},
          rays.source ? rays.source[i] : kNoPrimitive};
}

// Writes what a stream has of a ray.
template <typename Real>
void StoreRay(const Ray<Real>& ray, const RayOutput<Real>& rays, std::uint32_t i) {
  rays.origin_x[i] = ray.origin.x;
  rays.origin_y[i] = ray.origin.y;
  rays.origin_z[i] = ray.origin.z;
  rays.direction_x[i] = ray.direction.x;
  rays.direction_y[i] = ray.direction.y;
  rays.direction_z[i] = ray.direction.z;
  if (rays.source) rays.source[i] = ray.source;
}

template <typename Real>
struct Hit {
  Real t;
  std::uint32_t primitive = kNoPrimitive;
  Real u = 0, v = 0;  // by the kind of primitive: see HitFields of simd/streams.h
  std::uint32_t instance = kNoInstance;  // that was hit
};

// An infinite interval admits every finite t. Stays NaN for NaN.
template <typename Real>
void MakeFinite(Ray<Real>& ray) {
  if (ray.t_min < -kDefaultTMax<Real>) ray.t_min = -kDefaultTMax<Real>;
  if (ray.t_max > kDefaultTMax<Real>) ray.t_max = kDefaultTMax<Real>;
}

template <typename Real>
bool IsFinite(Vec3<Real> a) {
  // x - x is 0 for finite x and NaN otherwise.
  return a.x - a.x == 0 && a.y - a.y == 0 && a.z - a.z == 0;
}

// A ray with a component that is not finite, without a direction or with an empty interval misses
// everything. t_min <= t_max is false for NaN.
template <typename Real>
SHEAF_INLINE bool IsTraceable(const Ray<Real>& ray) {
  const bool has_direction = ray.direction.x != 0 || ray.direction.y != 0 || ray.direction.z != 0;
  return IsFinite(ray.origin) && IsFinite(ray.direction) && has_direction && ray.t_min <= ray.t_max;
}

}  // namespace sheaf::scalar

#endif  // SHEAF_SCALAR_RAY_H_
