// From points of the unit square to those of other figures, evenly by area.
#ifndef SHEAF_SCALAR_WARP_H_
#define SHEAF_SCALAR_WARP_H_

#include <cmath>

#include "src/core/vec3.h"
#include "src/scalar/draw_sample.h"
#include "src/scalar/sin_cos.h"

namespace sheaf::scalar {

template <typename Real>
struct PlanePoint {
  Real x, y;
};

// Of the disk of radius 1.
template <typename Real>
PlanePoint<Real> DiskPoint(SamplePoint<Real> point) {
  const Real radius = std::sqrt(point.u);
  const SinCos<Real> angle = SinCosOf(4 * point.v);
  return {radius * angle.cos, radius * angle.sin};
}

// Of the polygon whose `sides` corners lie on that disk's edge, the first `turn` quarter turns from
// x: a side's triangle, then a point in it.
template <typename Real>
PlanePoint<Real> PolygonPoint(Real sides, Real turn, SamplePoint<Real> point) {
  const Real along = point.u * sides, side = std::floor(along);
  const Real step = 4 / sides;
  const SinCos<Real> a = SinCosOf(side * step + turn);
  const SinCos<Real> b = SinCosOf((side + 1) * step + turn);
  const Real depth = std::sqrt(along - side), share = depth * point.v;
  return {a.cos * (depth - share) + b.cos * share, a.sin * (depth - share) + b.sin * share};
}

// A direction about `around` with axes x and y, from the cone in which 1 - cos is at most `extent`,
// evenly by solid angle.
template <typename Real>
struct ConeDirection {
  Vec3<Real> direction;
  Real cosine, sine;

  ConeDirection(Vec3<Real> around, Vec3<Real> x, Vec3<Real> y, Real extent,
                SamplePoint<Real> point) {
    const Real below = point.u * extent;  // 1 - cosine, without the rounding of that near 0
    const SinCos<Real> angle = SinCosOf(4 * point.v);
    cosine = 1 - below;
    sine = std::sqrt(below * (2 - below));
    direction = (x * (sine * angle.cos) + y * (sine * angle.sin)) + around * cosine;
  }
};

}  // namespace sheaf::scalar

#endif  // SHEAF_SCALAR_WARP_H_
