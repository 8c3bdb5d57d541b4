#include "src/render/weigh_emission.h"

#include "src/scalar/emitters.h"

namespace sheaf {

template <typename Real>
void WeighEmission(const MaterialData<Real>& material, const RayBatch<Real>& batch,
                   const HitView<Real>& hits, const std::uint32_t* instances,
                   const SurfaceView<Real>& surfaces, std::uint32_t count,
                   const ColourOutput<Real>& colours) {
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t ray = surfaces.ray[i];
    const Real density = batch.paths.density[ray];
    // Of instances no lamp is drawn.
    if (!(density > 0) || (instances && instances[ray] != kNoInstance)) continue;
    scalar::Surface<Real> surface{};
    surface.face = {surfaces.face_x[i], surfaces.face_y[i], surfaces.face_z[i]};
    surface.direction = {surfaces.direction_x[i], surfaces.direction_y[i], surfaces.direction_z[i]};
    const Real weight =
        scalar::FoundWeight(density, material.emitter_density, surface, hits.t[ray]);
    colours.r[i] = colours.r[i] * weight;
    colours.g[i] = colours.g[i] * weight;
    colours.b[i] = colours.b[i] * weight;
  }
}

#define SHEAF_INSTANTIATE(Real)                                                 \
  template void WeighEmission(const MaterialData<Real>&, const RayBatch<Real>&, \
                              const HitView<Real>&, const std::uint32_t*,       \
                              const SurfaceView<Real>&, std::uint32_t, const ColourOutput<Real>&);
SHEAF_INSTANTIATE(float)
SHEAF_INSTANTIATE(double)
#undef SHEAF_INSTANTIATE

}  // namespace sheaf
