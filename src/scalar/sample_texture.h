// The colour of a texture where a ray meets a surface.
#ifndef SHEAF_SCALAR_SAMPLE_TEXTURE_H_
#define SHEAF_SCALAR_SAMPLE_TEXTURE_H_

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>

#include "simd/shading.h"
#include "src/core/vec3.h"
#include "src/scalar/surface.h"

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

// Where a surface's (u, v) lies on the image, and how much of it the footprint covers there.
template <typename Real>
struct ImagePlace {
  Real u, v, width_u, width_v;
};

template <typename Real>
ImagePlace<Real> PlaceOnImage(const TextureData<Real>& texture, const Surface<Real>& surface) {
  const bool is_second = texture.set == 1;
  const Real u = is_second ? surface.u2 : surface.u, v = is_second ? surface.v2 : surface.v;
  const Real width_u = is_second ? surface.footprint_u2 : surface.footprint_u;
  const Real width_v = is_second ? surface.footprint_v2 : surface.footprint_v;
  if (!texture.is_moved) return {u, v, width_u, width_v};
  const auto moved = [&](const Real(&to)[3]) { return (to[0] * u + to[1] * v) + to[2]; };
  const auto widened = [&](const Real(&to)[3]) {
    return std::abs(to[0]) * width_u + std::abs(to[1]) * width_v;
  };
  return {moved(texture.to_u), moved(texture.to_v), widened(texture.to_u), widened(texture.to_v)};
}

// A level, and the share of the next one that is mixed in.
template <typename Real>
struct LevelMix {
  int level;
  Real share;
};

// The levels for a footprint of s texels of the image: 2^level <= s, and a share of s / 2^level -
// 1, which is within 0.09 of the logarithm's fraction. Both are the number's bits.
template <typename Real>
LevelMix<Real> LevelsFor(Real s, Real coarsest) {
  using Bits = std::conditional_t<sizeof(Real) == 4, std::uint32_t, std::uint64_t>;
  constexpr int kFractionBits = std::numeric_limits<Real>::digits - 1;
  constexpr int kBias = std::numeric_limits<Real>::max_exponent - 1;
  const Real least = s > 1 ? s : Real(1);
  const Real clamped = s < coarsest ? least : coarsest;  // NaN is infinitely wide
  const Bits bits = std::bit_cast<Bits>(clamped);
  const Bits fraction = bits & ((Bits{1} << kFractionBits) - 1);
  const Real in_octave = std::bit_cast<Real>(fraction | std::bit_cast<Bits>(Real(1)));
  return {static_cast<int>(bits >> kFractionBits) - kBias, in_octave - 1};
}

template <typename T, typename Real>
T MixOf(T a, T b, Real share) {
  return a + (b - a) * share;
}

// The mean of what `value` makes of a level's texels around (u, v), wrapped. Texel centers lie at
// half-integers; texels are decoded before they are mixed.
template <typename Real, typename F>
auto MixTexels(const TextureData<Real>& texture, int level, Real u, Real v, F value) {
  const int width = texture.levels.width[level], height = texture.levels.height[level];
  const std::uint32_t* const texels =
      level == 0 ? texture.texels : texture.coarse + texture.levels.first[level];
  const Real x = u * static_cast<Real>(width), y = v * static_cast<Real>(height);
  const auto column = [&](Real at) {
    return WrapTexel(texture.wrap_u, static_cast<int>(at), width);
  };
  const auto row = [&](Real at) { return WrapTexel(texture.wrap_v, static_cast<int>(at), height); };
  const auto at = [&](int i, int j) {
    return value(texels[static_cast<std::size_t>(j) * static_cast<std::size_t>(width) +
                        static_cast<std::size_t>(i)]);
  };
  if (texture.filter == TextureFilter::kNearest)
    return at(column(std::floor(x)), row(std::floor(y)));
  const Real left = std::floor(x - Real(0.5)), top = std::floor(y - Real(0.5));
  const Real right_share = (x - Real(0.5)) - left, low_share = (y - Real(0.5)) - top;
  const int x0 = column(left), x1 = column(left + 1), y0 = row(top), y1 = row(top + 1);
  return MixOf(MixOf(at(x0, y0), at(x1, y0), right_share),
               MixOf(at(x0, y1), at(x1, y1), right_share), low_share);
}

// The mean of what `value` makes of the texels in the footprint; (u, v) finite.
template <typename Real, typename F>
auto MixLevels(const TextureData<Real>& texture, const Surface<Real>& surface, F value) {
  const ImagePlace<Real> place = PlaceOnImage(texture, surface);
  const Real u = WrapCoordinate(texture.wrap_u, place.u);
  const Real v = WrapCoordinate(texture.wrap_v, place.v);
  LevelMix<Real> mix = {0, 0};
  if (texture.level_count > 1) {
    const Real across = place.width_u * static_cast<Real>(texture.width);
    const Real down = place.width_v * static_cast<Real>(texture.height);
    mix = LevelsFor(across < down ? down : across, texture.coarsest);
  }
  const auto fine = MixTexels(texture, mix.level, u, v, value);
  if (mix.share == 0) return fine;
  return MixOf(fine, MixTexels(texture, mix.level + 1, u, v, value), mix.share);
}

// Linear light.
template <typename Real>
Vec3<Real> SampleTexture(const TextureData<Real>& texture, const Surface<Real>& surface) {
  return MixLevels(texture, surface, TexelColour<Real>{texture});
}

// In [0, 1].
template <typename Real>
Real SampleAlpha(const TextureData<Real>& texture, const Surface<Real>& surface) {
  return MixLevels(texture, surface, TexelAlpha<Real>{});
}

}  // namespace sheaf::scalar

#endif  // SHEAF_SCALAR_SAMPLE_TEXTURE_H_
