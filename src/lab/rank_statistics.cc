#include "src/lab/rank_statistics.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace sheaf {
namespace {

// Above this many pairs the normal approximation is as good as the exact count.
constexpr std::size_t kExactPairs = 900;

struct Ranks {
  double u = 0;     // number of pairs (a, b) with a < b; a tie counts half
  double ties = 0;  // sum of t^3 - t over groups of t equal values
};

Ranks RankPairs(const std::vector<double>& a, const std::vector<double>& b) {
  Ranks ranks;
  for (const double x : a) {
    for (const double y : b) ranks.u += x < y ? 1 : x == y ? 0.5 : 0;
  }
  std::vector<double> all = a;
  all.insert(all.end(), b.begin(), b.end());
  std::sort(all.begin(), all.end());
  for (std::size_t i = 0; i < all.size();) {
    std::size_t j = i;
    while (j < all.size() && all[j] == all[i]) ++j;
    const double t = static_cast<double>(j - i);
    ranks.ties += t * t * t - t;
    i = j;
  }
  return ranks;
}

// The probability that U is at most `u`, where m and n values without ties are ordered by chance.
// Computed by a recurrence: the largest value is one of the m or one of the n.
double ExactTail(std::size_t m, std::size_t n, double u) {
  const std::size_t most = m * n;
  // share[i][k] is the probability that U = k for i and j values. The outer loop raises j.
  std::vector<std::vector<double>> share(m + 1, std::vector<double>(most + 1, 0.0));
  for (std::size_t i = 0; i <= m; ++i) share[i][0] = 1;
  for (std::size_t j = 1; j <= n; ++j) {
    for (std::size_t i = 1; i <= m; ++i) {
      const double total = static_cast<double>(i + j);
      const double largest_is_m = static_cast<double>(i) / total;
      std::vector<double> next(most + 1, 0.0);
      for (std::size_t k = 0; k <= i * j; ++k) {
        next[k] = (1 - largest_is_m) * share[i][k];
        if (k >= j) next[k] += largest_is_m * share[i - 1][k - j];
      }
      share[i] = next;
    }
  }
  double sum = 0;
  for (std::size_t k = 0; k <= most && static_cast<double>(k) <= u; ++k) sum += share[m][k];
  return sum;
}

// The same probability by the normal approximation, corrected for continuity and ties.
double ApproximateTail(std::size_t m, std::size_t n, double u, double ties) {
  const double pairs = static_cast<double>(m * n), all = static_cast<double>(m + n);
  const double variance = pairs / 12 * (all + 1 - ties / (all * (all - 1)));
  if (!(variance > 0)) return 1;
  const double z = (u + 0.5 - pairs / 2) / std::sqrt(variance);
  return 0.5 * std::erfc(-z / std::sqrt(2.0));
}

}  // namespace

double Median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return (values[(n - 1) / 2] + values[n / 2]) / 2;
}

Interval MedianInterval(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  // At most k of n values lie below the median with probability `tail`. Both tails together must
  // stay within 5 %.
  double term = std::pow(0.5, static_cast<double>(n)), tail = term;
  std::size_t k = 0;  // values left out on either side
  while (k + 1 < (n + 1) / 2) {
    term *= static_cast<double>(n - k) / static_cast<double>(k + 1);
    if (2 * (tail + term) > 0.05) break;
    tail += term;
    ++k;
  }
  return {values[k], values[n - 1 - k]};
}

double RelativeSpread(std::vector<double> values) {
  if (values.size() < 4) return 0;
  std::sort(values.begin(), values.end());
  const std::size_t quarter = values.size() / 4;
  return (values[values.size() - 1 - quarter] - values[quarter]) / Median(values);
}

double MannWhitneyP(const std::vector<double>& a, const std::vector<double>& b) {
  const Ranks ranks = RankPairs(a, b);
  const std::size_t m = a.size(), n = b.size();
  const double u = std::min(ranks.u, static_cast<double>(m * n) - ranks.u);
  const bool exact = ranks.ties == 0 && m * n <= kExactPairs;
  const double tail = exact ? ExactTail(m, n, u) : ApproximateTail(m, n, u, ranks.ties);
  return std::min(1.0, 2 * tail);
}

RatioEstimate EstimateRatio(const std::vector<double>& before, const std::vector<double>& after) {
  std::vector<double> ratios;
  for (const double x : before) {
    for (const double y : after) ratios.push_back(y / x);
  }
  std::sort(ratios.begin(), ratios.end());
  const std::size_t m = before.size(), n = after.size();
  const auto tail = [&](double u) {
    return m * n <= kExactPairs ? ExactTail(m, n, u) : ApproximateTail(m, n, u, 0);
  };
  // The tail grows with u: the last one that is small enough, by bisection.
  std::size_t low = 0, high = m * n / 2;  // ratios left out on either side
  while (low < high) {
    const std::size_t middle = (low + high + 1) / 2;
    if (2 * tail(static_cast<double>(middle - 1)) <= kRatioSignificance) {
      low = middle;
    } else {
      high = middle - 1;
    }
  }
  const std::size_t left_out = low > 0 ? low - 1 : 0;
  return {Median(ratios), {ratios[left_out], ratios[ratios.size() - 1 - left_out]}};
}

double SmallestP(int a, int b) {
  double orders = 1;
  for (int i = 1; i <= a; ++i) orders *= static_cast<double>(b + i) / i;
  return std::min(1.0, 2 / orders);
}

}  // namespace sheaf
