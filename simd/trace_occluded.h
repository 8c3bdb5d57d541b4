// Whether each ray of a batch hits anything.
#ifndef SHEAF_SIMD_TRACE_OCCLUDED_H_
#define SHEAF_SIMD_TRACE_OCCLUDED_H_

#include "simd/query.h"
#include "simd/streams.h"
#include "simd/tree.h"

namespace sheaf {

// Writes occluded[0, count): 1 where some primitive lies within the ray's interval, else 0. The
// rays as in TraceClosest. Reads and writes PaddedCount(count) lanes.
template <typename Real>
using TraceOccludedKernel = void(const TreeView<Real>& tree, const RayView<Real>& rays,
                                 const RayIntervals<Real>& intervals, std::uint32_t count,
                                 Coherence coherence, std::uint32_t* occluded);

}  // namespace sheaf

#endif  // SHEAF_SIMD_TRACE_OCCLUDED_H_
