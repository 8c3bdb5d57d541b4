#include "simd/target.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simd/target.cc"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "hwy/highway.h"
#include "simd/math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace sheaf::simd::HWY_NAMESPACE {

// Answers from inside the code of one target, so that a forced target cannot be another in
// disguise.
std::int64_t ReportTarget() { return HWY_TARGET; }
std::size_t ReportLanes() { return hn::Lanes(Lanes<float>()); }

}  // namespace sheaf::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <algorithm>
#include <cctype>

namespace sheaf::simd {

HWY_EXPORT(ReportTarget);
HWY_EXPORT(ReportLanes);

namespace {

struct Target {
  std::string name;
  std::int64_t bit;
};

std::string NameOf(std::int64_t bit) {
  if (bit == HWY_SCALAR) return "hwy_scalar";  // `scalar` is the baseline in src/scalar
  std::string name = hwy::TargetName(bit);
  std::transform(name.begin(), name.end(), name.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return name;
}

// Highway orders its bits by preference, the best lowest.
std::vector<Target> TargetsIn(std::int64_t mask) {
  std::vector<Target> targets;
  for (; mask != 0; mask &= mask - 1) {
    const std::int64_t bit = mask & -mask;
    targets.push_back({NameOf(bit), bit});
  }
  return targets;
}

// What the processor runs, whatever was forced before.
std::int64_t UsableMask() {
  static const std::int64_t mask = [] {
    hwy::SetSupportedTargetsForTest(0);
    return hwy::SupportedTargets() & HWY_TARGETS;
  }();
  return mask;
}

std::vector<std::string> NamesOf(const std::vector<Target>& targets) {
  std::vector<std::string> names;
  for (const Target& target : targets) names.push_back(target.name);
  return names;
}

}  // namespace

std::vector<std::string> CompiledTargets() { return NamesOf(TargetsIn(HWY_TARGETS)); }

std::vector<std::string> UsableTargets() { return NamesOf(TargetsIn(UsableMask())); }

bool ForceTarget(std::string_view name) {
  std::int64_t mask = 0;
  if (name == "auto") {
    mask = UsableMask();
  } else {
    for (const Target& target : TargetsIn(UsableMask())) {
      if (target.name == name) mask = target.bit;
    }
  }
  if (mask == 0) return false;
  // Forcing also resets the cached choice; Update makes the new one at once, so that kernels that
  // start on several threads do not race to.
  hwy::SetSupportedTargetsForTest(name == "auto" ? 0 : mask);
  hwy::GetChosenTarget().Update(mask);
  return true;
}

std::string RunningTarget() { return NameOf(HWY_DYNAMIC_DISPATCH(ReportTarget)()); }

std::size_t RunningLanes() { return HWY_DYNAMIC_DISPATCH(ReportLanes)(); }

}  // namespace sheaf::simd
#endif  // HWY_ONCE
