// The verdict of `sheaf bench` against an earlier run.
#ifndef SHEAF_APP_BENCH_BASELINE_H_
#define SHEAF_APP_BENCH_BASELINE_H_

#include <cstdint>
#include <string>

#include "sheaf/error.h"
#include "src/app/bench_report.h"
#include "src/app/exit_code.h"
#include "src/lab/judge_times.h"

namespace sheaf {

// What an earlier run wrote with --json.
Result<BenchReport> ReadBaseline(const std::string& path);

// kUsage where the baseline, read from `path`, has another scene, camera, size or samples.
Status CheckSameFrame(const std::string& path, const BenchReport& now, const BenchReport& before);

// kUsage where it traced another number of rays. That shows another viewpoint, or another scene of
// the same name: no target changes the number.
Status CheckSameRays(const std::string& path, std::uint64_t rays, const BenchReport& before);

// kUsage where it comes from another processor or build, or does not say from which.
Status CheckSameMachine(const std::string& path, const Machine& now, const Machine& before);

// Gives every row its verdict. kDifferent where one became slower, else kUndecided where too much
// noise or too few repetitions left one without a finding.
ExitCode JudgeRows(const BenchReport& before, Yardstick yardstick, BenchReport& now);

// A line for each row that makes a bad baseline.
std::vector<std::string> DescribeNoise(const BenchReport& report);

}  // namespace sheaf

#endif  // SHEAF_APP_BENCH_BASELINE_H_
