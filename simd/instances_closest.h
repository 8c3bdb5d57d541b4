// The nearest hit of each ray of a batch among instances.
#ifndef SHEAF_SIMD_INSTANCES_CLOSEST_H_
#define SHEAF_SIMD_INSTANCES_CLOSEST_H_

#include "simd/instances.h"
#include "simd/query.h"
#include "simd/streams.h"
#include "simd/trace_closest.h"

namespace sheaf {

// Puts into hits[0, count) what rays hit in instances, by `trace` for each object. `t_min`: as of
// RayIntervals; hits.t is t_max. `source_instance`: of each ray's source; null: kNoInstance for
// all. Rays that box tests do not hold for (tree.h) are left alone: returns how many of them can
// hit anything. Bits: as sheaf::scalar::TraceClosest of instances.h, of the other rays. Reads
// PaddedCount(count) lanes of rays.
template <typename Real>
using InstancesClosestKernel = std::uint32_t(const InstanceTree<Real>& tree,
                                             TraceClosestKernel<Real>* trace,
                                             const RayView<Real>& rays,
                                             const std::uint32_t* source_instance,
                                             const RayIntervals<Real>& t_min, std::uint32_t count,
                                             const InstanceHits<Real>& hits);

}  // namespace sheaf

#endif  // SHEAF_SIMD_INSTANCES_CLOSEST_H_
