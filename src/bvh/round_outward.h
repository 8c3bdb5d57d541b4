// Floats below and above a double, and sums that err upward: what boxes are made of.
#ifndef SHEAF_BVH_ROUND_OUTWARD_H_
#define SHEAF_BVH_ROUND_OUTWARD_H_

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace sheaf::bvh {

// Rounds down without a branch: half of all roundings would go the wrong way.
inline float RoundDown(double x) {
  const float f = static_cast<float>(x);
  // As integers that order as floats do; what is above x is no +0, whose neighbour is -0.
  std::int32_t bits = std::bit_cast<std::int32_t>(f);
  bits ^= (bits >> 31) & 0x7fffffff;
  bits -= static_cast<std::int32_t>(static_cast<double>(f) > x);
  bits ^= (bits >> 31) & 0x7fffffff;
  return std::bit_cast<float>(bits);
}
inline float RoundUp(double x) { return -RoundDown(-x); }

// a + b, rounded up to double: the rounding error of a sum is a double (Knuth's TwoSum).
inline double SumUp(double a, double b) {
  const double sum = a + b, part = sum - a;
  const double error = (a - (sum - part)) + (b - part);
  return error > 0 ? std::nextafter(sum, std::numeric_limits<double>::infinity())
                   : sum;  // false for the NaN of an infinite sum
}

}  // namespace sheaf::bvh

#endif  // SHEAF_BVH_ROUND_OUTWARD_H_
