// scalar::Pow against powl: the ULP bounds that src/scalar/pow.h states, and exact identities.
#include "src/scalar/pow.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <limits>
#include <vector>

#include "random_scene.h"

namespace sheaf {
namespace {

// Judging a double to a fraction of an ULP needs more bits than a double has.
static_assert(LDBL_MANT_DIG >= 64);

// The distance from the exact value in units of Real's last place there.
template <typename Real>
double UlpsOff(Real got, long double exact) {
  int exponent = 0;
  std::frexp(exact, &exponent);
  const int last = std::max(exponent, std::numeric_limits<Real>::min_exponent) -
                   std::numeric_limits<Real>::digits;
  return static_cast<double>(
      std::ldexp(std::abs(static_cast<long double>(got) - exact), exact == 0 ? 0 : -last));
}

float NextUp(float x) { return std::nextafter(x, 2.0f); }
float Below(float x, int ulps) {
  return std::bit_cast<float>(std::bit_cast<std::uint32_t>(x) - ulps);
}

constexpr std::uint32_t kOneBits = 0x3f800000u;

// Any float in [0, 1], all exponents alike: denormals too.
float AnyFloat(Random& random) {
  return std::bit_cast<float>(static_cast<std::uint32_t>(random() % (kOneBits + 1)));
}

// x whose power p lies anywhere in the range of float, denormal results included.
double BaseOfPower(Random& random, double p) { return std::exp2(Uniform(random, -151, 0) / p); }

std::vector<double> Exponents(Random& random, int random_count) {
  std::vector<double> exponents = {0, 0.5, 1, 2, 11.1434, 25, 200, 1e6, 1e9};
  for (int i = 0; i < random_count; ++i) exponents.push_back(std::exp2(Uniform(random, -10, 30)));
  return exponents;
}

TEST_CASE("float: within 0.51 ULP") {
  Random random(10);
  double worst = 0;
  const auto judge = [&](float x, float p) {
    const double off = UlpsOff(scalar::Pow(x, p), std::pow<long double>(x, p));
    if (off > worst) worst = off;
    if (!(off <= 0.51)) FAIL_CHECK("x ", x, " p ", p, " off by ", off);
  };
  for (const double exponent : Exponents(random, 31)) {
    const auto p = static_cast<float>(exponent);
    for (int k = 0; k < 20000; ++k) judge(Below(1.0f, k), p);
    for (int i = 0; i < 20000; ++i) {
      judge(static_cast<float>(Uniform(random, 0, 1)), p);
      judge(AnyFloat(random), p);
      if (p > 0) judge(static_cast<float>(BaseOfPower(random, p)), p);
    }
    for (std::uint32_t bits = 1; bits < 200; ++bits) judge(std::bit_cast<float>(bits), p);
  }
  MESSAGE("largest error: ", worst, " ULP");
  CHECK(worst >= 0.49);  // a correctly rounded function comes as near to a tie as this
}

// log2 is three roundoffs off and its product with p a fourth; 2^y turns four roundoffs of y into
// 4 ln 2 |y| of the result, each at most an ULP, and adds its own.
TEST_CASE("double: within 3 (1 + |p log2 x|) ULP") {
  Random random(11);
  double worst_near_one = 0, worst_per_log = 0;
  const auto judge = [&](double x, double p) {
    const long double log = std::abs(p * std::log2(static_cast<long double>(x)));
    if (!(x >= kPowTiny) || log >= -kPowLowest - 1) return;
    const double off = UlpsOff(scalar::Pow(x, p), std::pow<long double>(x, p));
    if (log < 1) worst_near_one = std::max(worst_near_one, off);
    worst_per_log = std::max(worst_per_log, off / static_cast<double>(1 + log));
    if (!(off <= static_cast<double>(3 * (1 + log))))
      FAIL_CHECK("x ", x, " p ", p, " off by ", off);
  };
  for (const double p : Exponents(random, 31)) {
    for (int i = 0; i < 20000; ++i) {
      judge(1 - i * 0x1p-53, p);
      judge(Uniform(random, 0, 1), p);
      judge(std::exp2(Uniform(random, -999, 0)), p);
      if (p > 0) judge(BaseOfPower(random, p), p);
      if (p > 0) judge(std::exp2(Uniform(random, -998, 0) / p), p);
    }
  }
  MESSAGE("largest error where |p log2 x| < 1: ", worst_near_one, " ULP; in all ", worst_per_log,
          " (1 + |p log2 x|) ULP");
  CHECK(worst_near_one > 0.49);
}

TEST_CASE_TEMPLATE("exact values", Real, float, double) {
  Random random(12);
  CHECK(scalar::Pow(Real(0), Real(0)) == 1);
  for (const double exponent : Exponents(random, 50)) {
    const Real p = static_cast<Real>(exponent);
    CHECK(scalar::Pow(Real(1), p) == 1);
    if (p > 0) CHECK(scalar::Pow(Real(0), p) == 0);
    if (p > 0) CHECK(scalar::Pow(-Real(0), p) == 0);
    // No power is below this, which is 0 as a float.
    if (p > 1) CHECK(scalar::Pow(Real(0x1p-100), 10 * p) == Real(0x1p-1000));
  }
  for (int i = 0; i < 10000; ++i) {
    CHECK(scalar::Pow(static_cast<Real>(AnyFloat(random)), Real(0)) == 1);
  }
  // Powers of two are exact: their logarithms are integers.
  for (int k = 0; k <= 149; ++k) {
    CHECK(scalar::Pow(std::ldexp(Real(1), -k), Real(1)) == std::ldexp(Real(1), -k));
    CHECK(scalar::Pow(Real(0.5), static_cast<Real>(k)) == std::ldexp(Real(1), -k));
  }
}

TEST_CASE("the first power of a float is the float") {
  Random random(13);
  for (int i = 0; i < 200000; ++i) {
    const float x = AnyFloat(random);
    if (scalar::Pow(x, 1.0f) != x) FAIL_CHECK(x);
  }
}

// The two polynomials join at x = sqrt(1/2) 2^k and at p log2 x = k + 1/2: there a seam would show.
TEST_CASE("float: never falls as x grows") {
  Random random(14);
  const auto judge_run = [](float x, float p, int steps) {
    float power = scalar::Pow(x, p);
    for (int i = 0; i < steps && x < 1; ++i) {
      x = NextUp(x);
      const float next = scalar::Pow(x, p);
      if (!(next >= power)) FAIL_CHECK("x ", x, " p ", p, ": ", power, " then ", next);
      power = next;
    }
    CHECK(power >= 0);
    CHECK(power <= 1);
  };
  for (const double exponent : Exponents(random, 40)) {
    const auto p = static_cast<float>(exponent);
    judge_run(Below(1.0f, 20000), p, 30000);
    judge_run(0.0f, p, 1000);
    for (int k = 0; k < 20; ++k) {
      judge_run(Below(static_cast<float>(std::sqrt(0.5) * std::exp2(-k)), 200), p, 400);
      if (p == 0) continue;
      const auto seam = static_cast<float>(std::exp2(-(k + 0.5) / p));
      if (seam > 1e-37f) judge_run(Below(seam, 200), p, 400);
    }
    for (int i = 0; i < 1000; ++i) judge_run(AnyFloat(random), p, 20);
  }
}

}  // namespace
}  // namespace sheaf
