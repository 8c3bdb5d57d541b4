// What a texture and the colours of vertices multiply the base colour with.
#ifndef SHEAF_RENDER_TINT_SURFACES_H_
#define SHEAF_RENDER_TINT_SURFACES_H_

#include "simd/kernels.h"
#include "simd/streams.h"
#include "src/render/bin_hits.h"
#include "src/stream/frame_view.h"

namespace sheaf {

// Finishes the tints of surfaces[0, bin.batch.count): of spheres they are written, of triangles
// they hold the vertices' colours. Bits: as sheaf::scalar::TintAt. Leaves the texture's colours in
// r, g and b of `texels`.
template <typename Real>
void TintSurfaces(const FrameView<Real>& frame, const Kernels<Real>& kernels, const HitBin& bin,
                  const SurfaceView<Real>& surfaces, const TexelOutput<Real>& texels,
                  const SurfaceOutput<Real>& tinted);

}  // namespace sheaf

#endif  // SHEAF_RENDER_TINT_SURFACES_H_
