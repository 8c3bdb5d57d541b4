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

// The exponents of a vector: one for all lanes, or one each.
template <typename Real>
struct OfAllLanes {
  Real p;

  template <class D>
  HWY_INLINE hn::Vec<D> Load(D d, std::uint32_t /*lane*/) const {
    return hn::Set(d, p);
  }
};
template <typename Real>
struct OfLanes {
  const Real* p;  // not aligned

  template <class D>
  HWY_INLINE hn::Vec<D> Load(D d, std::uint32_t lane) const {
    return hn::LoadU(d, p + lane);
  }
};

// x in [0, 1], exponents >= 0.
#ifdef SHEAF_FAST
template <class D, class V = hn::Vec<D>, class Exponents>
HWY_INLINE V Pow(D d, V x, Exponents exponents) {
  const V p = exponents.Load(d, 0);
  const V power = hn::Exp(d, hn::Mul(p, hn::Log(d, x)));
  const auto is_normal = hn::Ge(x, hn::Set(d, std::numeric_limits<float>::min()));
  const V at_zero = hn::IfThenElseZero(hn::Eq(p, hn::Zero(d)), hn::Set(d, 1.0f));
  return hn::IfThenElse(is_normal, power, at_zero);
}
#else
template <class D, class V = hn::Vec<D>, class Exponents, typename Real = hn::TFromD<D>>
HWY_INLINE V Pow(D d, V x, Exponents exponents) {
  const WideLanes<Real> dw;
  const NarrowLanes<Real> dn;
  const auto tiny = hn::Set(dw, kPowTiny), lowest = hn::Set(dw, kPowLowest);
  alignas(kAlignment) Real lanes[kMaxLanes];
  hn::Store(x, d, lanes);
  for (std::uint32_t lane = 0; lane < LaneCount(d); lane += LaneCount(dn)) {
    const auto base = Widen(hn::Load(dn, lanes + lane));
    const auto p = Widen(exponents.Load(dn, lane));
    const auto at_zero = hn::IfThenElseZero(hn::Eq(p, hn::Zero(dw)), hn::Set(dw, 1.0));
    const auto y = hn::Mul(p, Log2<Real>(dw, base));
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
