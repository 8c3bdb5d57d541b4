#include "simd/instances_occluded.h"

// Highway compiles the file once a target: it includes itself through foreach_target.h.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simd/instances_occluded.cc"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "hwy/highway.h"
#include "simd/dispatch.h"
#include "simd/walk_instances-inl.h"

HWY_BEFORE_NAMESPACE();
namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE {

template <typename Real>
class AnyInInstances {
 public:
  AnyInInstances(const InstanceTree<Real>& tree, TraceOccludedKernel<Real>* trace,
                 const RayIntervals<Real>& intervals, std::uint32_t* occluded)
      : tree_(tree), trace_(trace), intervals_(intervals), occluded_(occluded) {}

  HWY_INLINE Real LastT(std::uint32_t position) const {
    if (occluded_[position] != 0) return kDone<Real>;
    return EndOf(intervals_.t_max ? intervals_.t_max[position] : intervals_.all_t_max);
  }

  bool Trace(std::uint32_t instance, const MappedRays<Real>& mapped, std::uint32_t count,
             RayGroup<Real>& group) {
    trace_(tree_.trees[tree_.object[instance]], mapped.rays(), mapped.intervals(), count,
           Coherence::kUnknown, found_);
    bool is_any = false;
    for (std::uint32_t i = 0; i < count; ++i) {
      if (found_[i] == 0) continue;
      const std::uint32_t lane = mapped.lane[i];
      occluded_[group.position[lane]] = 1;
      group.t_best[lane] = kDone<Real>;
      is_any = true;
    }
    return is_any;
  }

 private:
  const InstanceTree<Real>& tree_;
  TraceOccludedKernel<Real>* trace_;
  const RayIntervals<Real>& intervals_;
  std::uint32_t* occluded_;
  alignas(kAlignment) std::uint32_t found_[MappedRays<Real>::kRoom];
};

template <typename Real>
std::uint32_t InstancesOccludedLanes(const InstanceTree<Real>& tree,
                                     TraceOccludedKernel<Real>* trace, const RayView<Real>& rays,
                                     const std::uint32_t* source_instance,
                                     const RayIntervals<Real>& intervals, std::uint32_t count,
                                     std::uint32_t* occluded) {
  if (tree.node_count == 0) return 0;
  AnyInInstances<Real> output(tree, trace, intervals, occluded);
  InstanceWalk<AnyInInstances<Real>, Real> walk(tree, output);
  return walk.Trace(rays, source_instance, intervals, count);
}

SHEAF_NAME_KERNELS(InstancesOccluded);

}  // namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sheaf::SHEAF_SIMD {
SHEAF_EXPORT(InstancesOccluded);
}  // namespace sheaf::SHEAF_SIMD
#endif  // HWY_ONCE
