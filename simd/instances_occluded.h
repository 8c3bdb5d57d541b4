// Whether rays of a batch hit any instance.
#ifndef SHEAF_SIMD_INSTANCES_OCCLUDED_H_
#define SHEAF_SIMD_INSTANCES_OCCLUDED_H_

#include "simd/instances.h"
#include "simd/query.h"
#include "simd/streams.h"
#include "simd/trace_occluded.h"

namespace sheaf {

// Writes 1 to those of occluded[0, count) whose rays hit an instance, by `trace` for each object;
// rays that are occluded already are not traced. The rest as InstancesClosestKernel.
template <typename Real>
using InstancesOccludedKernel = std::uint32_t(const InstanceTree<Real>& tree,
                                              TraceOccludedKernel<Real>* trace,
                                              const RayView<Real>& rays,
                                              const std::uint32_t* source_instance,
                                              const RayIntervals<Real>& intervals,
                                              std::uint32_t count, std::uint32_t* occluded);

}  // namespace sheaf

#endif  // SHEAF_SIMD_INSTANCES_OCCLUDED_H_
