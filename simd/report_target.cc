#include "simd/report_target.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simd/report_target.cc"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "hwy/highway.h"
#include "simd/dispatch.h"
#include "simd/math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace sheaf::simd::HWY_NAMESPACE {

template <typename Real>
TargetReport ReportTargetLanes() {
  return {HWY_TARGET, static_cast<std::uint32_t>(hn::Lanes(Lanes<Real>()))};
}
SHEAF_NAME_KERNELS(ReportTarget);

}  // namespace sheaf::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sheaf::simd {
SHEAF_EXPORT(ReportTarget);
}  // namespace sheaf::simd
#endif  // HWY_ONCE
