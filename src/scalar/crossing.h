// Whether a ray crosses a triangle, such that a ray through an edge or a vertex that triangles
// share crosses the surface there once, if it goes through, or an even number of times.
//
// Sheared, the triangles of a mesh are triangles of a plane and the ray is its origin: the
// coordinates of a vertex are computed alike for all its triangles (triangle.h), so neighbours
// share their edges exactly. The signs of edge functions are taken exactly, and where one is 0 the
// ray is moved aside by (e, e * e), with e smaller than anything: the edge function's derivatives
// decide. (The top-left rule of rasterizers is the same choice; Edelsbrunner, Muecke, "Simulation
// of Simplicity", ACM Trans. Graph. 9(1), 1990.) So no ray meets an edge, and a closed mesh, each
// edge of which belongs to an even number of triangles, covers it an even number of times.
#ifndef SHEAF_SCALAR_CROSSING_H_
#define SHEAF_SCALAR_CROSSING_H_

#include <cmath>
#include <cstdint>
#include <type_traits>

#include "simd/primitives.h"
#include "src/core/vec3.h"
#include "src/scalar/triangle.h"

namespace sheaf::scalar {

template <typename Real>
int SignOf(Real a, Real b) {
  return (a > b) - (a < b);
}

// The sign of a * b - c * d as of real numbers, unless a product underflows.
template <typename Real>
int SignOfDifference(Real a, Real b, Real c, Real d) {
  // Rounding is monotonic: products that differ as rounded differ that way.
  if (const int sign = SignOf(a * b, c * d); sign != 0) return sign;
  if constexpr (std::is_same_v<Real, float>) {
    // Exact, with 48 bits.
    return SignOf(static_cast<double>(a) * static_cast<double>(b),
                  static_cast<double>(c) * static_cast<double>(d));
  } else {
    // What rounding took from each.
    return SignOf(std::fma(a, b, -(a * b)), std::fma(c, d, -(c * d)));
  }
}

// On which side of the line from p to q the origin lies, once moved aside. 0 where p is q.
template <typename Real>
int SideOfEdge(Real px, Real py, Real qx, Real qy) {
  if (const int sign = SignOfDifference(px, qy, py, qx); sign != 0) return sign;
  if (const int sign = SignOf(py, qy); sign != 0) return sign;
  return SignOf(qx, px);
}

// A vertex in the plane across the ray.
template <typename Real>
struct ShearedVertex {
  Real x, y;

  ShearedVertex(Vec3<Real> vertex, Vec3<Real> origin, const TriangleShear<Real>& shear) {
    // As IntersectTriangle.
    const Vec3<Real> a = vertex - origin;
    x = a[shear.kx] - shear.sx * a[shear.kz];
    y = a[shear.ky] - shear.sy * a[shear.kz];
  }
};

// Whether the line of a ray crosses triangle `i`. It does not where this is false though it hits
// the triangle; where it does not hit it, this is false.
template <typename Real>
bool Crosses(Vec3<Real> origin, const TriangleShear<Real>& shear,
             const TriangleArrays<Real>& triangles, std::uint32_t i) {
  const ShearedVertex<Real> a(TriangleVertex(triangles, i, 0), origin, shear);
  const ShearedVertex<Real> b(TriangleVertex(triangles, i, 1), origin, shear);
  const ShearedVertex<Real> c(TriangleVertex(triangles, i, 2), origin, shear);
  const int side = SideOfEdge(a.x, a.y, b.x, b.y);
  return side != 0 && side == SideOfEdge(b.x, b.y, c.x, c.y) &&
         side == SideOfEdge(c.x, c.y, a.x, a.y);
}

}  // namespace sheaf::scalar

#endif  // SHEAF_SCALAR_CROSSING_H_
