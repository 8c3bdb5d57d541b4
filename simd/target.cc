#include "simd/target.h"

#include <algorithm>
#include <cctype>

#include "hwy/highway.h"

namespace sheaf::simd {
namespace {

// Highway orders its bits by preference, the best lowest.
std::vector<std::int64_t> BitsOf(std::int64_t mask) {
  std::vector<std::int64_t> bits;
  for (; mask != 0; mask &= mask - 1) bits.push_back(mask & -mask);
  return bits;
}

std::int64_t UsableMask() {
  static const std::int64_t mask = HWY_SUPPORTED_TARGETS & HWY_TARGETS;
  return mask;
}

}  // namespace

std::vector<std::int64_t> CompiledTargets() { return BitsOf(HWY_TARGETS); }

std::vector<std::int64_t> UsableTargets() { return BitsOf(UsableMask()); }

std::string TargetName(std::int64_t target) {
  if (target == HWY_SCALAR) return "hwy_scalar";  // `scalar` is the baseline in src/scalar
  std::string name = hwy::TargetName(target);
  std::transform(name.begin(), name.end(), name.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return name;
}

// A choice of our own: Highway's is one for the whole process.
std::size_t DispatchIndex(std::int64_t target) {
  hwy::ChosenTarget chosen;
  chosen.Update(target == 0 ? UsableMask() : target);
  return chosen.GetIndex();
}

}  // namespace sheaf::simd
