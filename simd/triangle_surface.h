// The surface points of rays that hit triangles.
#ifndef SHEAF_SIMD_TRIANGLE_SURFACE_H_
#define SHEAF_SIMD_TRIANGLE_SURFACE_H_

#include "simd/layout.h"

namespace sheaf::simd {

// Writes surfaces[0, batch.count) from the batch's rays, hits and triangles. Left alone are u and v
// unless `needs` has kNeedsCoordinates, the face unless it has kNeedsNormals (the normal then is
// the face's) and the tint unless it has kNeedsTint. Bits: as sheaf::scalar::TriangleSurface. Reads
// and writes PaddedCount(batch.count) lanes.
template <typename Real>
void TriangleSurfaces(const TriangleArrays<Real>& triangles, const RayView<Real>& rays,
                      const HitView<Real>& hits, const HitBatch& batch, std::uint32_t needs,
                      const SurfaceOutput<Real>& surfaces);

}  // namespace sheaf::simd

#endif  // SHEAF_SIMD_TRIANGLE_SURFACE_H_
