#include "src/render/attenuate_paths.h"

#include "src/scalar/attenuate.h"

namespace sheaf {

template <typename Real>
void AttenuatePaths(const FrameView<Real>& frame, const RayView<Real>& rays,
                    const HitView<Real>& hits, std::uint32_t count, const PathOutput<Real>& paths) {
  for (std::uint32_t i = 0; i < count; ++i) {
    if (hits.primitive[i] == kNoPrimitive || (rays.source[i] & kInsideBit) == 0) continue;
    const Vec3<Real> left = scalar::TransmittanceOf(frame, rays.source[i], hits.t[i]);
    paths.throughput_r[i] = paths.throughput_r[i] * left.x;
    paths.throughput_g[i] = paths.throughput_g[i] * left.y;
    paths.throughput_b[i] = paths.throughput_b[i] * left.z;
  }
}

template void AttenuatePaths(const FrameView<float>&, const RayView<float>&, const HitView<float>&,
                             std::uint32_t, const PathOutput<float>&);
template void AttenuatePaths(const FrameView<double>&, const RayView<double>&,
                             const HitView<double>&, std::uint32_t, const PathOutput<double>&);

}  // namespace sheaf
