// Surface coordinates of spheres.
#ifndef SHEAF_SCALAR_SPHERE_COORDINATES_H_
#define SHEAF_SCALAR_SPHERE_COORDINATES_H_

#include <cmath>
#include <numbers>

#include "src/scalar/atan.h"
#include "src/scalar/surface.h"

namespace sheaf::scalar {

// Sets u and v of a surface on a sphere, from its normal: u goes around the y axis, 0.5 towards +z
// and growing towards +x, to the right as one looks from outside; v from 0 at the top to 1.
template <typename Real>
void PlaceOnSphere(Surface<Real>& surface) {
  const Vec3<Real> out = surface.inside() ? -surface.normal : surface.normal;
  const Vec3<double> n = out.template To<double>();
  const double around = AngleOf(n.x, n.z), down = AngleOf(std::sqrt(n.x * n.x + n.z * n.z), n.y);
  surface.u = static_cast<Real>(0.5 + around / (2 * std::numbers::pi));
  surface.v = static_cast<Real>(down / std::numbers::pi);
}

}  // namespace sheaf::scalar

#endif  // SHEAF_SCALAR_SPHERE_COORDINATES_H_
