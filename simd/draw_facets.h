// Facets of rough surfaces.
#ifndef SHEAF_SIMD_DRAW_FACETS_H_
#define SHEAF_SIMD_DRAW_FACETS_H_

#include "simd/shading.h"
#include "simd/streams.h"

namespace sheaf {

// Writes the facets and gloss of surfaces[0, count) of a material with kNeedsGloss, from a random
// point for each. Bits: as sheaf::scalar::DrawFacet and GlossAt. Reads and writes
// PaddedCount(count) lanes.
template <typename Real>
using DrawFacetsKernel = void(const MaterialData<Real>& material, const SurfaceView<Real>& surfaces,
                              const SampleView<Real>& points, std::uint32_t count,
                              const SurfaceOutput<Real>& facets);

}  // namespace sheaf

#endif  // SHEAF_SIMD_DRAW_FACETS_H_
