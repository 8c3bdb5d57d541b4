// The surface points of rays that hit primitives of one kind.
#ifndef SHEAF_SIMD_SURFACES_H_
#define SHEAF_SIMD_SURFACES_H_

#include "simd/primitives.h"
#include "simd/shading.h"
#include "simd/streams.h"

// A kernel a kind. Those of the second list are compiled for fast arithmetic once more, from which
// the others would gain nothing.
#define SHEAF_SURFACE_KERNELS(X) \
  X(TriangleSurfaces, kTriangle) \
  X(SphereSurfaces, kSphere)     \
  X(DiskSurfaces, kDisk)
#define SHEAF_FAST_SURFACE_KERNELS(X) X(SphereSurfaces, kSphere)

namespace sheaf {

// Writes surfaces[0, batch.count) from the batch's rays, hits and primitives. Spheres: directions
// are unit vectors. Triangles: with the face's normal, which BlendVertices changes where the
// vertices have normals. u and v are left alone unless `needs` has kNeedsCoordinates, and where
// triangles have none; faces and tints always.
// Bits: as sheaf::scalar::SurfaceAt, of triangles without normals. Reads and writes
// PaddedCount(batch.count) lanes.
template <typename Real>
using SurfacesKernel = void(const GeometryView<Real>& geometry, const RayView<Real>& rays,
                            const HitView<Real>& hits, const HitBatch& batch, std::uint32_t needs,
                            const SurfaceOutput<Real>& surfaces);

#define SHEAF_SURFACES_ALIAS(NAME, kind) \
  template <typename Real>               \
  using NAME##Kernel = SurfacesKernel<Real>;
SHEAF_SURFACE_KERNELS(SHEAF_SURFACES_ALIAS)
#undef SHEAF_SURFACES_ALIAS

}  // namespace sheaf

#endif  // SHEAF_SIMD_SURFACES_H_
