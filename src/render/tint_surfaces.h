// What a texture and the colours of vertices multiply the base colour with.
#ifndef SHEAF_RENDER_TINT_SURFACES_H_
#define SHEAF_RENDER_TINT_SURFACES_H_

#include <span>

#include "simd/shading.h"
#include "simd/streams.h"
#include "src/render/bin_hits.h"
#include "src/stream/frame_view.h"

namespace sheaf {

// Finishes the tints of surfaces[0, bin.batch.count): of spheres they are written, of triangles
// they hold the vertices' colours. Bits: as sheaf::scalar::TintAt. One surface at a time: look-ups
// of texels have no order that a vector could use.
template <typename Real>
void TintSurfaces(const MaterialData<Real>& material, std::span<const TextureData<Real>> textures,
                  const HitBin& bin, const SurfaceView<Real>& surfaces,
                  const SurfaceOutput<Real>& tinted);

}  // namespace sheaf

#endif  // SHEAF_RENDER_TINT_SURFACES_H_
