// The light that surfaces send without any light source.
#ifndef SHEAF_SIMD_SHADE_AMBIENT_H_
#define SHEAF_SIMD_SHADE_AMBIENT_H_

#include "simd/shading.h"
#include "simd/streams.h"

namespace sheaf {

// Writes colours[0, count): the ambient term, and 0 inside a transparent body. Bits: as
// sheaf::scalar::LocalLight without lights. Reads and writes PaddedCount(count) lanes.
template <typename Real>
using ShadeAmbientKernel = void(const MaterialData<Real>& material,
                                const SurfaceView<Real>& surfaces, std::uint32_t count,
                                const ColourOutput<Real>& colours);

}  // namespace sheaf

#endif  // SHEAF_SIMD_SHADE_AMBIENT_H_
