// Ray against triangle: Woop, Benthin, Wald, "Watertight Ray/Triangle Intersection" (JCGT 2013),
// unfused.
//
// An edge function is a difference of two products of the same four numbers for both triangles at
// the edge. Rounding is monotonic, so its sign is exact whenever it is not zero, and zero counts as
// inside on both sides: no ray slips between them, at edges or vertices. A fused multiply-add
// breaks this. Different from the paper: no double-precision fallback (it could only refuse hits
// within rounding of a silhouette), no winding swap (either sign counts), t by two divisions and
// from scaled edge functions, so that no product over- or underflows, and no hit outside the
// triangle's own extent.
#ifndef SHEAF_SCALAR_INTERSECT_TRIANGLE_H_
#define SHEAF_SCALAR_INTERSECT_TRIANGLE_H_

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <type_traits>

#include "simd/roundoffs.h"
#include "src/scalar/ray.h"

namespace sheaf::scalar {

// The ray's part of the test: its dominant axis, and the shear that makes that axis the ray.
template <typename Real>
struct TriangleShear {
  int kx, ky, kz;
  Real sx, sy, dz;
};

template <typename Real>
TriangleShear<Real> ShearOf(Vec3<Real> direction) {
  const Real ax = std::abs(direction.x), ay = std::abs(direction.y), az = std::abs(direction.z);
  const int kz = ax >= ay && ax >= az ? 0 : ay >= az ? 1 : 2;
  const int kx = (kz + 1) % 3, ky = (kz + 2) % 3;
  const Real dz = direction[kz];
  return {kx, ky, kz, direction[kx] / dz, direction[ky] / dz, dz};
}

template <typename Real>
struct TriangleHit {
  Real t;
  Real u, v;  // barycentric weights of the second and third vertex
};

template <typename Real>
struct Extent {
  Real low, high;
};

// The extent of three coordinates relative to the ray's origin, with slack for the rounding of a
// hit.
template <typename Real>
Extent<Real> ExtentOf(Real a, Real b, Real c) {
  const Real low = std::min(std::min(a, b), c), high = std::max(std::max(a, b), c);
  const Real slack = std::max(-low, high) * kExtentRoundoffs<Real>;
  return {low - slack, high + slack};
}

// A power of two that takes a positive or negative normal number to [2, 4): what is left of the
// exponent's bits.
template <typename Real>
Real ScaleOf(Real x) {
  using Bits = std::conditional_t<sizeof(Real) == 4, std::uint32_t, std::uint64_t>;
  const Bits exponent = std::bit_cast<Bits>(std::numeric_limits<Real>::infinity());
  return std::bit_cast<Real>(~std::bit_cast<Bits>(x) & exponent);
}

// Whether the sheared triangle, of which these are the coordinates along one axis, lies beside the
// ray.
template <typename Real>
bool IsBeside(Real a, Real b, Real c) {
  return (a > 0 && b > 0 && c > 0) || (a < 0 && b < 0 && c < 0);
}

template <typename Real>
bool IsOutside(Extent<Real> extent, Real position) {
  return position < extent.low || position > extent.high;
}

// For a ray in the triangle's plane, all but, the edge functions are zero or rounding error: t is
// somewhere between the vertices along kz, but the ray may be nowhere near the triangle there. t
// then moves to where the ray meets the triangle's box, so that no box around the triangle, of
// whatever tree, excludes the hit; a ray that does not meet the box misses, which gives NaN. (It
// opens no gap: what Woop's argument needs are hits of triangles that the ray does meet, once
// sheared, and the slack covers the rounding of that.)
template <typename Real>
Real KeepInExtent(Real t, Vec3<Real> direction, const TriangleShear<Real>& shear, Vec3<Real> a,
                  Vec3<Real> b, Vec3<Real> c) {
  constexpr Real kMiss = std::numeric_limits<Real>::quiet_NaN();
  Real enter = -std::numeric_limits<Real>::infinity(), leave = -enter;
  for (const int axis : {shear.kx, shear.ky, shear.kz}) {
    const Extent<Real> extent = ExtentOf(a[axis], b[axis], c[axis]);
    if (direction[axis] == 0) {
      if (IsOutside(extent, Real(0))) return kMiss;
      continue;
    }
    const bool forward = direction[axis] > 0;
    enter = std::max(enter, (forward ? extent.low : extent.high) / direction[axis]);
    leave = std::min(leave, (forward ? extent.high : extent.low) / direction[axis]);
  }
  if (!(enter <= leave)) return kMiss;
  t = t < enter ? enter : t;  // false for NaN, which stays
  return t > leave ? leave : t;
}

template <typename Real>
SHEAF_INLINE std::optional<TriangleHit<Real>> IntersectTriangle(Vec3<Real> origin,
                                                                Vec3<Real> direction,
                                                                const TriangleShear<Real>& shear,
                                                                const Vec3<Real> (&vertex)[3]) {
  const Vec3<Real> a = vertex[0] - origin, b = vertex[1] - origin, c = vertex[2] - origin;
  const auto [kx, ky, kz, sx, sy, dz] = shear;
  const Real ax = a[kx] - sx * a[kz], ay = a[ky] - sy * a[kz];
  const Real bx = b[kx] - sx * b[kz], by = b[ky] - sy * b[kz];
  const Real cx = c[kx] - sx * c[kz], cy = c[ky] - sy * c[kz];

  const Real u = cx * by - cy * bx;
  const Real v = ax * cy - ay * cx;
  const Real w = bx * ay - by * ax;
  // Every comparison is false for NaN: such a triangle or ray misses.
  const bool inside = (u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0);
  const Real det = (u + v) + w;
  // A denormal det counts as 0.
  if (!inside || !(std::abs(det) >= std::numeric_limits<Real>::min())) return std::nullopt;
  // Two edge functions that round to 0 would let the third alone decide, which holds for a ray far
  // beside a triangle in whose plane it runs.
  if (IsBeside(ax, bx, cx) || IsBeside(ay, by, cy)) return std::nullopt;

  // A power of two rounds nothing. Without it, products of three lengths would leave the range of
  // float where lengths leave 2^-42 to 2^42.
  const Real scale = ScaleOf(det);
  const Real scaled_t = ((u * scale) * a[kz] + (v * scale) * b[kz]) + (w * scale) * c[kz];
  Real t = (scaled_t / (det * scale)) / dz;
  // Along kz t is a mean of the vertices already.
  if (IsOutside(ExtentOf(a[kx], b[kx], c[kx]), t * direction[kx]) ||
      IsOutside(ExtentOf(a[ky], b[ky], c[ky]), t * direction[ky])) {
    t = KeepInExtent(t, direction, shear, a, b, c);
    if (std::isnan(t)) return std::nullopt;
  }
  return TriangleHit<Real>{t, v / det, w / det};
}

}  // namespace sheaf::scalar

#endif  // SHEAF_SCALAR_INTERSECT_TRIANGLE_H_
