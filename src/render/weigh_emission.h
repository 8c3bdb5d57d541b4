// What the light of lamps counts that diffuse rays found.
#ifndef SHEAF_RENDER_WEIGH_EMISSION_H_
#define SHEAF_RENDER_WEIGH_EMISSION_H_

#include "simd/shading.h"
#include "simd/streams.h"
#include "src/render/ray_queue.h"

namespace sheaf {

// Multiplies colours[0, count), what surfaces of triangles show by themselves, by the weight of the
// diffuse rays that met them. Surface by surface: rays that meet a lamp are few. `instances`: by
// ray, what it hit; null where no frame has instances.
template <typename Real>
void WeighEmission(const MaterialData<Real>& material, const RayBatch<Real>& batch,
                   const HitView<Real>& hits, const std::uint32_t* instances,
                   const SurfaceView<Real>& surfaces, std::uint32_t count,
                   const ColourOutput<Real>& colours);

}  // namespace sheaf

#endif  // SHEAF_RENDER_WEIGH_EMISSION_H_
