// What the denoiser filters: a picture and what guides the filter, as planes.
#ifndef SHEAF_SIMD_NOISY_PLANES_H_
#define SHEAF_SIMD_NOISY_PLANES_H_

#include <cstddef>
#include <cstdint>

namespace sheaf {

// The filter has kDenoiseLevels passes. Pass l looks at the pixels up to kDenoiseRadius steps of
// 2^l away each way, and compares the kDenoisePatch pixels around both each way.
inline constexpr int kDenoiseLevels = 4;
inline constexpr int kDenoiseRadius = 2;
inline constexpr int kDenoisePatch = 1;

// Tiles of the kernel. With the patch beside it a row fills whole vectors.
inline constexpr std::uint32_t kDenoiseColumns = 64 - 2 * kDenoisePatch;
inline constexpr std::uint32_t kDenoiseRows = 16;

// Pixels around the picture that are read: rows that the last pass reaches, and columns, of which a
// last vector reads more.
inline constexpr int kFilterReach = (kDenoiseRadius << (kDenoiseLevels - 1)) + kDenoisePatch;
inline constexpr int kFilterMargin = kFilterReach + 15;

// Neighbours at the corners, which lie so many steps away across and down together, are left out:
// they cost more than they bring.
inline constexpr int kDenoiseCorner = 2 * kDenoiseRadius;

// Colours are the same if their patches differ by less than about this many standard deviations.
inline constexpr double kDenoiseSpread = 1;

// Guides in units of what may differ; their squares are added.
inline constexpr int kGuideCount = 6;  // albedo, then normal

// Views of planes: element (x, y) lies `stride` floats after (x, y - 1). All numbers are finite,
// and squares of differences do not overflow.
template <typename Real>
struct NoisyView {
  const Real* colour[3];
  const Real* variance;       // of the colours' noise, all channels together
  const Real* mean_variance;  // over the patch
  const Real* guide[kGuideCount];
  const Real* nearness;            // 1 / depth; 0 where nothing was hit
  const Real* nearness_x;          // its slope from pixel to pixel, across
  const Real* nearness_y;          // and down
  const Real* nearness_precision;  // one over the square of what it may differ by
};

// A part of the planes, from (0, 0) of the views on.
struct NoisyTile {
  std::ptrdiff_t stride;
  std::uint32_t columns, rows;  // [1, kDenoiseColumns] and [1, kDenoiseRows]
  int step;                     // pixels between those that are looked at
};

// Where a pass writes; strides and places as those of the view.
template <typename Real>
struct DenoisedOutput {
  Real* colour[3];
  Real* variance;
};

}  // namespace sheaf

#endif  // SHEAF_SIMD_NOISY_PLANES_H_
