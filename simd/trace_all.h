// All hits of each ray of a batch, in order.
#ifndef SHEAF_SIMD_TRACE_ALL_H_
#define SHEAF_SIMD_TRACE_ALL_H_

#include "simd/hit_list.h"
#include "simd/query.h"
#include "simd/streams.h"
#include "simd/tree.h"

namespace sheaf {

// Writes the lists of rays [0, count). Rays that miss, and equal t, as TraceClosestKernel has them.
// Bits: as sheaf::scalar::ListHits, on every target. Reads PaddedCount(count) lanes of rays.
template <typename Real>
using TraceAllKernel = void(const TreeView<Real>& tree, const RayView<Real>& rays,
                            const RayIntervals<Real>& intervals, std::uint32_t count,
                            const HitRuleView& rules, const HitListOutput<Real>& lists);

}  // namespace sheaf

#endif  // SHEAF_SIMD_TRACE_ALL_H_
