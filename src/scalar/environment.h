// What a ray sees that leaves the scene.
#ifndef SHEAF_SCALAR_ENVIRONMENT_H_
#define SHEAF_SCALAR_ENVIRONMENT_H_

#include <cmath>
#include <cstddef>
#include <numbers>

#include "src/core/vec3.h"
#include "src/scalar/atan.h"
#include "src/stream/frame_view.h"

namespace sheaf::scalar {

// A picture's light around (u, v) in [0, 1], bilinear. It goes on from the right edge to the left,
// and ends at the top and the bottom.
template <typename Real>
Vec3<Real> SampleMap(const EnvironmentData<Real>& map, Real u, Real v) {
  const Real x = u * static_cast<Real>(map.width) - Real(0.5);
  const Real y = v * static_cast<Real>(map.height) - Real(0.5);
  const Real left = std::floor(x), top = std::floor(y);
  const auto pixel = [&](int column, int row) -> Vec3<Real> {
    column = (column % map.width + map.width) % map.width;
    row = row < 0 ? 0 : (row < map.height ? row : map.height - 1);
    const float* rgb =
        map.rgb + 3 * (static_cast<std::size_t>(row) * static_cast<std::size_t>(map.width) +
                       static_cast<std::size_t>(column));
    return {static_cast<Real>(rgb[0]), static_cast<Real>(rgb[1]), static_cast<Real>(rgb[2])};
  };
  const auto mix = [](Vec3<Real> a, Vec3<Real> b, Real share) { return a + (b - a) * share; };
  const int x0 = static_cast<int>(left), y0 = static_cast<int>(top);
  return mix(mix(pixel(x0, y0), pixel(x0 + 1, y0), x - left),
             mix(pixel(x0, y0 + 1), pixel(x0 + 1, y0 + 1), x - left), y - top);
}

// `direction` is a unit vector.
template <typename Real>
Vec3<Real> EnvironmentAt(const EnvironmentData<Real>& environment, Vec3<Real> direction) {
  if (environment.kind == EnvironmentKind::kGradient) {
    const Real up = direction.y;
    const Vec3<Real> horizon = FromArray(environment.horizon);
    const Vec3<Real> end = FromArray(up > 0 ? environment.zenith : environment.nadir);
    const Real share = std::abs(up) < 1 ? std::abs(up) : Real(1);
    return horizon * (1 - share) + end * share;
  }
  const Vec3<double> d = direction.template To<double>();
  const double around =
      AngleOf(d.x, -d.z) / (2 * std::numbers::pi) + 0.5 + static_cast<double>(environment.turns);
  const double down = AngleOf(std::sqrt(d.x * d.x + d.z * d.z), d.y) / std::numbers::pi;
  const Real u = static_cast<Real>(around - std::floor(around));
  return SampleMap(environment, u, static_cast<Real>(down)) * environment.strength;
}

// The colour of a ray that hit nothing.
template <typename Real>
Vec3<Real> ColourBeyond(const FrameView<Real>& frame, Vec3<Real> direction) {
  if (frame.environment.kind == EnvironmentKind::kColour) return FromArray(frame.background);
  return EnvironmentAt(frame.environment, direction);
}

}  // namespace sheaf::scalar

#endif  // SHEAF_SCALAR_ENVIRONMENT_H_
