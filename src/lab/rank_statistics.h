// Statistics by rank, which assume no distribution: the median, its confidence interval, and a test
// whether two samples differ.
#ifndef SHEAF_LAB_RANK_STATISTICS_H_
#define SHEAF_LAB_RANK_STATISTICS_H_

#include <cstddef>
#include <vector>

namespace sheaf {

// The middle value; the mean of the middle two where their count is even. `values` is not empty.
double Median(std::vector<double> values);

struct Interval {
  double low, high;
};

// With fewer values no interval reaches 95 % confidence.
inline constexpr std::size_t kLeastForInterval = 6;

// A confidence interval of the median, at least 95 %. It runs from the k-th smallest to the k-th
// largest value. k is the largest for which the two binomial tails stay within 5 %. With fewer than
// kLeastForInterval values it runs from the smallest to the largest. `values` is not empty.
Interval MedianInterval(std::vector<double> values);

// The interquartile range over the median. 0 for fewer than 4 values.
double RelativeSpread(std::vector<double> values);

// The two-sided p value of the test of Mann and Whitney, "On a Test of Whether one of Two Random
// Variables is Stochastically Larger than the Other" (1947). Exact for small samples without ties,
// otherwise by the normal approximation. Neither sample is empty.
double MannWhitneyP(const std::vector<double>& a, const std::vector<double>& b);

// How many times as large the values of one sample are as those of another: the median of all
// ratios after/before (Hodges, Lehmann 1963, of ratios in place of differences), and an interval of
// them that holds the true ratio with a probability of at least 1 - kRatioSignificance: the ratios
// that the test of Mann and Whitney does not reject. All values are above 0, neither sample empty;
// where SmallestP is above kRatioSignificance the interval runs from the smallest to the largest.
struct RatioEstimate {
  double median;
  Interval interval;
};
inline constexpr double kRatioSignificance = 0.01;
RatioEstimate EstimateRatio(const std::vector<double>& before, const std::vector<double>& after);

// The smallest p value that samples of `a` and `b` values can reach.
double SmallestP(int a, int b);

}  // namespace sheaf

#endif  // SHEAF_LAB_RANK_STATISTICS_H_
