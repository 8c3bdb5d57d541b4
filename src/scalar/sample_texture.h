// The colour of a texture at surface coordinates.
#ifndef SHEAF_SCALAR_SAMPLE_TEXTURE_H_
#define SHEAF_SCALAR_SAMPLE_TEXTURE_H_

#include <cmath>

#include "simd/shading.h"
#include "src/core/vec3.h"

namespace sheaf::scalar {

// `x` brought into [0, 1].
template <typename Real>
Real WrapCoordinate(TextureWrap wrap, Real x) {
  if (wrap == TextureWrap::kRepeat) return x - std::floor(x);
  if (wrap == TextureWrap::kMirror) {
    const Real within = x - 2 * std::floor(x / 2);
    return within > 1 ? 2 - within : within;
  }
  return x > 0 ? (x < 1 ? x : Real(1)) : Real(0);
}

// A texel's index in [-1, count] brought into [0, count): the neighbour of the last one.
inline int WrapTexel(TextureWrap wrap, int i, int count) {
  if (i >= 0 && i < count) return i;
  if (wrap == TextureWrap::kRepeat) return i < 0 ? count - 1 : 0;
  return i < 0 ? 0 : count - 1;
}

template <typename Real>
Vec3<Real> Texel(const TextureData<Real>& texture, int x, int y) {
  const std::uint32_t texel =
      texture.texels[static_cast<std::size_t>(y) * static_cast<std::size_t>(texture.width) +
                     static_cast<std::size_t>(x)];
  return {texture.decode[texel & 255], texture.decode[texel >> 8 & 255],
          texture.decode[texel >> 16 & 255]};
}

// Linear light; u and v finite. Texel centers lie at half-integers; texels are decoded before they
// are mixed.
template <typename Real>
Vec3<Real> SampleTexture(const TextureData<Real>& texture, Real u, Real v) {
  const Real x = WrapCoordinate(texture.wrap_u, u) * static_cast<Real>(texture.width);
  const Real y = WrapCoordinate(texture.wrap_v, v) * static_cast<Real>(texture.height);
  const auto column = [&](Real at) {
    return WrapTexel(texture.wrap_u, static_cast<int>(at), texture.width);
  };
  const auto row = [&](Real at) {
    return WrapTexel(texture.wrap_v, static_cast<int>(at), texture.height);
  };
  if (texture.filter == TextureFilter::kNearest) {
    return Texel(texture, column(std::floor(x)), row(std::floor(y)));
  }
  const Real left = std::floor(x - Real(0.5)), top = std::floor(y - Real(0.5));
  const Real right_share = (x - Real(0.5)) - left, low_share = (y - Real(0.5)) - top;
  const int x0 = column(left), x1 = column(left + 1), y0 = row(top), y1 = row(top + 1);
  const auto mix = [](Vec3<Real> a, Vec3<Real> b, Real share) { return a + (b - a) * share; };
  return mix(mix(Texel(texture, x0, y0), Texel(texture, x1, y0), right_share),
             mix(Texel(texture, x0, y1), Texel(texture, x1, y1), right_share), low_share);
}

}  // namespace sheaf::scalar

#endif  // SHEAF_SCALAR_SAMPLE_TEXTURE_H_
