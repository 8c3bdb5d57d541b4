// Which target a kernel's code was compiled for.
#ifndef SHEAF_SIMD_REPORT_TARGET_H_
#define SHEAF_SIMD_REPORT_TARGET_H_

#include <cstdint>

namespace sheaf {

struct TargetReport {
  std::int64_t target;  // a bit of simd::CompiledTargets()
  std::uint32_t lanes;  // of Real, a vector
};

// Answers from inside the code of one target, so that a target cannot be another in disguise.
template <typename Real>
using ReportTargetKernel = TargetReport();

}  // namespace sheaf

#endif  // SHEAF_SIMD_REPORT_TARGET_H_
