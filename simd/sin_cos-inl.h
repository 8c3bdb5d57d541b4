// Sine and cosine: src/scalar/sin_cos.h on vectors.
#if defined(SHEAF_SIMD_SIN_COS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SHEAF_SIMD_SIN_COS_INL_H_
#undef SHEAF_SIMD_SIN_COS_INL_H_
#else
#define SHEAF_SIMD_SIN_COS_INL_H_
#endif

#include <cstddef>

#include "simd/math-inl.h"
#include "simd/sin_cos_terms.h"

HWY_BEFORE_NAMESPACE();
namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE {

template <class D, std::size_t kCount, class V = hn::Vec<D>>
HWY_INLINE V Evaluate(D d, const hn::TFromD<D> (&terms)[kCount], V x) {
  V sum = hn::Set(d, terms[0]);
  for (std::size_t i = 1; i < kCount; ++i) sum = hn::Add(hn::Mul(sum, x), hn::Set(d, terms[i]));
  return sum;
}

// As in src/scalar/sin_cos.h.
template <class D, class V = hn::Vec<D>>
HWY_INLINE void SinCos(D d, V quarter_turns, V& sine, V& cosine) {
  using Terms = SinCosTerms<hn::TFromD<D>>;
  const hn::RebindToUnsigned<D> du;
  const V round = hn::Set(d, Terms::kRoundToInteger);
  const V shifted = hn::Add(quarter_turns, round);
  const V x = hn::Sub(quarter_turns, hn::Sub(shifted, round));
  const V x2 = hn::Mul(x, x);
  const V sin = hn::Mul(x, Evaluate(d, Terms::kSin, x2));
  const V cos = Evaluate(d, Terms::kCos, x2);

  const auto quarters = hn::BitCast(du, shifted);
  const auto one = hn::Set(du, typename Terms::Bits{1});
  const auto swaps = hn::RebindMask(d, hn::Eq(hn::And(quarters, one), one));
  // Bit 1 of the quarters, moved to the sign.
  constexpr int kToSign = 8 * static_cast<int>(sizeof(typename Terms::Bits)) - 2;
  const V minus_zero = hn::SignBit(d);
  const auto sign_of = [&](auto bits) SHEAF_LAMBDA {
    return hn::And(hn::BitCast(d, hn::ShiftLeft<kToSign>(bits)), minus_zero);
  };
  sine = hn::Xor(hn::IfThenElse(swaps, cos, sin), sign_of(quarters));
  cosine = hn::Xor(hn::IfThenElse(swaps, sin, cos), sign_of(hn::Add(quarters, one)));
}

}  // namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // SHEAF_SIMD_SIN_COS_INL_H_
