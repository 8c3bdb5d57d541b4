// x^p for highlights, from + - * / alone, so that every target has the same bits; libm has not.
#ifndef SHEAF_SCALAR_POW_H_
#define SHEAF_SCALAR_POW_H_

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "simd/pow_terms.h"
#include "src/core/vec3.h"

namespace sheaf::scalar {

// The polynomial whose coefficients stand in pairs, as PowTerms has them.
template <std::size_t kPairs>
double EvaluatePairs(const double (&pairs)[kPairs][2], double x) {
  const double x2 = x * x;
  double sum = pairs[0][0] * x + pairs[0][1];
  for (std::size_t i = 1; i < kPairs; ++i) sum = sum * x2 + (pairs[i][0] * x + pairs[i][1]);
  return sum;
}

// log2 x of a normal x in (2^-1000, 1]: x = 2^e m with m in [sqrt(1/2), sqrt(2)), and
// log2 m = 2/ln 2 artanh(s), s = (m - 1) / (m + 1). Near 1, m - 1 is exact and so is the result.
template <typename Real>
double Log2(double x) {
  // Counted from sqrt(1/2), the exponent field is e + kExponentBias and the mantissa field that of
  // m.
  const std::uint64_t shifted =
      std::bit_cast<std::uint64_t>(x) - kSqrtHalfBits + (kExponentBias << 52);
  const double e = std::bit_cast<double>(kTwo52Bits | (shifted >> 52)) -
                   (kTwo52 + static_cast<double>(kExponentBias));
  const double m = std::bit_cast<double>((shifted & kMantissaMask) + kSqrtHalfBits);
  const double s = (m - 1) / (m + 1);
  return e + s * EvaluatePairs(PowTerms<Real>::kLog, s * s);
}

// 2^y for y in [-1000, 0].
template <typename Real>
double Exp2(double y) {
  const double shifted = y + kRoundToInteger;
  const double f = y - (shifted - kRoundToInteger);
  const double power = EvaluatePairs(PowTerms<Real>::kExp, f);
  // The integer part stands in the low bits of `shifted`: it is added to the exponent.
  return std::bit_cast<double>(std::bit_cast<std::uint64_t>(power) +
                               (std::bit_cast<std::uint64_t>(shifted) << 52));
}

// x^p for x in [0, 1] and p >= 0, at most 0.51 ULP of float off (tests/pow_test.cc), with 0^0 = 1.
// Evaluated as 2^(p log2 x) in double and rounded once.
template <typename Real>
Real Pow(Real x, Real p) {
  if (static_cast<double>(x) < kPowTiny) return p == 0 ? Real(1) : Real(0);
  const double y = static_cast<double>(p) * Log2<Real>(static_cast<double>(x));
  return static_cast<Real>(Exp2<Real>(y > kPowLowest ? y : kPowLowest));
}

// The oracle shares no approximation with what it judges.
template <>
inline long double Pow(long double x, long double p) {
  return std::pow(x, p);
}

}  // namespace sheaf::scalar

#endif  // SHEAF_SCALAR_POW_H_
