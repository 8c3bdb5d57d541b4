#include "src/scene/srgb.h"

#include <cmath>
#include <limits>

namespace sheaf {
namespace {

// The kDegree-th root, 3 or 5, by Newton's method. frexp and ldexp only move the exponent, so that
// the iteration runs on [2^-kDegree, 1), where the chord of the root is within 20 % of it and six
// steps reach rounding error. The number of steps is fixed: a stopping rule could differ by a bit.
template <int kDegree>
double Root(double value) {
  static_assert(kDegree == 3 || kDegree == 5);
  // False for NaN: zero, infinity and NaN are their own roots.
  if (!(value > 0.0 && value <= std::numeric_limits<double>::max())) return value;

  int exponent = 0;
  double scaled = std::frexp(value, &exponent);  // in [1/2, 1)
  int root_exponent = exponent / kDegree;
  int shift = exponent - root_exponent * kDegree;
  if (shift > 0) {
    shift -= kDegree;
    ++root_exponent;
  }
  scaled = std::ldexp(scaled, shift);

  constexpr double kLow = 1.0 / (1 << kDegree);
  double root = 0.5 + 0.5 * ((scaled - kLow) / (1.0 - kLow));
  for (int step = 0; step < 6; ++step) {
    double power = root * root;  // becomes root^(kDegree - 1)
    if constexpr (kDegree == 5) power = power * power;
    root = ((kDegree - 1) * root + scaled / power) / kDegree;
  }
  return std::ldexp(root, root_exponent);
}

}  // namespace

double SrgbDecode(double encoded) {
  if (encoded <= 0.04045) return encoded / 12.92;
  const double base = (encoded + 0.055) / 1.055;
  const double square = base * base;
  return square * Root<5>(square);  // base^2.4
}

double SrgbEncode(double linear) {
  if (linear <= 0.0031308) return 12.92 * linear;
  const double half = std::sqrt(linear);
  const double power = std::sqrt(half) * Root<3>(half);  // linear^(1/4 + 1/6) = linear^(1/2.4)
  // 1.055 * power - 0.055, written so that 1 gives exactly 1.
  return power + 0.055 * (power - 1.0);
}

}  // namespace sheaf
