// What a material's textures say of surfaces besides their base colour.
#ifndef SHEAF_RENDER_FINISH_SURFACES_H_
#define SHEAF_RENDER_FINISH_SURFACES_H_

#include "simd/kernels.h"
#include "simd/streams.h"
#include "src/render/bin_hits.h"
#include "src/stream/frame_view.h"

namespace sheaf {

// Texels are looked up by vectors; what is made of them goes surface by surface.

// Sets u and v of surfaces[0, bin.batch.count), on spheres. Bits: as sheaf::scalar::PlaceOnSphere.
template <typename Real>
void PlaceOnSpheres(const HitBin& bin, const SurfaceView<Real>& surfaces,
                    const SurfaceOutput<Real>& placed);

// Turns the shading normals of surfaces[0, bin.batch.count), triangles whose material has a normal
// map. Bits: as sheaf::scalar::BumpedNormal. Leaves the map's colours in r, g and b of `texels`.
template <typename Real>
void BumpSurfaces(const FrameView<Real>& frame, const Kernels<Real>& kernels, const HitBin& bin,
                  const SurfaceView<Real>& surfaces, const TexelOutput<Real>& texels,
                  const SurfaceOutput<Real>& bumped);

// Writes the terms of surfaces[0, bin.batch.count), whose material has kNeedsTerms and whose tints
// are there already. Bits: as sheaf::scalar::MaterialAt. Leaves in `texels` what textures say.
template <typename Real>
void FinishSurfaces(const FrameView<Real>& frame, const Kernels<Real>& kernels, const HitBin& bin,
                    const SurfaceView<Real>& surfaces, const TexelOutput<Real>& texels,
                    const SurfaceOutput<Real>& finished);

}  // namespace sheaf

#endif  // SHEAF_RENDER_FINISH_SURFACES_H_
