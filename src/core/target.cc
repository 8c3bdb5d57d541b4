#include "sheaf/target.h"

#include "simd/kernels.h"
#include "src/core/running_target.h"

namespace sheaf {
namespace {

std::vector<std::string> NamesOf(const std::vector<std::int64_t>& targets) {
  std::vector<std::string> names;
  for (const std::int64_t target : targets) names.push_back(simd::TargetName(target));
  return names;
}

}  // namespace

std::string RunningTarget(Target target) {
  if (target.is_scalar()) return target.name();
  return simd::TargetName(StrictKernels<float>(target.id()).report_target().target);
}

std::optional<Target> Target::Named(std::string_view name) {
  if (name == "auto") return Target();
  if (name == "scalar") return Scalar();
  for (const std::int64_t target : simd::UsableTargets()) {
    if (simd::TargetName(target) == name) return Target(target);
  }
  return std::nullopt;
}

std::string Target::name() const {
  if (is_scalar()) return "scalar";
  return simd::TargetName(id_ == 0 ? simd::UsableTargets().front() : id_);
}

int Target::lanes() const {
  if (is_scalar()) return 1;
  return static_cast<int>(StrictKernels<float>(id_).report_target().lanes);
}

std::vector<std::string> CompiledTargets() { return NamesOf(simd::CompiledTargets()); }

std::vector<std::string> UsableTargets() { return NamesOf(simd::UsableTargets()); }

}  // namespace sheaf
