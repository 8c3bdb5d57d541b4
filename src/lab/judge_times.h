// Whether one run of a benchmark was slower than another, where both may have been disturbed.
#ifndef SHEAF_LAB_JUDGE_TIMES_H_
#define SHEAF_LAB_JUDGE_TIMES_H_

#include <string>
#include <vector>

namespace sheaf {

// The repetitions of one measurement.
struct TimedRun {
  std::vector<double> seconds;      // not empty
  std::vector<double> calibration;  // CalibrationSeconds beside each; empty where unknown
  int threads = 1;
  double other_cores = 0;  // that other processes kept busy meanwhile
};

enum class Finding { kNoChange, kFaster, kSlower, kTooNoisy, kTooFew };

struct Judgement {
  Finding finding;
  std::string text;  // for a person
};

// What is judged: seconds alone, or those and what they are in times of the calibration.
enum class Yardstick { kCalibrated, kSeconds };

// kSlower and kFaster take an interval of the ratio of the two runs, 99 % sure, that lies beyond a
// floor: 2 %, or as much as the machine itself was slower or faster, if that is more. With
// kCalibrated both the seconds and their ratios to the calibration have to show it. No change is
// found, and none excluded, where the interval is wide or other processes worked on the cores that
// the measurement needed: kTooNoisy. `cores` are those that this process may use.
Judgement JudgeTimes(const TimedRun& before, const TimedRun& now, int cores, Yardstick yardstick);

// What makes a run a bad baseline; empty where nothing does.
std::string DescribeNoise(const TimedRun& run, int cores);

}  // namespace sheaf

#endif  // SHEAF_LAB_JUDGE_TIMES_H_
