// Rays by Lambert's law, from the surfaces that chose them.
#ifndef SHEAF_SIMD_SCATTER_DIFFUSE_H_
#define SHEAF_SIMD_SCATTER_DIFFUSE_H_

#include "simd/shading.h"
#include "simd/streams.h"

namespace sheaf {

// As SpawnRays does, with its density besides, appends the diffuse ray of each of surfaces[0,
// count) whose choice_diffuse is above 0, drawn by `points`, one a surface. Returns how many there
// are. Bits: as sheaf::scalar::ScatterDiffuse. Reads PaddedCount(count) lanes; writes
// StreamCapacity(count) at most.
template <typename Real>
using ScatterDiffuseKernel = std::uint32_t(const MaterialData<Real>& material,
                                           const SurfaceView<Real>& surfaces, std::uint32_t count,
                                           const PathView<Real>& parents,
                                           const SampleView<Real>& points, Real min_throughput,
                                           const RayOutput<Real>& rays,
                                           const PathOutput<Real>& paths);

}  // namespace sheaf

#endif  // SHEAF_SIMD_SCATTER_DIFFUSE_H_
