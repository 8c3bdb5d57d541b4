// What `sheaf bench --kernels` measured, as a table and as JSON.
#ifndef SHEAF_APP_KERNELS_REPORT_H_
#define SHEAF_APP_KERNELS_REPORT_H_

#include <string>
#include <vector>

#include "src/app/machine.h"
#include "src/lab/measure_kernels.h"

namespace sheaf {

// A line a kernel and target: nanoseconds an element with their interval, how many times as fast as
// the baseline, the lanes that work for a result.
std::string KernelsText(const std::vector<KernelRow>& rows);

// docs/benchmarking.md describes every field.
std::string KernelsJson(const std::vector<KernelRow>& rows, const Machine& machine);

}  // namespace sheaf

#endif  // SHEAF_APP_KERNELS_REPORT_H_
