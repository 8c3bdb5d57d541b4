// How long each kernel takes on each target.
#ifndef SHEAF_LAB_MEASURE_KERNELS_H_
#define SHEAF_LAB_MEASURE_KERNELS_H_

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "sheaf/error.h"

namespace sheaf {

// A kernel on one target.
struct KernelTime {
  std::string target;
  int lanes = 1;
  std::vector<double> nanoseconds;  // an element, by repetition
};

struct KernelRow {
  std::string kernel, element;
  double live = 1;                // share of the lanes that work for a result
  std::vector<KernelTime> times;  // by target, as they were given
};

// Times every kernel on every target, "scalar" among them or not. Buffers are warm before a clock
// starts; then every repetition takes each kernel and target once, so that a drift of the clock
// meets all alike. A measurement calls a kernel for a millisecond at least. After each of them
// `step` is called, which may stop the work by an error.
Result<std::vector<KernelRow>> MeasureKernels(const std::vector<std::string>& targets,
                                              int repetitions, const std::function<Status()>& step);

// How many calls of `step` that makes.
std::uint64_t KernelSteps(std::size_t targets, int repetitions);

}  // namespace sheaf

#endif  // SHEAF_LAB_MEASURE_KERNELS_H_
