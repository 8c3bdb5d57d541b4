// One pass of the denoiser, pixel by pixel.
//
// An edge-avoiding à-trous filter (Dammertz et al., "Edge-Avoiding À-Trous Wavelet Transform for
// fast Global Illumination Filtering", HPG 2010): each pass takes a weighted mean of pixels that
// lie twice as far apart as in the pass before. What is different here: colours are compared as
// non-local means does, patch by patch and in units of the noise's variance (Rousselle et al.,
// "Robust Denoising using Feature and Color Information", Pacific Graphics 2013), which passes on
// through the passes (Schied et al., "Spatiotemporal Variance-Guided Filtering", HPG 2017); all
// neighbours weigh the same; and weights are a polynomial.
#ifndef SHEAF_SCALAR_FILTER_NOISE_H_
#define SHEAF_SCALAR_FILTER_NOISE_H_

#include <cstddef>
#include <cstdlib>

#include "simd/noisy_planes.h"

namespace sheaf::scalar {

// About e^-x, and 0 from 8 on. 0 for NaN too.
template <typename Real>
Real NoiseWeight(Real x) {
  const Real t = Real(1) - x * Real(0.125);
  const Real positive = t > 0 ? t : Real(0);
  const Real square = positive * positive;
  const Real fourth = square * square;
  return fourth * fourth;
}

// The squared difference of the colours at `at` and `other`.
template <typename Real>
Real ColourDistance(const NoisyView<Real>& picture, std::ptrdiff_t at, std::ptrdiff_t other) {
  const Real r = picture.colour[0][at] - picture.colour[0][other];
  const Real g = picture.colour[1][at] - picture.colour[1][other];
  const Real b = picture.colour[2][at] - picture.colour[2][other];
  return (r * r + g * g) + b * b;
}

// Summed over the patches around both, down first.
template <typename Real>
Real PatchDistance(const NoisyView<Real>& picture, std::ptrdiff_t stride, std::ptrdiff_t at,
                   std::ptrdiff_t other) {
  static_assert(kDenoisePatch == 1);
  const auto column = [&](std::ptrdiff_t x) {
    return (ColourDistance(picture, at + x - stride, other + x - stride) +
            ColourDistance(picture, at + x, other + x)) +
           ColourDistance(picture, at + x + stride, other + x + stride);
  };
  return (column(-1) + column(0)) + column(1);
}

// How far apart two pixels' surfaces are, in units of what may differ. On a plane the distance
// along the rays is near one over a linear function of the pixel.
template <typename Real>
Real GuideDistance(const NoisyView<Real>& picture, std::ptrdiff_t at, std::ptrdiff_t other, Real dx,
                   Real dy) {
  const Real expected =
      (picture.nearness[at] + picture.nearness_x[at] * dx) + picture.nearness_y[at] * dy;
  const Real miss = picture.nearness[other] - expected;
  const Real p = picture.nearness_precision[at], q = picture.nearness_precision[other];
  Real sum = (miss * miss) * (p < q ? p : q);
  for (int i = 0; i < kGuideCount; ++i) {
    const Real difference = picture.guide[i][at] - picture.guide[i][other];
    sum = sum + difference * difference;
  }
  return sum;
}

// Of the pixel `other`, (dx, dy) pixels away. Two patches of one colour differ by as much as their
// noise lets expect, which is taken off first.
template <typename Real>
Real FilterWeight(const NoisyView<Real>& picture, std::ptrdiff_t stride, std::ptrdiff_t at,
                  std::ptrdiff_t other, Real dx, Real dy) {
  constexpr Real kShare = Real(1) / ((2 * kDenoisePatch + 1) * (2 * kDenoisePatch + 1));
  constexpr Real kTiny = Real(1e-36), kSpread2 = Real(kDenoiseSpread * kDenoiseSpread);
  const Real v = picture.mean_variance[at], w = picture.mean_variance[other];
  const Real distance = PatchDistance(picture, stride, at, other) * kShare;
  const Real colour = (distance - (v + (v < w ? v : w))) / ((v + w) * kSpread2 + kTiny);
  const Real guide = GuideDistance(picture, at, other, dx, dy);
  return NoiseWeight(colour > guide ? colour : guide);
}

// Changes of the colours are added up, so that where nothing differs nothing changes, to the bit.
template <typename Real>
void FilterNoisePixel(const NoisyView<Real>& picture, const NoisyTile& tile, std::ptrdiff_t at,
                      const DenoisedOutput<Real>& denoised) {
  Real change[3] = {0, 0, 0}, weights = 1, variance = picture.variance[at];
  for (int j = -kDenoiseRadius; j <= kDenoiseRadius; ++j) {
    for (int i = -kDenoiseRadius; i <= kDenoiseRadius; ++i) {
      const int steps = std::abs(i) + std::abs(j);
      if (steps == 0 || steps == kDenoiseCorner) continue;
      const int dx = i * tile.step, dy = j * tile.step;
      const std::ptrdiff_t other = at + dy * tile.stride + dx;
      const Real weight = FilterWeight(picture, tile.stride, at, other, static_cast<Real>(dx),
                                       static_cast<Real>(dy));
      weights = weights + weight;
      variance = variance + (weight * weight) * picture.variance[other];
      for (int c = 0; c < 3; ++c) {
        change[c] = change[c] + weight * (picture.colour[c][other] - picture.colour[c][at]);
      }
    }
  }
  for (int c = 0; c < 3; ++c) {
    denoised.colour[c][at] = picture.colour[c][at] + change[c] / weights;
  }
  denoised.variance[at] = variance / (weights * weights);
}

template <typename Real>
void FilterNoise(const NoisyView<Real>& picture, const NoisyTile& tile,
                 const DenoisedOutput<Real>& denoised) {
  for (std::uint32_t y = 0; y < tile.rows; ++y) {
    for (std::uint32_t x = 0; x < tile.columns; ++x) {
      FilterNoisePixel(picture, tile, static_cast<std::ptrdiff_t>(y) * tile.stride + x, denoised);
    }
  }
}

}  // namespace sheaf::scalar

#endif  // SHEAF_SCALAR_FILTER_NOISE_H_
