#include "simd/filter_noise.h"

#include <cstdlib>
#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simd/filter_noise.cc"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "hwy/highway.h"
#include "simd/dispatch.h"
#include "simd/math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace sheaf::simd::HWY_NAMESPACE {

inline constexpr std::uint32_t kTileStride = kDenoiseColumns + 2 * kDenoisePatch;
static_assert(kDenoisePatch == 1 && kTileStride % kMaxLanes == 0);

// Of a tile, row by row; `distance` has a row and a column more on each side.
template <typename Real>
struct TileSums {
  alignas(kAlignment) Real distance[(kDenoiseRows + 2) * kTileStride];
  // Of one row, from one column before the tile on; the last columns' patches lack neighbours.
  alignas(kAlignment) Real column[kTileStride + kMaxLanes];
  alignas(kAlignment) Real change[3][kDenoiseRows * kTileStride];
  alignas(kAlignment) Real weight[kDenoiseRows * kTileStride];
  alignas(kAlignment) Real variance[kDenoiseRows * kTileStride];
};

// As scalar::NoiseWeight.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V NoiseWeight(D d, V x) {
  using Real = hn::TFromD<D>;
  const V t = hn::Sub(hn::Set(d, Real(1)), hn::Mul(x, hn::Set(d, Real(0.125))));
  const V positive = hn::IfThenElseZero(hn::Gt(t, hn::Zero(d)), t);  // false for NaN
  const V square = hn::Mul(positive, positive);
  const V fourth = hn::Mul(square, square);
  return hn::Mul(fourth, fourth);
}

// As scalar::ColourDistance, of the tile's pixels and those around it.
template <typename Real>
HWY_INLINE void StoreDistances(const NoisyView<Real>& picture, const NoisyTile& tile,
                               std::ptrdiff_t offset, TileSums<Real>& sums) {
  const Lanes<Real> d;
  for (std::uint32_t y = 0; y < tile.rows + 2; ++y) {
    const std::ptrdiff_t row = (static_cast<std::ptrdiff_t>(y) - 1) * tile.stride - 1;
    for (std::uint32_t x = 0; x < tile.columns + 2; x += LaneCount(d)) {
      const auto square = [&](const Real* plane) SHEAF_LAMBDA {
        const Real* const at = plane + row + x;
        const auto difference = hn::Sub(hn::LoadU(d, at), hn::LoadU(d, at + offset));
        return hn::Mul(difference, difference);
      };
      hn::Store(hn::Add(hn::Add(square(picture.colour[0]), square(picture.colour[1])),
                        square(picture.colour[2])),
                d, sums.distance + y * kTileStride + x);
    }
  }
}

// As scalar::GuideDistance.
template <class D, typename Real = hn::TFromD<D>, class V = hn::Vec<D>>
HWY_INLINE V GuideDistance(D d, const NoisyView<Real>& picture, std::ptrdiff_t at,
                           std::ptrdiff_t offset, V dx, V dy) {
  const auto load = [&](const Real* plane) SHEAF_LAMBDA { return hn::LoadU(d, plane + at); };
  const auto other = [&](const Real* plane)
                         SHEAF_LAMBDA { return hn::LoadU(d, plane + at + offset); };
  const V expected = hn::Add(hn::Add(load(picture.nearness), hn::Mul(load(picture.nearness_x), dx)),
                             hn::Mul(load(picture.nearness_y), dy));
  const V miss = hn::Sub(other(picture.nearness), expected);
  const V p = load(picture.nearness_precision), q = other(picture.nearness_precision);
  V sum = hn::Mul(hn::Mul(miss, miss), hn::IfThenElse(hn::Lt(p, q), p, q));
  for (int i = 0; i < kGuideCount; ++i) {
    const V difference = hn::Sub(load(picture.guide[i]), other(picture.guide[i]));
    sum = hn::Add(sum, hn::Mul(difference, difference));
  }
  return sum;
}

// Adds the pixels at (dx, dy) from the tile's to the sums.
template <typename Real>
HWY_INLINE void AddNeighbours(const NoisyView<Real>& picture, const NoisyTile& tile, int dx, int dy,
                              TileSums<Real>& sums) {
  const Lanes<Real> d;
  using V = hn::Vec<Lanes<Real>>;
  const std::ptrdiff_t offset = dy * tile.stride + dx;
  StoreDistances(picture, tile, offset, sums);
  const V share = hn::Set(d, Real(1) / 9);
  const V tiny = hn::Set(d, Real(1e-36)),
          spread2 = hn::Set(d, Real(kDenoiseSpread * kDenoiseSpread));
  const V right = hn::Set(d, static_cast<Real>(dx)), down = hn::Set(d, static_cast<Real>(dy));
  for (std::uint32_t y = 0; y < tile.rows; ++y) {
    const Real* const distance = sums.distance + y * kTileStride;
    for (std::uint32_t x = 0; x < tile.columns + 2; x += LaneCount(d)) {
      const V above = hn::Load(d, distance + x), middle = hn::Load(d, distance + x + kTileStride),
              below = hn::Load(d, distance + x + 2 * kTileStride);
      hn::Store(hn::Add(hn::Add(above, middle), below), d, sums.column + x);
    }
    for (std::uint32_t x = 0; x < tile.columns; x += LaneCount(d)) {
      const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(y) * tile.stride + x;
      const V patch =
          hn::Add(hn::Add(hn::Load(d, sums.column + x), hn::LoadU(d, sums.column + x + 1)),
                  hn::LoadU(d, sums.column + x + 2));
      const V v = hn::LoadU(d, picture.mean_variance + at),
              w = hn::LoadU(d, picture.mean_variance + at + offset);
      const V expected = hn::Add(v, hn::IfThenElse(hn::Lt(v, w), v, w));
      const V colour = hn::Div(hn::Sub(hn::Mul(patch, share), expected),
                               hn::Add(hn::Mul(hn::Add(v, w), spread2), tiny));
      const V guide = GuideDistance(d, picture, at, offset, right, down);
      const V weight = NoiseWeight(d, hn::IfThenElse(hn::Gt(colour, guide), colour, guide));
      const std::uint32_t in_tile = y * kTileStride + x;
      const auto add = [&](Real* to, V what)
                           SHEAF_LAMBDA { hn::Store(hn::Add(hn::Load(d, to), what), d, to); };
      add(sums.weight + in_tile, weight);
      add(sums.variance + in_tile,
          hn::Mul(hn::Mul(weight, weight), hn::LoadU(d, picture.variance + at + offset)));
      for (int c = 0; c < 3; ++c) {
        const Real* const from = picture.colour[c] + at;
        add(sums.change[c] + in_tile,
            hn::Mul(weight, hn::Sub(hn::LoadU(d, from + offset), hn::LoadU(d, from))));
      }
    }
  }
}

template <typename Real>
HWY_INLINE void StoreTile(const NoisyView<Real>& picture, const NoisyTile& tile,
                          TileSums<Real>& sums, const DenoisedOutput<Real>& denoised) {
  const Lanes<Real> d;
  const std::size_t bytes = tile.columns * sizeof(Real);
  for (std::uint32_t y = 0; y < tile.rows; ++y) {
    const std::ptrdiff_t row = static_cast<std::ptrdiff_t>(y) * tile.stride;
    for (std::uint32_t x = 0; x < tile.columns; x += LaneCount(d)) {
      const std::uint32_t in_tile = y * kTileStride + x;
      const auto weights = hn::Load(d, sums.weight + in_tile);
      for (int c = 0; c < 3; ++c) {
        Real* const change = sums.change[c] + in_tile;
        hn::Store(hn::Add(hn::LoadU(d, picture.colour[c] + row + x),
                          hn::Div(hn::Load(d, change), weights)),
                  d, change);
      }
      Real* const variance = sums.variance + in_tile;
      hn::Store(hn::Div(hn::Load(d, variance), hn::Mul(weights, weights)), d, variance);
    }
    // Beside the tile another thread writes.
    for (int c = 0; c < 3; ++c) {
      std::memcpy(denoised.colour[c] + row, sums.change[c] + y * kTileStride, bytes);
    }
    std::memcpy(denoised.variance + row, sums.variance + y * kTileStride, bytes);
  }
}

template <typename Real>
void FilterNoiseLanes(const NoisyView<Real>& picture, const NoisyTile& tile,
                      const DenoisedOutput<Real>& denoised) {
  const Lanes<Real> d;
  TileSums<Real> sums;
  for (std::uint32_t y = 0; y < tile.rows; ++y) {
    for (std::uint32_t x = 0; x < tile.columns; x += LaneCount(d)) {
      const std::uint32_t in_tile = y * kTileStride + x;
      const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(y) * tile.stride + x;
      for (int c = 0; c < 3; ++c) hn::Store(hn::Zero(d), d, sums.change[c] + in_tile);
      hn::Store(hn::Set(d, Real(1)), d, sums.weight + in_tile);
      hn::Store(hn::LoadU(d, picture.variance + at), d, sums.variance + in_tile);
    }
  }
  for (int j = -kDenoiseRadius; j <= kDenoiseRadius; ++j) {
    for (int i = -kDenoiseRadius; i <= kDenoiseRadius; ++i) {
      const int steps = std::abs(i) + std::abs(j);
      if (steps == 0 || steps == kDenoiseCorner) continue;
      AddNeighbours(picture, tile, i * tile.step, j * tile.step, sums);
    }
  }
  StoreTile(picture, tile, sums, denoised);
}
SHEAF_NAME_KERNELS(FilterNoise);

}  // namespace sheaf::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sheaf::simd {
SHEAF_EXPORT(FilterNoise);
}  // namespace sheaf::simd
#endif  // HWY_ONCE
