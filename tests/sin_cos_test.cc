// scalar::SinCosOf against sinl and cosl: the bound that src/scalar/sin_cos.h states, and exact
// identities.
#include "src/scalar/sin_cos.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <limits>

#include "random_scene.h"

namespace sheaf {
namespace {

// Judging a double to a fraction of an ULP needs more bits than a double has.
static_assert(LDBL_MANT_DIG >= 64);

TEST_CASE_TEMPLATE("within an ULP of 1", Real, float, double) {
  Random random(20);
  const long double bound = std::numeric_limits<Real>::epsilon();
  long double worst = 0, worst_square = 0;
  const auto judge = [&](Real turns) {
    const auto got = scalar::SinCosOf(turns);
    // Whole turns are taken off before libm can round them.
    const auto exact = scalar::SinCosOf(std::fmod(static_cast<long double>(turns), 4.0L));
    const long double off = std::max(std::abs(got.sin - exact.sin), std::abs(got.cos - exact.cos));
    if (!(off <= bound)) FAIL_CHECK("quarter turns ", turns, " off by ", static_cast<double>(off));
    worst = std::max(worst, off);
    const long double sin = got.sin, cos = got.cos;
    worst_square = std::max(worst_square, std::abs(sin * sin + cos * cos - 1));
  };
  for (int i = -40000; i <= 40000; ++i) judge(static_cast<Real>(i) / 10000);
  for (int i = 0; i < 300000; ++i) {
    judge(static_cast<Real>(Uniform(random, -4, 4)));
    judge(static_cast<Real>(Uniform(random, -1048576, 1048576)));
    judge(static_cast<Real>(std::exp2(Uniform(random, -100, 0))));
  }
  // Where the two polynomials change places.
  for (int quarter = -8; quarter <= 8; ++quarter) {
    Real up = static_cast<Real>(quarter) + Real(0.5), down = up;
    for (int i = 0; i < 100; ++i) {
      judge(up), judge(down);
      up = std::nextafter(up, Real(100)), down = std::nextafter(down, Real(-100));
    }
  }
  MESSAGE("largest error: ", static_cast<double>(worst / bound),
          " ULP of 1; of sin^2 + cos^2: ", static_cast<double>(worst_square / bound));
  CHECK(worst > bound / 4);  // no rounded function does better
}

TEST_CASE_TEMPLATE("whole quarter turns are exact, mirrored angles mirror", Real, float, double) {
  for (int quarter = -4096; quarter <= 4096; ++quarter) {
    const auto got = scalar::SinCosOf(static_cast<Real>(quarter));
    const int k = quarter & 3;
    CHECK(got.sin == Real(k == 1 ? 1 : k == 3 ? -1 : 0));
    CHECK(got.cos == Real(k == 0 ? 1 : k == 2 ? -1 : 0));
  }
  Random random(21);
  for (int i = 0; i < 10000; ++i) {
    const Real turns = static_cast<Real>(Uniform(random, 0, 8));
    const auto right = scalar::SinCosOf(turns), left = scalar::SinCosOf(-turns);
    CHECK(left.sin == -right.sin);
    CHECK(left.cos == right.cos);
  }
}

}  // namespace
}  // namespace sheaf
