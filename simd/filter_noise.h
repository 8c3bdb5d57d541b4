// One pass of the denoiser over a tile.
#ifndef SHEAF_SIMD_FILTER_NOISE_H_
#define SHEAF_SIMD_FILTER_NOISE_H_

#include "simd/noisy_planes.h"

namespace sheaf {

// Writes the tile's colours and variances after one more pass, those alone: neighbouring tiles may
// be written at the same time. Reads kFilterReach rows above and below, kFilterMargin columns
// left and right. Bits: as
// sheaf::scalar::FilterNoise.
template <typename Real>
using FilterNoiseKernel = void(const NoisyView<Real>& picture, const NoisyTile& tile,
                               const DenoisedOutput<Real>& denoised);

}  // namespace sheaf

#endif  // SHEAF_SIMD_FILTER_NOISE_H_
