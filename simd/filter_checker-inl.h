// The mean of a checker over footprints: src/scalar/filter_checker.h.
#if defined(SHEAF_SIMD_FILTER_CHECKER_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SHEAF_SIMD_FILTER_CHECKER_INL_H_
#undef SHEAF_SIMD_FILTER_CHECKER_INL_H_
#else
#define SHEAF_SIMD_FILTER_CHECKER_INL_H_
#endif

#include "simd/checker_terms.h"
#include "simd/math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE {

// x less twice the floor of its half, which is exact.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V WithinTwo(D d, V x) {
  const V half = hn::Floor(hn::Mul(x, hn::Set(d, hn::TFromD<D>(0.5))));
  return hn::Sub(x, hn::Add(half, half));
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE V MeanOfSquareWave(D d, V x, V width) {
  using Real = hn::TFromD<D>;
  const V one = hn::Set(d, Real(1)), half = hn::Set(d, Real(0.5)), many = hn::Set(d, kManyCells);
  const V w = hn::IfThenElse(hn::Lt(width, many), width, many);  // NaN counts as infinite
  const V cell = hn::Floor(x), within = hn::Sub(x, cell);
  const V nearest = hn::IfThenElse(hn::Lt(within, half), within, hn::Sub(one, within));
  const V twice = hn::Add(nearest, nearest);
  const V mean = hn::IfThenElse(hn::Lt(twice, w), hn::Div(twice, w), one);
  const V narrow = hn::IfThenElse(hn::Ne(WithinTwo(d, cell), hn::Zero(d)), hn::Neg(mean), mean);
  const auto is_wide = hn::Gt(w, one);
  if (hn::AllFalse(d, is_wide)) return narrow;
  const auto integral = [&](V at) HWY_ATTR {
    return hn::Sub(one, hn::Abs(hn::Sub(WithinTwo(d, at), one)));
  };
  const V reach = hn::Mul(w, half);
  const V rise = hn::Sub(integral(hn::Add(x, reach)), integral(hn::Sub(x, reach)));
  return hn::IfThenElse(is_wide, hn::Div(rise, w), narrow);
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE V EvenShare(D d, V u, V v, V width_u, V width_v) {
  const V half = hn::Set(d, hn::TFromD<D>(0.5));
  const V mean = hn::Mul(MeanOfSquareWave(d, u, width_u), MeanOfSquareWave(d, v, width_v));
  return hn::Add(half, hn::Mul(half, mean));
}

}  // namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // SHEAF_SIMD_FILTER_CHECKER_INL_H_
