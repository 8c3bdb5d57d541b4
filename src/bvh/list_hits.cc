#include "src/bvh/list_hits.h"

#include "simd/kernels.h"
#include "src/bvh/check_arrays.h"
#include "src/bvh/geometry_access.h"
#include "src/scalar/trace_all.h"

namespace sheaf {
namespace {

// The baseline, as the kernel is called.
template <typename Real>
void ScalarAll(const TreeView<Real>& tree, const RayView<Real>& rays,
               const RayIntervals<Real>& intervals, std::uint32_t count, const HitRuleView& rules,
               const HitListOutput<Real>& lists) {
  for (std::uint32_t i = 0; i < count; ++i) {
    const scalar::Ray<Real> ray = {{rays.origin_x[i], rays.origin_y[i], rays.origin_z[i]},
                                   {rays.direction_x[i], rays.direction_y[i], rays.direction_z[i]},
                                   rays.source ? rays.source[i] : kNoPrimitive,
                                   intervals.t_min ? intervals.t_min[i] : intervals.all_t_min,
                                   intervals.t_max ? intervals.t_max[i] : intervals.all_t_max};
    scalar::ListHits(tree, ray, i, rules, lists);
  }
}

template <typename Real>
TraceAllKernel<Real>* KernelOf(Target target) {
  if (target.is_scalar()) return &ScalarAll<Real>;
  // Looked up once: a batch may be one ray.
  static TraceAllKernel<Real>* const kBest = StrictKernels<Real>(0).trace_all;
  return target == Target() ? kBest : StrictKernels<Real>(target.id()).trace_all;
}

}  // namespace

template <typename Real>
Status CheckRules(const RayArraysOf<Real>& rays, std::size_t count,
                  const RuledTraceOptionsOf<Real>& options) {
  if (Status checked = CheckRays(rays, count); !checked) return checked;
  return CheckRules(options.rules, count);
}

template <typename Real>
HitRuleView RuleViewOf(const GeometryOf<Real>& geometry, const HitRules& rules, std::size_t first) {
  HitRuleView view;
  if (rules.object_mask) {
    view.object_mask = rules.object_mask;
    view.first = GeometryAccess::DataOf(geometry).first.data();
    view.object_count = geometry.object_count();
    view.all_ray_mask = rules.all_ray_mask;
    if (rules.ray_mask) view.ray_mask = rules.ray_mask + first;
  }
  view.excluded_count = rules.excluded_per_ray;
  if (rules.excluded) view.excluded = rules.excluded + first * rules.excluded_per_ray;
  return view;
}

template <typename Real>
HitLister<Real>::HitLister(const GeometryOf<Real>& geometry, const RayArraysOf<Real>& rays,
                           const RuledTraceOptionsOf<Real>& options, std::uint32_t capacity)
    : geometry_(geometry),
      arrays_(rays),
      options_(options),
      first_capacity_(capacity),
      capacity_(capacity),
      hits_(std::size_t{kListBlock} * capacity) {}

template <typename Real>
void HitLister<Real>::Take(std::size_t first, std::uint32_t count) {
  count_ = count;
  capacity_ = first_capacity_;
  block_.Take(arrays_, options_.interval, first, count, GeometryAccess::ScaleOf(geometry_));
  rules_ = RuleViewOf(geometry_, options_.rules, first);
  List(nullptr);
}

template <typename Real>
void HitLister<Real>::List(const ListedHit<Real>* after) {
  KernelOf<Real>(options_.target)(
      GeometryAccess::TreeOf(geometry_), block_.view(), block_.intervals(), count_, rules_,
      {hits_.data(), capacity_, listed, counts ? total : nullptr, order, after});
}

template Status CheckRules(const RayArraysOf<float>&, std::size_t,
                           const RuledTraceOptionsOf<float>&);
template Status CheckRules(const RayArraysOf<double>&, std::size_t,
                           const RuledTraceOptionsOf<double>&);
template HitRuleView RuleViewOf(const GeometryOf<float>&, const HitRules&, std::size_t);
template HitRuleView RuleViewOf(const GeometryOf<double>&, const HitRules&, std::size_t);
template class HitLister<float>;
template class HitLister<double>;

}  // namespace sheaf
