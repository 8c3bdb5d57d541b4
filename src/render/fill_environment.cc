#include "src/render/fill_environment.h"

#include "src/render/sum_colours.h"
#include "src/scalar/environment.h"

namespace sheaf {

template <typename Real>
void FillEnvironment(const FrameView<Real>& frame, const RayView<Real>& rays,
                     std::span<const std::uint32_t> list, std::uint32_t count,
                     const ColourOutput<Real>& colours) {
  if (frame.environment.kind == EnvironmentKind::kColour) {
    return FillColours(frame.background, list, count, colours);
  }
  for (const std::uint32_t i : list) {
    const Vec3<Real> colour = scalar::EnvironmentAt(
        frame.environment,
        Vec3<Real>{rays.direction_x[i], rays.direction_y[i], rays.direction_z[i]});
    colours.r[i] = colour.x;
    colours.g[i] = colour.y;
    colours.b[i] = colour.z;
  }
}

template void FillEnvironment(const FrameView<float>&, const RayView<float>&,
                              std::span<const std::uint32_t>, std::uint32_t,
                              const ColourOutput<float>&);
template void FillEnvironment(const FrameView<double>&, const RayView<double>&,
                              std::span<const std::uint32_t>, std::uint32_t,
                              const ColourOutput<double>&);

}  // namespace sheaf
