// The angle of a vector from + - * / and square roots alone, so that every target has the same
// bits; libm has not.
#ifndef SHEAF_SCALAR_ATAN_H_
#define SHEAF_SCALAR_ATAN_H_

#include <cmath>
#include <numbers>
#include <utility>

namespace sheaf::scalar {

// The angle from (1, 0) to (x, y), in [-pi, pi] and off by at most 6e-16 of the result
// (tests/atan_test.cc); 0 for (0, 0). Both finite, and neither so large or small that a quotient or
// sum of squares leaves the range of double.
inline double AngleOf(double y, double x) {
  double low = std::abs(y), high = std::abs(x);
  const bool is_steep = low > high;
  if (is_steep) std::swap(low, high);
  if (high == 0) return 0;
  // Halved twice, the angle is at most pi/16, where the series ends soon.
  double t = low / high;
  for (int i = 0; i < 2; ++i) t = t / (1 + std::sqrt(1 + t * t));
  const double t2 = t * t;
  double sum = 0;
  for (int n = 23; n >= 3; n -= 2) sum = (1.0 / n - sum) * t2;
  double angle = 4 * (t - t * sum);
  if (is_steep) angle = std::numbers::pi / 2 - angle;
  if (x < 0) angle = std::numbers::pi - angle;
  return y < 0 ? -angle : angle;
}

}  // namespace sheaf::scalar

#endif  // SHEAF_SCALAR_ATAN_H_
