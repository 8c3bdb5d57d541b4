// The shadow rays of the surfaces that face a light.
#ifndef SHEAF_SIMD_GENERATE_SHADOW_H_
#define SHEAF_SIMD_GENERATE_SHADOW_H_

#include "simd/shading.h"
#include "simd/streams.h"

namespace sheaf {

// Writes one ray for each surface of [0, count) with faces != 0, in order and without gaps, and its
// position to `surface_of_ray`. A point light's rays count in [t_min, 1], a directional light's to
// infinity. `incidence` is what FaceLight found, read of lights with a size alone. Returns how many
// there are. Bits: as sheaf::scalar::ShadowRay. Reads PaddedCount(count) lanes; writes
// StreamCapacity(count) at most.
template <typename Real>
using GenerateShadowKernel = std::uint32_t(const LightData<Real>& light,
                                           const SurfaceView<Real>& surfaces,
                                           const IncidenceView<Real>& incidence,
                                           const std::uint32_t* faces, std::uint32_t count,
                                           const RayOutput<Real>& rays,
                                           std::uint32_t* surface_of_ray);

}  // namespace sheaf

#endif  // SHEAF_SIMD_GENERATE_SHADOW_H_
