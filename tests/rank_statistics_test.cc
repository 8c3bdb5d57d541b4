#include "src/lab/rank_statistics.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace sheaf {
namespace {

TEST_CASE("medians") {
  CHECK(Median({3}) == 3);
  CHECK(Median({5, 1, 3}) == 3);
  CHECK(Median({4, 1, 3, 2}) == 2.5);
}

// Ranks of the interval from tables of the sign test: 9 values, second to eighth, 96.1 %.
TEST_CASE("the median's interval leaves out what binomial tails allow") {
  const auto width = [](int n) {
    std::vector<double> values;
    for (int i = 1; i <= n; ++i) values.push_back(i);
    const Interval interval = MedianInterval(values);
    CHECK(interval.low + interval.high == n + 1);
    return interval.low;
  };
  CHECK(width(1) == 1);
  CHECK(width(5) == 1);
  CHECK(width(6) == 1);
  CHECK(width(8) == 1);
  CHECK(width(9) == 2);
  CHECK(width(12) == 3);
  CHECK(width(20) == 6);
  CHECK(width(100) == 40);
}

TEST_CASE("spread is that of the quartiles") {
  CHECK(RelativeSpread({1, 2, 3}) == 0);
  CHECK(RelativeSpread({8, 9, 10, 11, 12}) == doctest::Approx(0.2));
}

// Every order of small samples, counted: the definition.
double CountedP(const std::vector<double>& a, const std::vector<double>& b) {
  const auto u_of = [](const std::vector<double>& x, const std::vector<double>& y) {
    double u = 0;
    for (const double p : x) {
      for (const double q : y) u += p < q;
    }
    return u;
  };
  const int all = static_cast<int>(a.size() + b.size());
  const double pairs = static_cast<double>(a.size() * b.size());
  const double seen = std::min(u_of(a, b), pairs - u_of(a, b));
  double orders = 0, extreme = 0;
  for (std::uint32_t mask = 0; mask < 1u << all; ++mask) {
    std::vector<double> x, y;
    for (int i = 0; i < all; ++i) (mask >> i & 1 ? x : y).push_back(i);
    if (x.size() != a.size()) continue;
    ++orders;
    const double u = u_of(x, y);
    extreme += u <= seen || u >= pairs - seen;
  }
  return extreme / orders;
}

TEST_CASE("Mann and Whitney's test") {
  // Their table: m = n = 4, U = 0: 0.0143 one-sided.
  CHECK(MannWhitneyP({1, 2, 3, 4}, {5, 6, 7, 8}) == doctest::Approx(2.0 / 70));
  CHECK(MannWhitneyP({5, 6, 7, 8}, {1, 2, 3, 4}) == doctest::Approx(2.0 / 70));
  const std::vector<double> a = {1, 4, 6, 9, 12}, b = {2, 3, 5, 7, 8, 10, 11};
  CHECK(MannWhitneyP(a, b) == doctest::Approx(CountedP(a, b)));
  const std::vector<double> c = {1, 2, 4, 5}, d = {3, 6, 7, 8, 9, 10};
  CHECK(MannWhitneyP(c, d) == doctest::Approx(CountedP(c, d)));
  CHECK(MannWhitneyP({1, 1, 1}, {1, 1, 1}) == 1);
  // Large samples go by the normal approximation, which meets the exact count.
  std::vector<double> low, high;
  for (int i = 0; i < 30; ++i) {
    low.push_back(i);
    high.push_back(i + 7.5);
  }
  const double exact = MannWhitneyP(low, high);
  low.push_back(14.25);
  const double approximate = MannWhitneyP(low, high);
  CHECK(approximate == doctest::Approx(exact).epsilon(0.25));
  CHECK(SmallestP(4, 4) == doctest::Approx(2.0 / 70));
  CHECK(SmallestP(1, 1) == 1);
}

// Of two samples of 9 the test rejects a U of 11 or less at 1 %, as its tables say: the interval
// leaves 11 of the 81 ratios out on either side.
TEST_CASE("the interval of a ratio is what Mann and Whitney's test does not reject") {
  std::vector<double> before, after, ratios;
  for (int i = 0; i < 9; ++i) {
    before.push_back(1 + 0.001 * i);
    after.push_back(2 + 0.0037 * i * i);
  }
  for (const double x : before) {
    for (const double y : after) ratios.push_back(y / x);
  }
  std::sort(ratios.begin(), ratios.end());
  const RatioEstimate estimate = EstimateRatio(before, after);
  CHECK(estimate.interval.low == ratios[11]);
  CHECK(estimate.interval.high == ratios[69]);
  CHECK(estimate.median == ratios[40]);
  const RatioEstimate few = EstimateRatio({1, 2}, {3, 5});
  CHECK(few.interval.low == 1.5);
  CHECK(few.interval.high == 5);
}

}  // namespace
}  // namespace sheaf
