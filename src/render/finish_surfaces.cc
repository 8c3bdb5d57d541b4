#include "src/render/finish_surfaces.h"

#include <algorithm>

#include "simd/shading.h"
#include "src/render/surface_in.h"
#include "src/scalar/finish.h"
#include "src/scalar/sphere_coordinates.h"

namespace sheaf {

template <typename Real>
void PlaceOnSpheres(const HitBin& bin, const SurfaceView<Real>& surfaces,
                    const SurfaceOutput<Real>& placed) {
  for (std::uint32_t i = 0; i < bin.batch.count; ++i) {
    scalar::Surface<Real> surface = SurfaceIn(surfaces, i, 0);
    scalar::PlaceOnSphere(surface);
    placed.u[i] = surface.u;
    placed.v[i] = surface.v;
  }
}

template <typename Real>
void BumpSurfaces(const FrameView<Real>& frame, const Kernels<Real>& kernels, const HitBin& bin,
                  const SurfaceView<Real>& surfaces, const TexelOutput<Real>& texels,
                  const SurfaceOutput<Real>& bumped) {
  const MaterialData<Real>& material = frame.materials[bin.material];
  const TextureData<Real>& map = frame.textures[material.finish.normals];
  kernels.sample_texture(map, surfaces, bin.batch.count, {texels.r, texels.g, texels.b, nullptr});
  for (std::uint32_t i = 0; i < bin.batch.count; ++i) {
    const Vec3<Real> colour = {texels.r[i], texels.g[i], texels.b[i]};
    const Vec3<Real> normal =
        scalar::BumpedNormal(material, map, colour, frame.geometry.triangles, bin.batch.index[i],
                             SurfaceIn(surfaces, i, material.needs));
    bumped.normal_x[i] = normal.x;
    bumped.normal_y[i] = normal.y;
    bumped.normal_z[i] = normal.z;
  }
}

// Writes what the textures say of surfaces[0, count): TexelsAt of src/scalar/finish.h, where they
// are there.
template <typename Real>
void SampleTextures(const FrameView<Real>& frame, const Kernels<Real>& kernels, const HitBin& bin,
                    const SurfaceView<Real>& surfaces, const TexelOutput<Real>& texels) {
  const MaterialData<Real>& material = frame.materials[bin.material];
  const FinishData<Real>& finish = material.finish;
  const auto sample = [&](std::uint32_t texture, const ChannelOutput<Real>& channels) {
    if (texture == kNoTexture) return;
    kernels.sample_texture(frame.textures[texture], surfaces, bin.batch.count, channels);
  };
  if (finish.is_glossy && finish.metallic_roughness == kNoTexture) {
    std::fill_n(texels.roughness, bin.batch.count, Real(1));
    std::fill_n(texels.metallic, bin.batch.count, Real(1));
  }
  sample(finish.metallic_roughness, {nullptr, texels.roughness, texels.metallic, nullptr});
  sample(finish.occlusion, {texels.occlusion, nullptr, nullptr, nullptr});
  sample(finish.transmission, {texels.transmission, nullptr, nullptr, nullptr});
  sample(finish.emission, {texels.emission_r, texels.emission_g, texels.emission_b, nullptr});
  if (finish.alpha == AlphaUse::kOpaque) return;
  if (material.kind == BaseColour::kTexture) {
    sample(material.texture, {nullptr, nullptr, nullptr, texels.alpha});
  } else {
    std::fill_n(texels.alpha, bin.batch.count, Real(1));
  }
  if (!(material.needs & kNeedsVertexAlpha) || bin.kind != PrimitiveKind::kTriangle) return;
  for (std::uint32_t i = 0; i < bin.batch.count; ++i) texels.alpha[i] *= surfaces.alpha[i];
}

template <typename Real>
void FinishSurfaces(const FrameView<Real>& frame, const Kernels<Real>& kernels, const HitBin& bin,
                    const SurfaceView<Real>& surfaces, const TexelOutput<Real>& texels,
                    const SurfaceOutput<Real>& finished) {
  const MaterialData<Real>& material = frame.materials[bin.material];
  Real* const ambient[3] = {finished.ambient_r, finished.ambient_g, finished.ambient_b};
  Real* const emission[3] = {finished.emission_r, finished.emission_g, finished.emission_b};
  Real* const reflect[3] = {finished.reflect_r, finished.reflect_g, finished.reflect_b};
  Real* const transmit[3] = {finished.transmit_r, finished.transmit_g, finished.transmit_b};
  SampleTextures(frame, kernels, bin, surfaces, texels);
  for (std::uint32_t i = 0; i < bin.batch.count; ++i) {
    const scalar::Texels<Real> said = {
        texels.metallic[i],
        texels.roughness[i],
        texels.occlusion[i],
        texels.transmission[i],
        {texels.emission_r[i], texels.emission_g[i], texels.emission_b[i]},
        texels.alpha[i]};
    const scalar::Surface<Real> surface = SurfaceIn(surfaces, i, material.needs);
    const MaterialData<Real> point =
        scalar::MaterialAt(material, said, TintedBase(material, surface));
    for (int c = 0; c < 3; ++c) {
      ambient[c][i] = point.ambient[c];
      emission[c][i] = point.emission[c];
      reflect[c][i] = point.reflect[c];
      transmit[c][i] = point.transmit[c];
    }
    finished.kd[i] = point.kd;
    finished.ks[i] = point.ks;
    finished.shininess[i] = point.shininess;
    finished.slope_width[i] = point.slope_width;
  }
}

#define SHEAF_INSTANTIATE(Real)                                                             \
  template void PlaceOnSpheres(const HitBin&, const SurfaceView<Real>&,                     \
                               const SurfaceOutput<Real>&);                                 \
  template void BumpSurfaces(const FrameView<Real>&, const Kernels<Real>&, const HitBin&,   \
                             const SurfaceView<Real>&, const TexelOutput<Real>&,            \
                             const SurfaceOutput<Real>&);                                   \
  template void FinishSurfaces(const FrameView<Real>&, const Kernels<Real>&, const HitBin&, \
                               const SurfaceView<Real>&, const TexelOutput<Real>&,          \
                               const SurfaceOutput<Real>&);
SHEAF_INSTANTIATE(float)
SHEAF_INSTANTIATE(double)
#undef SHEAF_INSTANTIATE

}  // namespace sheaf
