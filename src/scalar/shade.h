// The light that a surface itself sends to the eye: ambient, diffuse, half-vector highlight.
#ifndef SHEAF_SCALAR_SHADE_H_
#define SHEAF_SCALAR_SHADE_H_

#include <algorithm>
#include <cmath>
#include <span>

#include "simd/shading.h"
#include "src/scalar/filter_checker.h"
#include "src/scalar/incidence.h"
#include "src/scalar/pow.h"
#include "src/scalar/sample_texture.h"
#include "src/scalar/surface.h"

namespace sheaf::scalar {

// A transparent body has no light of its own inside.
template <typename Real>
bool HasLocalLight(const MaterialData<Real>& material, const Surface<Real>& surface) {
  return !(surface.inside() && AnyPositive(material.transmit));
}

template <typename Real>
bool ReactsToLight(const MaterialData<Real>& material) {
  return material.kd > 0 || material.ks > 0 || material.finish.is_glossy;
}

// A checker is odd where floor(u * cells) + floor(v * cells) is. Halving and doubling are exact.
template <typename Real>
Vec3<Real> PatternAt(const MaterialData<Real>& material, const Surface<Real>& surface) {
  const Real u = surface.u * material.cells[0], v = surface.v * material.cells[1];
  if (material.kind == BaseColour::kFilteredChecker) {
    const Real share = EvenShare(u, v, surface.footprint_u * material.cells[0],
                                 surface.footprint_v * material.cells[1]);
    return FromArray(material.even) * share + FromArray(material.odd) * (1 - share);
  }
  if (material.kind != BaseColour::kChecker) return FromArray(material.even);
  const Real cell = std::floor(u) + std::floor(v);
  const bool odd = cell != 2 * std::floor(cell / 2);
  return FromArray(odd ? material.odd : material.even);
}

template <typename Real>
Vec3<Real> MultiplyColours(Vec3<Real> a, Vec3<Real> b) {
  return {a.x * b.x, a.y * b.y, a.z * b.z};
}

// What a texture and the vertices' colours multiply the base colour with.
template <typename Real>
Vec3<Real> TintAt(const MaterialData<Real>& material, std::span<const TextureData<Real>> textures,
                  const Surface<Real>& surface) {
  if (material.kind != BaseColour::kTexture) return surface.tint;
  return MultiplyColours(surface.tint, SampleTexture(textures[material.texture], surface));
}

template <typename Real>
Vec3<Real> BaseColourAt(const MaterialData<Real>& material,
                        std::span<const TextureData<Real>> textures, const Surface<Real>& surface) {
  return MultiplyColours(PatternAt(material, surface), TintAt(material, textures, surface));
}

template <typename Real>
Vec3<Real> AmbientLight(const MaterialData<Real>& material, Vec3<Real> base) {
  return MultiplyColours(FromArray(material.ambient), base) + FromArray(material.emission);
}

// What one unoccluded light adds that reaches the surface. The highlight has the light's colour;
// there is no 1/pi.
template <typename Real>
Vec3<Real> LitBy(const LightData<Real>& light, const MaterialData<Real>& material,
                 const Surface<Real>& surface, Vec3<Real> base, const Incidence<Real>& incidence) {
  const Real diffuse = material.kd * incidence.n_dot_l;
  Real highlight = 0;
  // The image of a lamp is what rays find in its mirror.
  if (material.ks > 0 && light.shape != LightShape::kEmitters) {
    const Vec3<Real> h = Normalize(incidence.l - surface.direction);
    const Real n_dot_h = Dot(surface.normal, h);
    // Rounding can carry it past 1; NaN, from an h of length 0, counts as 0.
    const Real clamped = n_dot_h > 0 ? (n_dot_h < 1 ? n_dot_h : Real(1)) : Real(0);
    highlight = material.ks * Pow(clamped, material.shininess);
  }
  const auto channel = [&](int i, Real base_colour) {
    return (light.rgb[i] * incidence.attenuation) * (base_colour * diffuse + highlight);
  };
  return {channel(0, base.x), channel(1, base.y), channel(2, base.z)};
}

}  // namespace sheaf::scalar

#endif  // SHEAF_SCALAR_SHADE_H_
