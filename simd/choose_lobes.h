// Which ray of each surface is followed, where one alone is.
#ifndef SHEAF_SIMD_CHOOSE_LOBES_H_
#define SHEAF_SIMD_CHOOSE_LOBES_H_

#include "simd/shading.h"
#include "simd/streams.h"

namespace sheaf {

// Writes choices.choice_reflect and so on, and choices.scatter, of surfaces[0, count) of a material
// with kNeedsChoice. `parents` gives the throughputs of the ray stream, null pointers there stand
// for 1; `points` a random number for each surface, u. Bits: as sheaf::scalar::ChooseLobe. Reads
// and writes PaddedCount(count) lanes.
template <typename Real>
using ChooseLobesKernel = void(const MaterialData<Real>& material,
                               const SurfaceView<Real>& surfaces, const PathView<Real>& parents,
                               const SampleView<Real>& points, Roulette roulette,
                               std::uint32_t count, const SurfaceOutput<Real>& choices);

}  // namespace sheaf

#endif  // SHEAF_SIMD_CHOOSE_LOBES_H_
