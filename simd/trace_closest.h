// The nearest hit of each ray of a batch.
#ifndef SHEAF_SIMD_TRACE_CLOSEST_H_
#define SHEAF_SIMD_TRACE_CLOSEST_H_

#include "simd/layout.h"

namespace sheaf::simd {

// Writes hits[0, count). Rays may be in any order and of any coherence; equal t goes to the lowest
// primitive id. A ray with a component that is not finite, without a direction or with t_min >
// t_max misses. Bits: as sheaf::scalar::TraceClosest, on every target. Reads and writes
// PaddedCount(count) lanes.
template <typename Real>
void TraceClosest(const GeometryView<Real>& geometry, const RayView<Real>& rays,
                  const RayIntervals<Real>& intervals, std::uint32_t count,
                  const HitOutput<Real>& hits);

}  // namespace sheaf::simd

#endif  // SHEAF_SIMD_TRACE_CLOSEST_H_
