// Statistics that assume no distribution: medians, their intervals, and a test of two samples.
#ifndef SHEAF_LAB_RANK_STATISTICS_H_
#define SHEAF_LAB_RANK_STATISTICS_H_

#include <cstddef>
#include <vector>

namespace sheaf {

// `values` is not empty; the mean of the middle two where their count is even.
double Median(std::vector<double> values);

struct Interval {
  double low, high;
};

// Fewer values reach no confidence of 95 %.
inline constexpr std::size_t kLeastForInterval = 6;

// Holds the median of the distribution with at least 95 % confidence: between the k-th smallest and
// the k-th largest value, for the largest k whose binomial tails allow it. Of fewer values than
// kLeastForInterval all lie within. Not empty.
Interval MedianInterval(std::vector<double> values);

// The distance of the quartiles over the median; 0 for fewer than 4 values.
double RelativeSpread(std::vector<double> values);

// Two-sided p of the test of Mann and Whitney, "On a Test of Whether one of Two Random Variables is
// Stochastically Larger than the Other" (1947): exact for small samples without ties, else by the
// normal approximation. Neither sample is empty.
double MannWhitneyP(const std::vector<double>& a, const std::vector<double>& b);

// The smallest p that samples of these sizes can reach.
double SmallestP(int a, int b);

}  // namespace sheaf

#endif  // SHEAF_LAB_RANK_STATISTICS_H_
