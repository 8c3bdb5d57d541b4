// Verdicts on simulated runs: no clock decides here.
#include "src/lab/judge_times.h"

#include <doctest/doctest.h>

#include <random>
#include <string>

namespace sheaf {
namespace {

// A machine on which a run takes place: how fast it is, how much a round varies, and how much it
// slows the measured work more than the calibration.
struct Simulation {
  double speed = 1, noise = 0.005, preemption = 0, bias = 0;
};

TimedRun Run(std::mt19937& random, const Simulation& machine, double work, int rounds = 9) {
  std::normal_distribution<double> normal(0, machine.noise);
  std::uniform_real_distribution<double> share(0, 1);
  TimedRun run;
  for (int i = 0; i < rounds; ++i) {
    // Both may lose a slice of time to another process, each its own.
    const auto lost = [&] { return share(random) < machine.preemption ? share(random) : 0; };
    run.seconds.push_back(work * machine.speed *
                          (1 + machine.bias + std::abs(normal(random)) + lost()));
    run.calibration.push_back(0.01 * machine.speed * (1 + std::abs(normal(random)) + lost()));
  }
  return run;
}

TEST_CASE("a quiet machine: the same work is no change, 5 % more is slower, 5 % less is faster") {
  std::mt19937 random(1);
  for (int i = 0; i < 200; ++i) {
    const TimedRun before = Run(random, {}, 0.1);
    const auto finding = [&](double work) {
      return JudgeTimes(before, Run(random, {}, work), 2, Yardstick::kCalibrated).finding;
    };
    CHECK(finding(0.1) == Finding::kNoChange);
    CHECK(finding(0.105) == Finding::kSlower);
    CHECK(finding(0.095) == Finding::kFaster);
  }
}

TEST_CASE("a busy machine: the same work is never slower") {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> share(0, 1);
  int told = 0;
  for (int i = 0; i < 2000; ++i) {
    const auto busy = [&] {
      // Where others share a core, they slow the work more than the calibration, but both.
      const double extra = share(random);
      return Simulation{1 + extra, 0.05 * share(random), 0.5 * share(random), 0.5 * extra};
    };
    const TimedRun before = Run(random, i % 2 == 0 ? busy() : Simulation(), 0.1);
    const Judgement judgement =
        JudgeTimes(before, Run(random, busy(), 0.1), 2, Yardstick::kCalibrated);
    CHECK_MESSAGE(judgement.finding != Finding::kSlower, judgement.text);
    told += judgement.finding == Finding::kNoChange;
  }
  MESSAGE(told, " of 2000 found no change");
}

TEST_CASE("what others do on the same cores forbids a verdict, elsewhere it does not") {
  std::mt19937 random(3);
  const TimedRun before = Run(random, {}, 0.1);
  TimedRun now = Run(random, {}, 0.2);
  const auto judge = [&](int cores) {
    return JudgeTimes(before, now, cores, Yardstick::kCalibrated);
  };
  CHECK(judge(2).finding == Finding::kSlower);
  now.other_cores = 1;
  CHECK(judge(2).finding == Finding::kTooNoisy);
  CHECK(judge(2).text.find("others kept 1.0 cores busy") != std::string::npos);
  CHECK(judge(16).finding == Finding::kSlower);
  CHECK(!DescribeNoise(now, 2).empty());
  CHECK(DescribeNoise(now, 16).empty());
}

TEST_CASE("a machine that runs at another speed is taken into account") {
  std::mt19937 random(4);
  const TimedRun before = Run(random, {}, 0.1);
  const TimedRun now = Run(random, {.speed = 1.3}, 0.1);
  CHECK(JudgeTimes(before, now, 2, Yardstick::kSeconds).finding == Finding::kSlower);
  CHECK(JudgeTimes(before, now, 2, Yardstick::kCalibrated).finding == Finding::kTooNoisy);
  // Runs without a calibration are judged by their seconds.
  TimedRun old = before;
  old.calibration.clear();
  CHECK(JudgeTimes(old, now, 2, Yardstick::kCalibrated).finding == Finding::kSlower);
}

TEST_CASE("few and noisy repetitions give no verdict") {
  std::mt19937 random(5);
  const TimedRun before = Run(random, {}, 0.1);
  CHECK(JudgeTimes(before, Run(random, {}, 0.2, 2), 2, Yardstick::kCalibrated).finding ==
        Finding::kTooFew);
  const TimedRun noisy = Run(random, {.noise = 0.2}, 0.1);
  CHECK(JudgeTimes(before, noisy, 2, Yardstick::kCalibrated).finding == Finding::kTooNoisy);
  CHECK(DescribeNoise(before, 2).empty());
  CHECK(DescribeNoise(noisy, 2).find("quartiles") != std::string::npos);
}

}  // namespace
}  // namespace sheaf
