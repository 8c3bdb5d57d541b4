// x^p for highlights: src/scalar/pow.h, half a vector at a time in double; fast: e^(p ln x) in
// float.
#if defined(SHEAF_SIMD_POW_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SHEAF_SIMD_POW_INL_H_
#undef SHEAF_SIMD_POW_INL_H_
#else
#define SHEAF_SIMD_POW_INL_H_
#endif

#include "simd/math-inl.h"
#include "simd/pow_terms.h"
#include "simd/streams.h"
#ifdef SHEAF_FAST
#include "hwy/contrib/math/math-inl.h"
#endif

HWY_BEFORE_NAMESPACE();
namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE {

// As in src/scalar/pow.h.
template <std::size_t kPairs, class D, class V = hn::Vec<D>>
HWY_INLINE V EvaluatePairs(D d, const double (&pairs)[kPairs][2], V x) {
  const V x2 = hn::Mul(x, x);
  const auto pair = [&](std::size_t i) SHEAF_LAMBDA {
    return hn::Add(hn::Mul(hn::Set(d, pairs[i][0]), x), hn::Set(d, pairs[i][1]));
  };
  V sum = pair(0);
  for (std::size_t i = 1; i < kPairs; ++i) sum = hn::Add(hn::Mul(sum, x2), pair(i));
  return sum;
}

template <typename Real, class D, class V = hn::Vec<D>>
HWY_INLINE V Log2(D d, V x) {
  const hn::RebindToUnsigned<D> du;
  const auto offset = hn::Set(du, (kExponentBias << 52) - kSqrtHalfBits);
  const auto shifted = hn::Add(hn::BitCast(du, x), offset);
  const V e = hn::Sub(hn::BitCast(d, hn::Or(hn::Set(du, kTwo52Bits), hn::ShiftRight<52>(shifted))),
                      hn::Set(d, kTwo52 + static_cast<double>(kExponentBias)));
  const auto mantissa = hn::And(shifted, hn::Set(du, kMantissaMask));
  const V m = hn::BitCast(d, hn::Add(mantissa, hn::Set(du, kSqrtHalfBits)));
  const V one = hn::Set(d, 1.0);
  const V s = hn::Div(hn::Sub(m, one), hn::Add(m, one));
  return hn::Add(e, hn::Mul(s, EvaluatePairs(d, PowTerms<Real>::kLog, hn::Mul(s, s))));
}

template <typename Real, class D, class V = hn::Vec<D>>
HWY_INLINE V Exp2(D d, V y) {
  const hn::RebindToUnsigned<D> du;
  const V round = hn::Set(d, kRoundToInteger);
  const V shifted = hn::Add(y, round);
  const V f = hn::Sub(y, hn::Sub(shifted, round));
  const V power = EvaluatePairs(d, PowTerms<Real>::kExp, f);
  // The integer part stands in the low bits of `shifted`: it is added to the exponent.
  return hn::BitCast(d,
                     hn::Add(hn::BitCast(du, power), hn::ShiftLeft<52>(hn::BitCast(du, shifted))));
}

// x in [0, 1], p >= 0 for all lanes.
#ifdef SHEAF_FAST
template <class D, class V = hn::Vec<D>>
HWY_INLINE V Pow(D d, V x, float p) {
  const V power = hn::Exp(d, hn::Mul(hn::Set(d, p), hn::Log(d, x)));
  const auto is_normal = hn::Ge(x, hn::Set(d, std::numeric_limits<float>::min()));
  return hn::IfThenElse(is_normal, power, hn::Set(d, p == 0 ? 1.0f : 0.0f));
}
#else
template <class D, class V = hn::Vec<D>, typename Real = hn::TFromD<D>>
HWY_INLINE V Pow(D d, V x, Real p) {
  const WideLanes<Real> dw;
  const NarrowLanes<Real> dn;
  const auto tiny = hn::Set(dw, kPowTiny), lowest = hn::Set(dw, kPowLowest);
  const auto at_zero = hn::Set(dw, p == 0 ? 1.0 : 0.0);
  alignas(kAlignment) Real lanes[kMaxLanes];
  hn::Store(x, d, lanes);
  for (std::uint32_t lane = 0; lane < LaneCount(d); lane += LaneCount(dn)) {
    const auto base = Widen(hn::Load(dn, lanes + lane));
    const auto y = hn::Mul(hn::Set(dw, static_cast<double>(p)), Log2<Real>(dw, base));
    const auto power = Exp2<Real>(dw, hn::IfThenElse(hn::Gt(y, lowest), y, lowest));
    const auto result = hn::IfThenElse(hn::Lt(base, tiny), at_zero, power);
    hn::Store(Narrow<Real>(result), dn, lanes + lane);
  }
  return hn::Load(d, lanes);
}
#endif

}  // namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // SHEAF_SIMD_POW_INL_H_
