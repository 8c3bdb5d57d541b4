#include "src/render/tint_surfaces.h"

#include <algorithm>

#include "simd/shading.h"

namespace sheaf {

template <typename Real>
void TintSurfaces(const FrameView<Real>& frame, const Kernels<Real>& kernels, const HitBin& bin,
                  const SurfaceView<Real>& surfaces, const TexelOutput<Real>& texels,
                  const SurfaceOutput<Real>& tinted) {
  const std::uint32_t count = bin.batch.count;
  const MaterialData<Real>& material = frame.materials[bin.material];
  if (bin.kind != PrimitiveKind::kTriangle) {
    for (Real* channel : {tinted.tint_r, tinted.tint_g, tinted.tint_b}) {
      std::fill_n(channel, count, Real(1));
    }
  }
  if (material.kind != BaseColour::kTexture) return;
  kernels.sample_texture(frame.textures[material.texture], surfaces, count,
                         {texels.r, texels.g, texels.b, nullptr});
  for (std::uint32_t i = 0; i < count; ++i) {
    tinted.tint_r[i] *= texels.r[i];
    tinted.tint_g[i] *= texels.g[i];
    tinted.tint_b[i] *= texels.b[i];
  }
}

#define SHEAF_INSTANTIATE(Real)                                                           \
  template void TintSurfaces(const FrameView<Real>&, const Kernels<Real>&, const HitBin&, \
                             const SurfaceView<Real>&, const TexelOutput<Real>&,          \
                             const SurfaceOutput<Real>&);
SHEAF_INSTANTIATE(float)
SHEAF_INSTANTIATE(double)
#undef SHEAF_INSTANTIATE

}  // namespace sheaf
