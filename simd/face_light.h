// Which surfaces a light could reach.
#ifndef SHEAF_SIMD_FACE_LIGHT_H_
#define SHEAF_SIMD_FACE_LIGHT_H_

#include "simd/shading.h"
#include "simd/streams.h"

namespace sheaf {

// Writes faces[0, count): 1 where the light lies above the surface (n . l > 0) and the surface
// shows its own light, else 0; and how the light meets those, of a light with a size at `points` of
// it, one a surface. Of other lights points are not read, and incidence.end_x and so on, and the
// colours, are left alone; either may be null then. Returns how many there are. Bits: as
// sheaf::scalar::IncidenceOf. Reads and writes PaddedCount(count) lanes.
template <typename Real>
using FaceLightKernel = std::uint32_t(const LightData<Real>& light,
                                      const MaterialData<Real>& material,
                                      const SurfaceView<Real>& surfaces,
                                      const SampleView<Real>& points, std::uint32_t count,
                                      std::uint32_t* faces, const IncidenceOutput<Real>& incidence);

}  // namespace sheaf

#endif  // SHEAF_SIMD_FACE_LIGHT_H_
