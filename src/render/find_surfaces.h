// The step from hits to the surfaces that are shaded.
#ifndef SHEAF_RENDER_FIND_SURFACES_H_
#define SHEAF_RENDER_FIND_SURFACES_H_

#include "simd/kernels.h"
#include "simd/streams.h"
#include "src/render/bin_hits.h"
#include "src/stream/frame_view.h"
#include "src/stream/stream.h"

namespace sheaf {

// Writes the surfaces of the bin's hits to surfaces[0, bin.batch.count), as far as the bin's
// material needs them, and returns what to read them through.
template <typename Real>
SurfaceView<Real> FindSurfaces(const FrameView<Real>& frame, const Kernels<Real>& kernels,
                               const HitBin& bin, const RayView<Real>& rays,
                               const HitView<Real>& hits, SurfaceStream<Real>& surfaces);

}  // namespace sheaf

#endif  // SHEAF_RENDER_FIND_SURFACES_H_
