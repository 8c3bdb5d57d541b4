// Times several contestants in turn, so that a drift of the machine's clock meets all alike.
#ifndef SHEAF_BENCH_INTERLEAVE_H_
#define SHEAF_BENCH_INTERLEAVE_H_

#include <cstddef>
#include <functional>
#include <vector>

#include "src/lab/rank_statistics.h"

namespace sheaf::bench {

struct Contestant {
  std::function<void()> prepare;  // not timed
  std::function<void()> run;      // timed
};

// The wall time of f(), in seconds.
double SecondsOf(const std::function<void()>& f);

// The seconds of every run, [contestant][repetition]. Each repetition begins with another
// contestant.
std::vector<std::vector<double>> Interleave(const std::vector<Contestant>& contestants,
                                            int repetitions);

// The median over repetitions of a[i] / b[i]: what drifts within a run cancels in each quotient.
double MedianRatio(const std::vector<double>& a, const std::vector<double>& b);

}  // namespace sheaf::bench

#endif  // SHEAF_BENCH_INTERLEAVE_H_
