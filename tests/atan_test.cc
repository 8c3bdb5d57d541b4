// AngleOf against libm's long double, over all angles and sizes.
#include "src/scalar/atan.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

namespace sheaf {
namespace {

TEST_CASE("angles are within 6e-16 of themselves") {
  double worst = 0;
  for (int i = -20000; i <= 20000; ++i) {
    const long double angle = static_cast<long double>(i) / 20000 * std::numbers::pi_v<long double>;
    for (const double length : {1.0, 3.7e-30, 5e40}) {
      const auto y = static_cast<double>(std::sin(angle) * length);
      const auto x = static_cast<double>(std::cos(angle) * length);
      const long double want = std::atan2(static_cast<long double>(y), static_cast<long double>(x));
      if (want == 0) continue;
      const long double off = (scalar::AngleOf(y, x) - want) / want;
      worst = std::max(worst, static_cast<double>(std::abs(off)));
    }
  }
  CHECK(worst <= 6e-16);
  CHECK(worst > 0);
}

TEST_CASE("axes and the origin") {
  CHECK(scalar::AngleOf(0, 0) == 0);
  CHECK(scalar::AngleOf(0, 2) == 0);
  CHECK(scalar::AngleOf(2, 0) == std::numbers::pi / 2);
  CHECK(scalar::AngleOf(-2, 0) == -std::numbers::pi / 2);
  CHECK(scalar::AngleOf(0, -2) == std::numbers::pi);
}

}  // namespace
}  // namespace sheaf
