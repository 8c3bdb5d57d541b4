// The nearest hit of each ray of a batch.
#ifndef SHEAF_SIMD_TRACE_CLOSEST_H_
#define SHEAF_SIMD_TRACE_CLOSEST_H_

#include "simd/query.h"
#include "simd/streams.h"
#include "simd/tree.h"

namespace sheaf {

// Writes hits[0, count). Rays may be in any order and of any coherence, whatever `coherence` says;
// equal t goes to the lowest primitive id. A ray with a component that is not finite, without a
// direction or with t_min > t_max misses. Rays beyond the limits of box tests (tree.h), and those
// with t_min < 0, are tested against every primitive. Bits: as sheaf::scalar::TraceClosest, on
// every target. Reads and writes PaddedCount(count) lanes.
template <typename Real>
using TraceClosestKernel = void(const TreeView<Real>& tree, const RayView<Real>& rays,
                                const RayIntervals<Real>& intervals, std::uint32_t count,
                                Coherence coherence, const HitOutput<Real>& hits);

}  // namespace sheaf

#endif  // SHEAF_SIMD_TRACE_CLOSEST_H_
