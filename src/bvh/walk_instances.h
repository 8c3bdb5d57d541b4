// Rays through instances, by kernel or by the scalar baseline: what queries and frames share.
#ifndef SHEAF_BVH_WALK_INSTANCES_H_
#define SHEAF_BVH_WALK_INSTANCES_H_

#include <cstdint>

#include "simd/kernels.h"
#include "src/scalar/instances.h"

namespace sheaf {

// Ray `i` of arrays, which ends at `t_max`.
template <typename Real>
scalar::Ray<Real> InstanceRayAt(const RayView<Real>& rays, const std::uint32_t* source_instance,
                                const RayIntervals<Real>& intervals, Real t_max, std::uint32_t i) {
  scalar::Ray<Real> ray = scalar::RayAt(rays, i);
  ray.t_min = intervals.t_min ? intervals.t_min[i] : intervals.all_t_min;
  ray.t_max = t_max;
  if (source_instance) ray.instance = source_instance[i];
  return ray;
}

// The baseline, and what no box test in Real holds for. Contracts as of InstancesClosestKernel.
template <typename Real>
void WalkClosestByScalar(const InstanceTree<Real>& tree, const RayView<Real>& rays,
                         const std::uint32_t* source_instance, const RayIntervals<Real>& intervals,
                         std::uint32_t i, const InstanceHits<Real>& hits) {
  const scalar::Hit<Real> before = {hits.t[i], hits.primitive[i], hits.u[i], hits.v[i],
                                    hits.instance[i]};
  const scalar::Hit<Real> nearest = scalar::TraceClosest(
      tree, InstanceRayAt(rays, source_instance, intervals, hits.t[i], i), before);
  hits.t[i] = nearest.t;
  hits.u[i] = nearest.u;
  hits.v[i] = nearest.v;
  hits.primitive[i] = nearest.primitive;
  hits.instance[i] = nearest.instance;
}

template <typename Real>
void WalkClosest(const InstanceTree<Real>& tree, const Kernels<Real>& kernels,
                 const RayView<Real>& rays, const std::uint32_t* source_instance,
                 const RayIntervals<Real>& intervals, std::uint32_t count,
                 const InstanceHits<Real>& hits) {
  const std::uint32_t left = kernels.instances_closest(tree, kernels.trace_closest, rays,
                                                       source_instance, intervals, count, hits);
  for (std::uint32_t i = 0; left > 0 && i < count; ++i) {
    const Real t = hits.t[i];
    if (scalar::FitsBoxes(InstanceRayAt(rays, source_instance, intervals, t, i))) continue;
    WalkClosestByScalar(tree, rays, source_instance, intervals, i, hits);
  }
}

template <typename Real>
void WalkOccluded(const InstanceTree<Real>& tree, const Kernels<Real>& kernels,
                  const RayView<Real>& rays, const std::uint32_t* source_instance,
                  const RayIntervals<Real>& intervals, std::uint32_t count,
                  std::uint32_t* occluded) {
  const std::uint32_t left = kernels.instances_occluded(
      tree, kernels.trace_occluded, rays, source_instance, intervals, count, occluded);
  for (std::uint32_t i = 0; left > 0 && i < count; ++i) {
    const Real t_max = intervals.t_max ? intervals.t_max[i] : intervals.all_t_max;
    const auto ray = InstanceRayAt(rays, source_instance, intervals, t_max, i);
    if (occluded[i] != 0 || scalar::FitsBoxes(ray)) continue;
    occluded[i] = scalar::TraceOccluded(tree, ray) ? 1 : 0;
  }
}

}  // namespace sheaf

#endif  // SHEAF_BVH_WALK_INSTANCES_H_
