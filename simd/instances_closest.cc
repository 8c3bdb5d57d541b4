#include "simd/instances_closest.h"

// Highway compiles the file once a target: it includes itself through foreach_target.h.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simd/instances_closest.cc"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "hwy/highway.h"
#include "simd/dispatch.h"
#include "simd/walk_instances-inl.h"

HWY_BEFORE_NAMESPACE();
namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE {

template <typename Real>
class NearestInInstances {
 public:
  NearestInInstances(const InstanceTree<Real>& tree, TraceClosestKernel<Real>* trace,
                     const InstanceHits<Real>& hits)
      : tree_(tree), trace_(trace), hits_(hits) {}

  HWY_INLINE Real LastT(std::uint32_t position) const { return EndOf(hits_.t[position]); }

  bool Trace(std::uint32_t instance, const MappedRays<Real>& mapped, std::uint32_t count,
             RayGroup<Real>& group) {
    trace_(tree_.trees[tree_.object[instance]], mapped.rays(), mapped.intervals(), count,
           Coherence::kUnknown, {t_, u_, v_, primitive_});
    bool is_nearer = false;
    for (std::uint32_t i = 0; i < count; ++i) {
      if (primitive_[i] == kNoPrimitive) continue;
      const std::uint32_t lane = mapped.lane[i], at = group.position[lane];
      if (!TakesOver(t_[i], instance, hits_.t[at], hits_.primitive[at], hits_.instance[at])) {
        continue;
      }
      hits_.t[at] = group.t_best[lane] = t_[i];
      hits_.u[at] = u_[i];
      hits_.v[at] = v_[i];
      hits_.primitive[at] = primitive_[i];
      hits_.instance[at] = instance;
      is_nearer = true;
    }
    return is_nearer;
  }

 private:
  static constexpr std::uint32_t kRoom = MappedRays<Real>::kRoom;

  const InstanceTree<Real>& tree_;
  TraceClosestKernel<Real>* trace_;
  const InstanceHits<Real>& hits_;
  alignas(kAlignment) Real t_[kRoom], u_[kRoom], v_[kRoom];
  alignas(kAlignment) std::uint32_t primitive_[kRoom];
};

template <typename Real>
std::uint32_t InstancesClosestLanes(const InstanceTree<Real>& tree, TraceClosestKernel<Real>* trace,
                                    const RayView<Real>& rays, const std::uint32_t* source_instance,
                                    const RayIntervals<Real>& t_min, std::uint32_t count,
                                    const InstanceHits<Real>& hits) {
  if (tree.node_count == 0) return 0;
  NearestInInstances<Real> output(tree, trace, hits);
  InstanceWalk<NearestInInstances<Real>, Real> walk(tree, output);
  return walk.Trace(rays, source_instance, t_min, count);
}

SHEAF_NAME_KERNELS(InstancesClosest);

}  // namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sheaf::SHEAF_SIMD {
SHEAF_EXPORT(InstancesClosest);
}  // namespace sheaf::SHEAF_SIMD
#endif  // HWY_ONCE
