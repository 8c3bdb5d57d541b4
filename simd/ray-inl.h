// Loading a packet's rays, and which of its lanes can hit anything.
#if defined(SHEAF_SIMD_RAY_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SHEAF_SIMD_RAY_INL_H_
#undef SHEAF_SIMD_RAY_INL_H_
#else
#define SHEAF_SIMD_RAY_INL_H_
#endif

#include "simd/math-inl.h"
#include "simd/query.h"
#include "simd/streams.h"

HWY_BEFORE_NAMESPACE();
namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE {

// MakeFinite of src/scalar/ray.h: an infinite interval admits every finite t. Stays NaN for NaN.
template <class D, typename Real = hn::TFromD<D>>
HWY_INLINE hn::Vec<D> LoadTMin(D d, const RayIntervals<Real>& intervals, std::uint32_t i) {
  const auto lowest = hn::Set(d, -kDefaultTMax<Real>);
  const auto t_min =
      intervals.t_min ? hn::LoadU(d, intervals.t_min + i) : hn::Set(d, intervals.all_t_min);
  return hn::IfThenElse(hn::Lt(t_min, lowest), lowest, t_min);
}

template <class D, typename Real = hn::TFromD<D>>
HWY_INLINE hn::Vec<D> LoadTMax(D d, const RayIntervals<Real>& intervals, std::uint32_t i) {
  const auto largest = hn::Set(d, kDefaultTMax<Real>);
  const auto t_max =
      intervals.t_max ? hn::LoadU(d, intervals.t_max + i) : hn::Set(d, intervals.all_t_max);
  return hn::IfThenElse(hn::Gt(t_max, largest), largest, t_max);
}

template <class D, typename Real = hn::TFromD<D>>
HWY_INLINE hn::Vec<IdLanes<D>> LoadSources(D d, const RayView<Real>& rays, std::uint32_t i) {
  return rays.source ? LoadIds(d, rays.source + i)
                     : hn::Set(IdLanes<D>(), hn::TFromD<IdLanes<D>>{kNoPrimitive});
}

// src/scalar/ray.h: a component that is not finite, no direction or an empty interval misses
// everything.
template <class D, class V = hn::Vec<D>>
HWY_INLINE hn::Mask<D> IsTraceable(D d, V ox, V oy, V oz, V dx, V dy, V dz, V t_min, V t_max) {
  const V zero = hn::Zero(d);
  // x - x is 0 for finite x and NaN otherwise, so that a sum of such terms is 0 or NaN.
  const V o = hn::Add(hn::Add(hn::Sub(ox, ox), hn::Sub(oy, oy)), hn::Sub(oz, oz));
  const V v = hn::Add(hn::Add(hn::Sub(dx, dx), hn::Sub(dy, dy)), hn::Sub(dz, dz));
  const auto finite = hn::Eq(hn::Add(o, v), zero);
  // As integers, because the union of three numbers' bits may be a NaN, which Highway's Ne for
  // floats takes for different from 0 on some targets only.
  const IdLanes<D> di;
  const auto size = hn::BitCast(di, hn::Or(hn::Or(hn::Abs(dx), hn::Abs(dy)), hn::Abs(dz)));
  const auto has_direction = hn::RebindMask(d, hn::Ne(size, hn::Zero(di)));
  // t_min <= t_max is false for NaN.
  return hn::And(hn::And(finite, has_direction), hn::Le(t_min, t_max));
}

}  // namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // SHEAF_SIMD_RAY_INL_H_
