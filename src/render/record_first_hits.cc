#include "src/render/record_first_hits.h"

#include "src/core/vec3.h"
#include "src/render/surface_in.h"

namespace sheaf {

template <typename Real>
void FirstHitRecorder<Real>::Record(const HitBin& bin, const HitView<Real>& hits,
                                    const SurfaceView<Real>& surfaces) {
  const MaterialData<Real>& material = frame_.materials[bin.material];
  for (std::uint32_t i = 0; i < bin.batch.count; ++i) {
    const std::uint32_t primitive = bin.batch.primitive[i];
    FirstHit<Real>& first = hits_[bin.batch.ray[i]];
    first.normal = {surfaces.normal_x[i], surfaces.normal_y[i], surfaces.normal_z[i]};
    first.surface = SurfaceIdOf(primitive, frame_.primitives[primitive]);
    first.t = hits.t[bin.batch.ray[i]];
    if (keeps_albedo_) {
      first.albedo = TintedBase(material, SurfaceIn(surfaces, i, material.needs));
    }
    first.primitive = primitive;
  }
}

template <typename Real>
void FirstHitRecorder<Real>::RecordColours(const ColourView<Real>& sample) {
  for (std::size_t i = 0; i < hits_.size(); ++i) {
    hits_[i].colour = {sample.r[i], sample.g[i], sample.b[i]};
  }
}

template class FirstHitRecorder<float>;
template class FirstHitRecorder<double>;

}  // namespace sheaf
