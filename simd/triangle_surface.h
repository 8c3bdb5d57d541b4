// The surface points of rays that hit triangles.
#ifndef SHEAF_SIMD_TRIANGLE_SURFACE_H_
#define SHEAF_SIMD_TRIANGLE_SURFACE_H_

#include "simd/shading.h"
#include "simd/streams.h"
#include "simd/tree.h"

namespace sheaf {

// Writes surfaces[0, batch.count) from the batch's rays, hits and triangles: with the face's
// normal, and without a face or a tint, which BlendVertices adds. u and v are left alone unless
// `needs` has kNeedsCoordinates. Bits: as sheaf::scalar::TriangleSurface of triangles without
// normals. Reads and writes PaddedCount(batch.count) lanes.
template <typename Real>
using TriangleSurfacesKernel = void(const TriangleArrays<Real>& triangles,
                                    const RayView<Real>& rays, const HitView<Real>& hits,
                                    const HitBatch& batch, std::uint32_t needs,
                                    const SurfaceOutput<Real>& surfaces);

}  // namespace sheaf

#endif  // SHEAF_SIMD_TRIANGLE_SURFACE_H_
