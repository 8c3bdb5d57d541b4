// How much of surfaces rays stand for.
#ifndef SHEAF_SIMD_FIND_FOOTPRINTS_H_
#define SHEAF_SIMD_FIND_FOOTPRINTS_H_

#include "simd/primitives.h"
#include "simd/shading.h"
#include "simd/streams.h"

namespace sheaf {

// Writes the widths of surfaces[0, batch.count), the hits of a batch on primitives of a kind, and
// with kNeedsFootprint what the cones cover of u and v, which triangles without coordinates leave
// alone. `surfaces` gives faces, directions and sources. Bits: as sheaf::scalar::MeasureFootprint.
// Reads and writes PaddedCount(batch.count) lanes.
template <typename Real>
using FindFootprintsKernel = void(const GeometryView<Real>& geometry, PrimitiveKind kind,
                                  const ConeView<Real>& cones, const HitView<Real>& hits,
                                  const HitBatch& batch, std::uint32_t needs,
                                  const SurfaceView<Real>& surfaces,
                                  const SurfaceOutput<Real>& footprints);

}  // namespace sheaf

#endif  // SHEAF_SIMD_FIND_FOOTPRINTS_H_
