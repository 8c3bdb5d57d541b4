// From arrays of any length and stride to the kernels that walk instances, block by block.
#include <algorithm>
#include <cstddef>
#include <type_traits>

#include "sheaf/instances.h"
#include "src/bvh/check_arrays.h"
#include "src/bvh/instances_access.h"
#include "src/bvh/ray_batches.h"
#include "src/bvh/ray_block.h"
#include "src/bvh/walk_instances.h"

namespace sheaf {
namespace {

constexpr std::uint32_t kBlock = 256;  // rays at a time: what a group of most lanes holds

template <typename Real>
Kernels<Real> KernelsOf(Target target) {
  static const Kernels<Real> best = StrictKernels<Real>(0);
  return target == Target() || target.is_scalar() ? best : StrictKernels<Real>(target.id());
}

// A block of rays as they come, and what they hit.
template <typename Real>
class InstanceTracer {
 public:
  InstanceTracer(const InstancesOf<Real>& instances, const TraceOptionsOf<Real>& options)
      : data_(InstancesAccess::DataOf(instances)),
        kernels_(KernelsOf<Real>(options.target)),
        is_scalar_(options.target.is_scalar()) {
    if (data_) tree_ = data_->forest.view();
  }

  void Take(const RayArraysOf<Real>& rays, const InstanceRayArrays& sources,
            const TraceIntervalOf<Real>& interval, std::size_t first, std::uint32_t n) {
    count_ = n;
    block_.Take(rays, interval, first, n, 1);
    has_sources_ = sources.source_instance != nullptr;
    if (has_sources_) Gather(sources.source_instance, rays.stride, first, n, source_instance_);
  }

  void FindClosest() {
    const RayIntervals<Real>& intervals = block_.intervals();
    for (std::uint32_t i = 0; i < count_; ++i) {
      // An infinite interval admits every finite t.
      const Real t_max = intervals.t_max ? intervals.t_max[i] : intervals.all_t_max;
      t_[i] = t_max > kDefaultTMax<Real> ? kDefaultTMax<Real> : t_max;
      u_[i] = v_[i] = 0;
      primitive_[i] = kNoPrimitive;
      instance_[i] = kNoInstance;
    }
    if (!data_) return;
    const InstanceHits<Real> hits = {t_, u_, v_, primitive_, instance_};
    if (is_scalar_) {
      for (std::uint32_t i = 0; i < count_; ++i) {
        WalkClosestByScalar(tree_, block_.view(), sources(), intervals, i, hits);
      }
    } else {
      WalkClosest(tree_, kernels_, block_.view(), sources(), intervals, count_, hits);
    }
  }

  void PutHits(const HitArraysOf<Real>& hits, std::uint32_t* instance, std::size_t first) {
    Scatter(t_, count_, hits.t, hits.stride, first);
    Scatter(u_, count_, hits.u, hits.stride, first);
    Scatter(v_, count_, hits.v, hits.stride, first);
    Scatter(primitive_, count_, hits.primitive, hits.stride, first);
    Scatter(instance_, count_, instance, hits.stride, first);
    if (!hits.object) return;
    for (std::uint32_t i = 0; i < count_; ++i) {
      if (primitive_[i] == kNoPrimitive) continue;
      const auto& geometry = *data_->geometries[data_->forest.object[instance_[i]]];
      primitive_[i] = geometry.object_of(primitive_[i]);
    }
    Scatter(primitive_, count_, hits.object, hits.stride, first);
  }

  void FindOccluded(std::uint32_t* occluded) {
    std::fill_n(occluded, count_, 0u);
    if (!data_) return;
    const RayIntervals<Real>& intervals = block_.intervals();
    if (!is_scalar_) {
      return WalkOccluded(tree_, kernels_, block_.view(), sources(), intervals, count_, occluded);
    }
    for (std::uint32_t i = 0; i < count_; ++i) {
      const Real t_max = intervals.t_max ? intervals.t_max[i] : intervals.all_t_max;
      const auto ray = InstanceRayAt(block_.view(), sources(), intervals, t_max, i);
      occluded[i] = scalar::TraceOccluded(tree_, ray) ? 1 : 0;
    }
  }

 private:
  const std::uint32_t* sources() const { return has_sources_ ? source_instance_ : nullptr; }

  const InstancesAccess::Data<Real>* data_;
  Kernels<Real> kernels_;
  bool is_scalar_, has_sources_ = false;
  InstanceTree<Real> tree_{};
  std::uint32_t count_ = 0;
  RayBlock<Real, kBlock> block_;
  std::uint32_t source_instance_[kBlock];
  Real t_[kBlock], u_[kBlock], v_[kBlock];
  std::uint32_t primitive_[kBlock], instance_[kBlock];
};

}  // namespace

template <typename Real>
Status TraceClosest(const InstancesOf<Real>& instances, const RayArraysOf<Real>& rays,
                    std::size_t count, const HitArraysOf<Real>& hits, std::uint32_t* instance,
                    const TraceOptionsOf<Real>& options, const InstanceRayArrays& sources) {
  if (Status checked = CheckRays(rays, count); !checked) return checked;
  InstanceTracer<Real> tracer(instances, options);
  ForEachBatch(count, kBlock, [&](std::size_t first, std::uint32_t n) {
    tracer.Take(rays, sources, options.interval, first, n);
    tracer.FindClosest();
    tracer.PutHits(hits, instance, first);
  });
  return Done{};
}

template <typename Real>
Status TraceOccluded(const InstancesOf<Real>& instances, const RayArraysOf<Real>& rays,
                     std::size_t count, std::uint32_t* occluded,
                     const TraceOptionsOf<Real>& options, const InstanceRayArrays& sources) {
  if (Status checked = CheckRays(rays, count); !checked) return checked;
  if (count > 0 && !occluded) return NullArray("occluded");
  InstanceTracer<Real> tracer(instances, options);
  ForEachBatch(count, kBlock, [&](std::size_t first, std::uint32_t n) {
    tracer.Take(rays, sources, options.interval, first, n);
    tracer.FindOccluded(occluded + first);
  });
  return Done{};
}

#define SHEAF_INSTANTIATE(Real)                                                                  \
  template Status TraceClosest(const InstancesOf<Real>&, const RayArraysOf<Real>&, std::size_t,  \
                               const HitArraysOf<Real>&, std::uint32_t*,                         \
                               const TraceOptionsOf<Real>&, const InstanceRayArrays&);           \
  template Status TraceOccluded(const InstancesOf<Real>&, const RayArraysOf<Real>&, std::size_t, \
                                std::uint32_t*, const TraceOptionsOf<Real>&,                     \
                                const InstanceRayArrays&)
SHEAF_INSTANTIATE(float);
SHEAF_INSTANTIATE(double);
#undef SHEAF_INSTANTIATE

}  // namespace sheaf
