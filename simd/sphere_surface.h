// The surface points of rays that hit spheres.
#ifndef SHEAF_SIMD_SPHERE_SURFACE_H_
#define SHEAF_SIMD_SPHERE_SURFACE_H_

#include "simd/shading.h"
#include "simd/streams.h"
#include "simd/tree.h"

namespace sheaf {

// Writes surfaces[0, batch.count) from the batch's rays, hits and spheres. Directions are unit
// vectors. u and v are left alone unless `needs` has kNeedsCoordinates, faces and tints always.
// Bits: as sheaf::scalar::SphereSurface. Reads and writes PaddedCount(batch.count) lanes.
template <typename Real>
using SphereSurfacesKernel = void(const SphereArrays<Real>& spheres, const RayView<Real>& rays,
                                  const HitView<Real>& hits, const HitBatch& batch,
                                  std::uint32_t needs, const SurfaceOutput<Real>& surfaces);

}  // namespace sheaf

#endif  // SHEAF_SIMD_SPHERE_SURFACE_H_
