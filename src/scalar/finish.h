// What textures say of a surface point by point, besides its base colour.
#ifndef SHEAF_SCALAR_FINISH_H_
#define SHEAF_SCALAR_FINISH_H_

#include <algorithm>
#include <span>

#include "simd/shading.h"
#include "simd/tree.h"
#include "src/scalar/sample_texture.h"
#include "src/scalar/shade.h"
#include "src/scalar/surface.h"
#include "src/scalar/triangle.h"
#include "src/scene/gloss.h"

namespace sheaf::scalar {

// What a material's textures say at one point. Of textures that it lacks, anything.
template <typename Real>
struct Texels {
  Real metallic, roughness;  // before their factors
  Real occlusion, transmission;
  Vec3<Real> emission;
  Real alpha;
};

// The alpha of the vertices, times that of the base colour's texture.
template <typename Real>
Real AlphaAt(const MaterialData<Real>& material, std::span<const TextureData<Real>> textures,
             const Surface<Real>& surface) {
  if (material.kind != BaseColour::kTexture) return surface.alpha;
  return SampleAlpha(textures[material.texture], surface) * surface.alpha;
}

template <typename Real>
Texels<Real> TexelsAt(const MaterialData<Real>& material,
                      std::span<const TextureData<Real>> textures, const Surface<Real>& surface) {
  const FinishData<Real>& finish = material.finish;
  const auto sample = [&](std::uint32_t texture) -> Vec3<Real> {
    if (texture == kNoTexture) return {1, 1, 1};
    return SampleTexture(textures[texture], surface);
  };
  const Vec3<Real> gloss = sample(finish.metallic_roughness);
  const Real alpha = finish.alpha == AlphaUse::kOpaque ? 1 : AlphaAt(material, textures, surface);
  return {gloss.z,
          gloss.y,
          sample(finish.occlusion).x,
          sample(finish.transmission).x,
          sample(finish.emission),
          alpha};
}

// How much of the surface is there, in [0, 1], where AlphaAt is `alpha`.
template <typename Real>
Real ShareThere(const FinishData<Real>& finish, Real alpha) {
  const Real scaled = finish.alpha_factor * alpha;
  if (finish.alpha == AlphaUse::kMask) return scaled >= finish.alpha_cutoff ? Real(1) : Real(0);
  return scaled;
}

// What the surface lets pass of a light behind it, straight on: all of it where nothing is there.
template <typename Real>
Vec3<Real> PassedAt(const MaterialData<Real>& material, std::span<const TextureData<Real>> textures,
                    const Surface<Real>& surface) {
  const FinishData<Real>& finish = material.finish;
  Vec3<Real> passes = FromArray(material.passes);
  if (finish.is_glossy) {  // metal lets nothing pass
    const Real texel = finish.metallic_roughness == kNoTexture
                           ? Real(1)
                           : SampleTexture(textures[finish.metallic_roughness], surface).z;
    passes = passes * (1 - finish.metallic * texel);
  }
  if (finish.transmission != kNoTexture) {
    passes = passes * SampleTexture(textures[finish.transmission], surface).x;
  }
  if (finish.alpha == AlphaUse::kOpaque) return passes;
  const Real alpha = ShareThere(finish, AlphaAt(material, textures, surface));
  const Real gap = 1 - alpha;
  return passes * alpha + Vec3<Real>{gap, gap, gap};
}

// The material as it is at one point, where its base colour is `base`. Only the terms that
// SurfaceFields has differ.
template <typename Real>
MaterialData<Real> MaterialAt(const MaterialData<Real>& material, const Texels<Real>& texels,
                              Vec3<Real> base) {
  const FinishData<Real>& finish = material.finish;
  MaterialData<Real> point = material;
  if (finish.is_glossy) {
    const Real metallic = finish.metallic * texels.metallic;
    const Real roughness = finish.roughness * texels.roughness;
    const Gloss<Real> gloss = finish.has_facets ? FacetGlossOf(metallic, roughness, finish.specular)
                                                : GlossOf(metallic, roughness, finish.specular);
    point.kd = point.kd * gloss.kd;
    point.ks = gloss.ks;
    point.shininess = gloss.shininess;
    point.slope_width = gloss.slope_width;
    for (int i = 0; i < 3; ++i) {
      point.ambient[i] = point.ambient[i] * gloss.ambient;
      point.reflect[i] = std::min(base[i], Real(1)) * gloss.mirror;
      point.transmit[i] = point.transmit[i] * (1 - metallic);
    }
  }
  if (finish.transmission != kNoTexture) {
    const Real through = texels.transmission;
    // Metal lets nothing through.
    const Real metal = finish.is_glossy ? finish.metallic * texels.metallic : Real(0);
    const Real kept = 1 - (finish.transmission_share * through) * (1 - metal);
    point.kd = point.kd * kept;
    for (int i = 0; i < 3; ++i) {
      point.ambient[i] = point.ambient[i] * kept;
      point.transmit[i] = point.transmit[i] * through;
    }
  }
  if (finish.occlusion != kNoTexture) {
    const Real share = 1 + finish.occlusion_strength * (texels.occlusion - 1);
    for (Real& channel : point.ambient) channel = channel * share;
  }
  if (finish.emission != kNoTexture) {
    for (int i = 0; i < 3; ++i) point.emission[i] = point.emission[i] * texels.emission[i];
  }
  if (finish.alpha != AlphaUse::kOpaque) {
    const Real alpha = ShareThere(finish, texels.alpha);
    point.kd = point.kd * alpha;
    point.ks = point.ks * alpha;
    for (int i = 0; i < 3; ++i) {
      point.ambient[i] = point.ambient[i] * alpha;
      point.emission[i] = point.emission[i] * alpha;
      point.reflect[i] = point.reflect[i] * alpha;
      // What is not there lets all light pass.
      point.transmit[i] = point.transmit[i] * alpha + (1 - alpha);
    }
  }
  return point;
}

// The shading normal that a normal map, whose colour here is `colour`, makes of the surface's, on
// triangle `i`. `map` is the material's. Its tangents are those of the triangle's surface
// coordinates, at right angles to the shading normal; a triangle without coordinates, or whose
// normal would turn to the face's other side, keeps its normal.
template <typename Real>
Vec3<Real> BumpedNormal(const MaterialData<Real>& material, const TextureData<Real>& map,
                        Vec3<Real> colour, const TriangleArrays<Real>& triangles, std::uint32_t i,
                        const Surface<Real>& surface) {
  using W = Wide<Real>;
  const auto& coordinates = map.set == 1 ? triangles.uv2 : triangles.uv;
  if (!coordinates[0][0]) return surface.normal;
  const auto vertex = [&](int k) { return VertexValue(triangles.vertex, k, i); };
  const auto uv = [&](int k, int axis) { return static_cast<W>(coordinates[k][axis][i]); };
  const Vec3<W> e1 = vertex(1) - vertex(0), e2 = vertex(2) - vertex(0);
  const W du1 = uv(1, 0) - uv(0, 0), dv1 = uv(1, 1) - uv(0, 1);
  const W du2 = uv(2, 0) - uv(0, 0), dv2 = uv(2, 1) - uv(0, 1);
  const W det = du1 * dv2 - du2 * dv1;
  if (!(det < 0 || det > 0)) return surface.normal;
  const Vec3<W> shading = surface.normal.template To<W>();
  const Vec3<W> n = surface.inside() ? -shading : shading;  // on the triangle's front
  const Vec3<W> along_u = det > 0 ? e1 * dv2 - e2 * dv1 : e2 * dv1 - e1 * dv2;
  const Vec3<W> level = along_u - n * Dot(along_u, n);
  if (!(Dot(level, level) > 0)) return surface.normal;
  const Vec3<W> x = NormalizeWide(level);
  // Against v, which runs down the image: to the left of x where the image is seen as it is.
  const Vec3<W> y = det < 0 ? Cross(n, x) : Cross(x, n);
  const Vec3<W> texel = colour.template To<W>();
  const W scale = static_cast<W>(material.finish.normal_scale);
  const Vec3<W> bump =
      (x * ((2 * texel.x - 1) * scale) + y * ((2 * texel.y - 1) * scale)) + n * (2 * texel.z - 1);
  const Vec3<W> turned = surface.inside() ? -bump : bump;
  if (!(Dot(turned, surface.face.template To<W>()) > 0)) return surface.normal;
  return NormalizeWide(turned).template To<Real>();
}

}  // namespace sheaf::scalar

#endif  // SHEAF_SCALAR_FINISH_H_
