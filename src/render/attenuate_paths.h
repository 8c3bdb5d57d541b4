// The step, where bodies attenuate, from hits to what is left of the rays' throughputs.
#ifndef SHEAF_RENDER_ATTENUATE_PATHS_H_
#define SHEAF_RENDER_ATTENUATE_PATHS_H_

#include <cstdint>

#include "simd/streams.h"
#include "src/stream/frame_view.h"

namespace sheaf {

// Multiplies the throughput of each of `count` rays by what its body lets pass on the way to its
// hit. Bits: as sheaf::scalar::TransmittanceOf.
template <typename Real>
void AttenuatePaths(const FrameView<Real>& frame, const RayView<Real>& rays,
                    const HitView<Real>& hits, std::uint32_t count, const PathOutput<Real>& paths);

}  // namespace sheaf

#endif  // SHEAF_RENDER_ATTENUATE_PATHS_H_
