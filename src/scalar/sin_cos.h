// Sine and cosine from + - * alone, so that every target has the same bits; libm has not.
#ifndef SHEAF_SCALAR_SIN_COS_H_
#define SHEAF_SCALAR_SIN_COS_H_

#include <bit>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "simd/sin_cos_terms.h"

namespace sheaf::scalar {

template <typename Real>
struct SinCos {
  Real sin, cos;
};

// Horner's rule.
template <typename Real, std::size_t kCount>
Real Evaluate(const Real (&terms)[kCount], Real x) {
  Real sum = terms[0];
  for (std::size_t i = 1; i < kCount; ++i) sum = sum * x + terms[i];
  return sum;
}

// Of an angle in quarter turns, at most 2^20 of them: each is off by at most an ULP of 1 (2^-23 for
// float, 2^-52 for double; tests/sin_cos_test.cc). Whole quarter turns are exact.
template <typename Real>
SinCos<Real> SinCosOf(Real quarter_turns) {
  using Terms = SinCosTerms<Real>;
  const Real shifted = quarter_turns + Terms::kRoundToInteger;
  const Real x = quarter_turns - (shifted - Terms::kRoundToInteger);
  const Real sin = x * Evaluate(Terms::kSin, x * x);
  const Real cos = Evaluate(Terms::kCos, x * x);
  // The whole quarters stand in the low bits: each takes sin to cos and cos to -sin.
  const auto quarters = std::bit_cast<typename Terms::Bits>(shifted);
  SinCos<Real> turned = quarters & 1 ? SinCos<Real>{cos, sin} : SinCos<Real>{sin, cos};
  if (quarters & 2) turned.sin = -turned.sin;
  if ((quarters + 1) & 2) turned.cos = -turned.cos;
  return turned;
}

// The oracle shares no approximation with what it judges.
template <>
inline SinCos<long double> SinCosOf(long double quarter_turns) {
  const long double angle = quarter_turns * (std::numbers::pi_v<long double> / 2);
  return {std::sin(angle), std::cos(angle)};
}

}  // namespace sheaf::scalar

#endif  // SHEAF_SCALAR_SIN_COS_H_
