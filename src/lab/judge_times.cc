#include "src/lab/judge_times.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "src/lab/rank_statistics.h"

namespace sheaf {
namespace {

constexpr double kSmallestChange = 0.02;  // less is no change, however sure
constexpr double kWidestInterval = 0.08;  // from end to end; wider ones tell nothing
constexpr double kLargestDrift = 0.05;    // of the machine between two runs
constexpr double kLargestSpread = 0.05;   // between the quartiles of a baseline

std::vector<double> InCalibrations(const TimedRun& run) {
  std::vector<double> ratios;
  for (std::size_t i = 0; i < run.seconds.size(); ++i) {
    ratios.push_back(run.seconds[i] / run.calibration[i]);
  }
  return ratios;
}

bool IsCalibrated(const TimedRun& run) { return run.calibration.size() == run.seconds.size(); }

// Whether other processes needed cores that the run was on. Few of many cores do no harm.
bool IsCrowded(const TimedRun& run, int cores) {
  return run.other_cores > 0.1 * cores && run.threads + run.other_cores > 0.75 * cores;
}

double Percent(double ratio) { return 100 * (ratio - 1); }

}  // namespace

Judgement JudgeTimes(const TimedRun& before, const TimedRun& now, int cores, Yardstick yardstick) {
  const int m = static_cast<int>(before.seconds.size()), n = static_cast<int>(now.seconds.size());
  if (SmallestP(m, n) > kRatioSignificance) {
    return {Finding::kTooFew, fmt::format("too few repetitions for a verdict ({} and {})", m, n)};
  }
  const bool is_calibrated =
      yardstick == Yardstick::kCalibrated && IsCalibrated(before) && IsCalibrated(now);
  const RatioEstimate plain = EstimateRatio(before.seconds, now.seconds);
  RatioEstimate shown = plain;
  double drift = 0;
  if (is_calibrated) {
    shown = EstimateRatio(InCalibrations(before), InCalibrations(now));
    drift = std::abs(Median(now.calibration) / Median(before.calibration) - 1);
  }
  const double low = std::min(plain.interval.low, shown.interval.low);
  const double high = std::max(plain.interval.high, shown.interval.high);
  const double floor = 1 + std::max(kSmallestChange, drift);
  const std::string change =
      fmt::format("{:+.1f} % time ({:+.1f} to {:+.1f})", Percent(shown.median),
                  Percent(shown.interval.low), Percent(shown.interval.high));

  const double others = std::max(before.other_cores, now.other_cores);
  const bool is_crowded = IsCrowded(before, cores) || IsCrowded(now, cores);
  const bool differs = low > floor || high * floor < 1;
  // A large change is believed of a wider interval than a small one.
  const double width = shown.interval.high - shown.interval.low;
  const double widest = std::max(kWidestInterval, 0.5 * std::abs(shown.median - 1));
  if (width > widest) {
    return {Finding::kTooNoisy, fmt::format("too noisy for a verdict, {}", change)};
  }
  if (differs && is_crowded) {
    return {
        Finding::kTooNoisy,
        fmt::format("too noisy for a verdict (others kept {:.1f} cores busy), {}", others, change)};
  }
  if (differs) {
    const bool is_slower = low > floor;
    return {is_slower ? Finding::kSlower : Finding::kFaster,
            fmt::format("{}, {}", is_slower ? "slower" : "faster", change)};
  }
  if (drift > kLargestDrift) {
    return {Finding::kTooNoisy,
            fmt::format("too noisy for a verdict (the machine's own speed is {:.0f} % off), {}",
                        100 * drift, change)};
  }
  return {Finding::kNoChange, fmt::format("no change, {}", change)};
}

std::string DescribeNoise(const TimedRun& run, int cores) {
  const double spread = RelativeSpread(IsCalibrated(run) ? InCalibrations(run) : run.seconds);
  if (spread > kLargestSpread) {
    return fmt::format("the quartiles of its times are {:.0f} % apart", 100 * spread);
  }
  if (IsCrowded(run, cores)) {
    return fmt::format("others kept {:.1f} of {} cores busy", run.other_cores, cores);
  }
  return "";
}

}  // namespace sheaf
