// The median of six numbers, and of rows of them.
#ifndef SHEAF_SCALAR_MEDIAN_OF_SIX_H_
#define SHEAF_SCALAR_MEDIAN_OF_SIX_H_

#include <cstddef>
#include <cstdint>

namespace sheaf::scalar {

template <typename Real>
void Order(Real& low, Real& high) {
  const Real least = low < high ? low : high;
  high = low < high ? high : low;
  low = least;
}

// The mean of the third and the fourth, by a network that leaves the others where they are.
template <typename Real>
Real MedianOfSix(const Real* numbers, std::ptrdiff_t step) {
  Real a = numbers[0], b = numbers[step], c = numbers[2 * step], d = numbers[3 * step],
       e = numbers[4 * step], f = numbers[5 * step];
  Order(a, b);
  Order(c, d);
  Order(e, f);
  // The least becomes a, the largest f.
  Order(a, c);
  Order(a, e);
  Order(d, f);
  Order(b, f);
  // Of b, c, d and e the middle two.
  Order(b, c);
  Order(d, e);
  Order(b, d);
  Order(c, e);
  return (c + d) * Real(0.5);
}

template <typename Real>
void FindMedians(const Real* numbers, std::ptrdiff_t step, std::uint32_t count, Real* medians) {
  for (std::uint32_t i = 0; i < count; ++i) medians[i] = MedianOfSix(numbers + i, step);
}

}  // namespace sheaf::scalar

#endif  // SHEAF_SCALAR_MEDIAN_OF_SIX_H_
