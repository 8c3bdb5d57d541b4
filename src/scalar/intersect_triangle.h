// Ray against triangle: Woop, Benthin, Wald, "Watertight Ray/Triangle Intersection" (JCGT 2013),
// unfused.
//
// An edge function is a difference of two products of the same four numbers for both triangles at
// the edge. Rounding is monotonic, so its sign is exact whenever it is not zero, and zero counts as
// inside on both sides: no ray slips between them, at edges or vertices. A fused multiply-add
// breaks this. Different from the paper: no double-precision fallback (it could only refuse hits
// within rounding of a silhouette), no winding swap (either sign counts), t by two divisions, so
// that no product underflows.
#ifndef SHEAF_SCALAR_INTERSECT_TRIANGLE_H_
#define SHEAF_SCALAR_INTERSECT_TRIANGLE_H_

#include <cmath>
#include <optional>

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
SHEAF_INLINE std::optional<TriangleHit<Real>> IntersectTriangle(Vec3<Real> origin,
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
  if (!inside || !(det != 0)) return std::nullopt;

  const Real scaled_t = (u * a[kz] + v * b[kz]) + w * c[kz];
  return TriangleHit<Real>{(scaled_t / det) / dz, v / det, w / det};
}

}  // namespace sheaf::scalar

#endif  // SHEAF_SCALAR_INTERSECT_TRIANGLE_H_
