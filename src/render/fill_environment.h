// The colours of rays that leave the scene.
#ifndef SHEAF_RENDER_FILL_ENVIRONMENT_H_
#define SHEAF_RENDER_FILL_ENVIRONMENT_H_

#include <cstdint>
#include <span>

#include "simd/streams.h"
#include "src/stream/frame_view.h"

namespace sheaf {

// Writes the colours of the rays of `list`, which ascends, of `count` rays. Bits: as
// sheaf::scalar::ColourBeyond.
template <typename Real>
void FillEnvironment(const FrameView<Real>& frame, const RayView<Real>& rays,
                     std::span<const std::uint32_t> list, std::uint32_t count,
                     const ColourOutput<Real>& colours);

}  // namespace sheaf

#endif  // SHEAF_RENDER_FILL_ENVIRONMENT_H_
