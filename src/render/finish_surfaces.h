// What a material's textures say of surfaces besides their base colour.
#ifndef SHEAF_RENDER_FINISH_SURFACES_H_
#define SHEAF_RENDER_FINISH_SURFACES_H_

#include "simd/streams.h"
#include "src/render/bin_hits.h"
#include "src/stream/frame_view.h"

namespace sheaf {

// One surface at a time, as texels are looked up (TintSurfaces), whose tints are there already.

// Sets u and v of surfaces[0, bin.batch.count), on spheres. Bits: as sheaf::scalar::PlaceOnSphere.
template <typename Real>
void PlaceOnSpheres(const HitBin& bin, const SurfaceView<Real>& surfaces,
                    const SurfaceOutput<Real>& placed);

// Turns the shading normals of surfaces[0, bin.batch.count), triangles whose material has a normal
// map. Bits: as sheaf::scalar::BumpedNormal.
template <typename Real>
void BumpSurfaces(const FrameView<Real>& frame, const HitBin& bin,
                  const SurfaceView<Real>& surfaces, const SurfaceOutput<Real>& bumped);

// Writes the terms of surfaces[0, bin.batch.count), whose material has kNeedsTerms. Bits: as
// sheaf::scalar::MaterialAt.
template <typename Real>
void FinishSurfaces(const FrameView<Real>& frame, const HitBin& bin,
                    const SurfaceView<Real>& surfaces, const SurfaceOutput<Real>& finished);

}  // namespace sheaf

#endif  // SHEAF_RENDER_FINISH_SURFACES_H_
