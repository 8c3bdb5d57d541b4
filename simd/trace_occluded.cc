#include "simd/trace_occluded.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simd/trace_occluded.cc"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "hwy/highway.h"
#include "simd/dispatch.h"
#include "simd/hits-inl.h"

HWY_BEFORE_NAMESPACE();
namespace sheaf::simd::HWY_NAMESPACE {

template <typename Real>
void TraceOccludedLanes(const GeometryView<Real>& geometry, const RayView<Real>& rays,
                        const RayIntervals<Real>& intervals, std::uint32_t count,
                        std::uint32_t* occluded) {
  const Lanes<Real> d;
  const IdLanes<Lanes<Real>> di;
  for (std::uint32_t i = 0; i < count; i += LaneCount(d)) {
    auto open = LanesBelow(d, i, count);
    auto blocked = hn::MaskFromVec(hn::Zero(d));
    const auto t_min = LoadTMin(d, intervals, i);
    auto t_max = LoadTMax(d, intervals, i);
    // The first hit closes a lane; which one it is does not matter.
    ForEachHit(d, geometry, rays, i, t_min, t_max, open,
               [&](auto hit, std::uint32_t /*id*/, auto /*t*/, auto /*u*/, auto /*v*/) HWY_ATTR {
                 blocked = hn::Or(blocked, hit);
                 open = hn::AndNot(hit, open);
               });
    const auto one = hn::Set(di, hn::TFromD<decltype(di)>{1});
    StoreIds(d, hn::IfThenElseZero(hn::RebindMask(di, blocked), one), occluded + i);
  }
}
constexpr auto& TraceOccludedF32 = TraceOccludedLanes<float>;
constexpr auto& TraceOccludedF64 = TraceOccludedLanes<double>;

}  // namespace sheaf::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sheaf::simd {

HWY_EXPORT(TraceOccludedF32);
HWY_EXPORT(TraceOccludedF64);

template <typename Real>
void TraceOccluded(const GeometryView<Real>& geometry, const RayView<Real>& rays,
                   const RayIntervals<Real>& intervals, std::uint32_t count,
                   std::uint32_t* occluded) {
  SHEAF_DISPATCH(Real, TraceOccluded)(geometry, rays, intervals, count, occluded);
}
template decltype(TraceOccluded<float>) TraceOccluded<float>;
template decltype(TraceOccluded<double>) TraceOccluded<double>;

}  // namespace sheaf::simd
#endif  // HWY_ONCE
