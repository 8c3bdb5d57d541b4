#include "src/render/tint_surfaces.h"

#include <algorithm>

#include "simd/shading.h"
#include "simd/streams.h"
#include "src/scalar/sample_texture.h"

namespace sheaf {

template <typename Real>
void TintSurfaces(const MaterialData<Real>& material, std::span<const TextureData<Real>> textures,
                  const HitBin& bin, const SurfaceView<Real>& surfaces,
                  const SurfaceOutput<Real>& tinted) {
  const std::uint32_t count = bin.batch.count;
  if (bin.kind != PrimitiveKind::kTriangle) {
    for (Real* channel : {tinted.tint_r, tinted.tint_g, tinted.tint_b}) {
      std::fill_n(channel, count, Real(1));
    }
  }
  if (material.kind != BaseColour::kTexture) return;
  const TextureData<Real>& texture = textures[material.texture];
  for (std::uint32_t i = 0; i < count; ++i) {
    const auto colour = scalar::SampleTexture(texture, surfaces.u[i], surfaces.v[i]);
    tinted.tint_r[i] *= colour.x;
    tinted.tint_g[i] *= colour.y;
    tinted.tint_b[i] *= colour.z;
  }
}

template void TintSurfaces(const MaterialData<float>&, std::span<const TextureData<float>>,
                           const HitBin&, const SurfaceView<float>&, const SurfaceOutput<float>&);
template void TintSurfaces(const MaterialData<double>&, std::span<const TextureData<double>>,
                           const HitBin&, const SurfaceView<double>&, const SurfaceOutput<double>&);

}  // namespace sheaf
