#include "simd/trace_closest.h"

// Highway compiles the file once a target: it includes itself through foreach_target.h.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simd/trace_closest.cc"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "hwy/highway.h"
#include "simd/dispatch.h"
#include "simd/hits-inl.h"

HWY_BEFORE_NAMESPACE();
namespace sheaf::simd::HWY_NAMESPACE {

template <typename Real>
void TraceClosestLanes(const GeometryView<Real>& geometry, const RayView<Real>& rays,
                       const RayIntervals<Real>& intervals, std::uint32_t count,
                       const HitOutput<Real>& hits) {
  const Lanes<Real> d;
  const IdLanes<Lanes<Real>> di;
  for (std::uint32_t i = 0; i < count; i += LaneCount(d)) {
    auto lanes = LanesBelow(d, i, count);
    const auto t_min = LoadTMin(d, intervals, i);
    auto t_best = LoadTMax(d, intervals, i);
    auto u_best = hn::Zero(d), v_best = hn::Zero(d);
    auto id_best = hn::Set(di, hn::TFromD<decltype(di)>{kNoPrimitive});
    // Hits at most at t_best arrive here: a closer one wins, an equal one where its id is lower.
    ForEachHit(d, geometry, rays, i, t_min, t_best, lanes,
               [&](auto hit, std::uint32_t id, auto t, auto u, auto v) HWY_ATTR {
                 const auto ids = hn::Set(di, hn::TFromD<decltype(di)>{id});
                 const auto lower = hn::RebindMask(d, hn::Lt(ids, id_best));
                 const auto closer = hn::And(hit, hn::Or(hn::Lt(t, t_best), lower));
                 t_best = hn::IfThenElse(closer, t, t_best);
                 u_best = hn::IfThenElse(closer, u, u_best);
                 v_best = hn::IfThenElse(closer, v, v_best);
                 id_best = hn::IfThenElse(hn::RebindMask(di, closer), ids, id_best);
               });
    hn::StoreU(t_best, d, hits.t + i);
    hn::StoreU(u_best, d, hits.u + i);
    hn::StoreU(v_best, d, hits.v + i);
    StoreIds(d, id_best, hits.primitive + i);
  }
}

constexpr auto& TraceClosestF32 = TraceClosestLanes<float>;
constexpr auto& TraceClosestF64 = TraceClosestLanes<double>;

}  // namespace sheaf::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sheaf::simd {

HWY_EXPORT(TraceClosestF32);
HWY_EXPORT(TraceClosestF64);

template <typename Real>
void TraceClosest(const GeometryView<Real>& geometry, const RayView<Real>& rays,
                  const RayIntervals<Real>& intervals, std::uint32_t count,
                  const HitOutput<Real>& hits) {
  SHEAF_DISPATCH(Real, TraceClosest)(geometry, rays, intervals, count, hits);
}
template decltype(TraceClosest<float>) TraceClosest<float>;
template decltype(TraceClosest<double>) TraceClosest<double>;

}  // namespace sheaf::simd
#endif  // HWY_ONCE
