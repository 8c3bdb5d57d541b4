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

// The colour of a texel, in linear light.
template <typename Real>
struct TexelColour {
  const TextureData<Real>& texture;

  Vec3<Real> operator()(std::uint32_t texel) const {
    return {texture.decode[texel & 255], texture.decode[texel >> 8 & 255],
            texture.decode[texel >> 16 & 255]};
  }
};

template <typename Real>
struct TexelAlpha {
  Real operator()(std::uint32_t texel) const { return static_cast<Real>(texel >> 24) / 255; }
};

// The mean of what `value` makes of the texels around (u, v), both finite. Texel centers lie at
// half-integers; texels are decoded before they are mixed.
template <typename Real, typename F>
auto MixTexels(const TextureData<Real>& texture, Real u, Real v, F value) {
  if (texture.is_moved) {
    const Real moved = (texture.to_u[0] * u + texture.to_u[1] * v) + texture.to_u[2];
    v = (texture.to_v[0] * u + texture.to_v[1] * v) + texture.to_v[2];
    u = moved;
  }
  const Real x = WrapCoordinate(texture.wrap_u, u) * static_cast<Real>(texture.width);
  const Real y = WrapCoordinate(texture.wrap_v, v) * static_cast<Real>(texture.height);
  const auto column = [&](Real at) {
    return WrapTexel(texture.wrap_u, static_cast<int>(at), texture.width);
  };
  const auto row = [&](Real at) {
    return WrapTexel(texture.wrap_v, static_cast<int>(at), texture.height);
  };
  const auto at = [&](int i, int j) {
    return value(
        texture.texels[static_cast<std::size_t>(j) * static_cast<std::size_t>(texture.width) +
                       static_cast<std::size_t>(i)]);
  };
  if (texture.filter == TextureFilter::kNearest)
    return at(column(std::floor(x)), row(std::floor(y)));
  const Real left = std::floor(x - Real(0.5)), top = std::floor(y - Real(0.5));
  const Real right_share = (x - Real(0.5)) - left, low_share = (y - Real(0.5)) - top;
  const int x0 = column(left), x1 = column(left + 1), y0 = row(top), y1 = row(top + 1);
  const auto mix = [](auto a, auto b, Real share) { return a + (b - a) * share; };
  return mix(mix(at(x0, y0), at(x1, y0), right_share), mix(at(x0, y1), at(x1, y1), right_share),
             low_share);
}

// Linear light; u and v finite.
template <typename Real>
Vec3<Real> SampleTexture(const TextureData<Real>& texture, Real u, Real v) {
  return MixTexels(texture, u, v, TexelColour<Real>{texture});
}

// In [0, 1]; u and v finite.
template <typename Real>
Real SampleAlpha(const TextureData<Real>& texture, Real u, Real v) {
  return MixTexels(texture, u, v, TexelAlpha<Real>{});
}

}  // namespace sheaf::scalar

#endif  // SHEAF_SCALAR_SAMPLE_TEXTURE_H_
