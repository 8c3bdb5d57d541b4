// Random points of the unit square for a batch of rays.
#ifndef SHEAF_SIMD_DRAW_SAMPLES_H_
#define SHEAF_SIMD_DRAW_SAMPLES_H_

#include "simd/streams.h"

namespace sheaf {

// Writes points[0, count): of each seed the sample `index` for `dimension` (simd/sample_terms.h).
// Bits: as sheaf::scalar::DrawSample. Reads and writes PaddedCount(count) lanes.
template <typename Real>
using DrawSamplesKernel = void(const std::uint32_t* seeds, std::uint32_t index,
                               std::uint32_t dimension, std::uint32_t count,
                               const SampleOutput<Real>& points);

}  // namespace sheaf

#endif  // SHEAF_SIMD_DRAW_SAMPLES_H_
