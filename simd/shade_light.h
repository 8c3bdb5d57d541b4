// What one light adds to the surfaces that it reaches.
#ifndef SHEAF_SIMD_SHADE_LIGHT_H_
#define SHEAF_SIMD_SHADE_LIGHT_H_

#include "simd/shading.h"
#include "simd/streams.h"

namespace sheaf {

// Adds to colours[0, count) where lit != 0, by the incidence that FaceLight found there; `shares`,
// unless its arrays are null, of the light that arrives. Bits: as sheaf::scalar::LitBy times the
// share. Reads and writes PaddedCount(count) lanes.
template <typename Real>
using ShadeLightKernel = void(const LightData<Real>& light, const MaterialData<Real>& material,
                              const SurfaceView<Real>& surfaces,
                              const IncidenceView<Real>& incidence, const std::uint32_t* lit,
                              const ColourView<Real>& shares, std::uint32_t count,
                              const ColourOutput<Real>& colours);

}  // namespace sheaf

#endif  // SHEAF_SIMD_SHADE_LIGHT_H_
