#include "src/render/bin_hits.h"

#include <algorithm>
#include <numeric>

#include "simd/query.h"

namespace sheaf {
namespace {

std::uint32_t KeyOf(const PrimitiveInfo& info) {
  return 1 + kKindCount * info.material + static_cast<std::uint32_t>(info.kind());
}

}  // namespace

void HitBinner::Bin(const std::uint32_t* hit_primitives, std::uint32_t count,
                    std::span<const PrimitiveInfo> primitives) {
  if (ray_.size() < StreamCapacity(count)) {
    ray_.Allocate(StreamCapacity(count));
    index_.Allocate(StreamCapacity(count));
    primitive_.Allocate(StreamCapacity(count));
  }
  // Neighbouring rays mostly hit the same primitive, so that a run of them costs one look-up.
  runs_.clear();
  keys_.assign(1, 0);
  for (std::uint32_t i = 0; i < count;) {
    const std::uint32_t first = i, primitive = hit_primitives[i];
    while (i < count && hit_primitives[i] == primitive) ++i;
    Run run{first, i - first, primitive, 0, 0};
    if (primitive != kNoPrimitive) {
      const PrimitiveInfo& info = primitives[primitive];
      run.key = KeyOf(info);
      run.index = info.index();
    }
    if (counts_[run.key] == 0 && run.key != 0) keys_.push_back(run.key);
    counts_[run.key] += run.size;
    runs_.push_back(run);
  }

  bins_.clear();
  missed_rays_ = {ray_.data(), counts_[0]};
  std::uint32_t first = 0;
  std::sort(keys_.begin(), keys_.end());
  for (const std::uint32_t key : keys_) {
    const std::uint32_t size = counts_[key];
    if (key > 0) {
      bins_.push_back(
          {(key - 1) / kKindCount,
           static_cast<PrimitiveKind>((key - 1) % kKindCount),
           {ray_.data() + first, index_.data() + first, primitive_.data() + first, size}});
    }
    counts_[key] = first;
    first += size;
  }
  for (const Run& run : runs_) {
    const std::uint32_t at = counts_[run.key];
    counts_[run.key] += run.size;
    std::iota(ray_.data() + at, ray_.data() + at + run.size, run.first);
    std::fill_n(primitive_.data() + at, run.size, run.primitive);
    std::fill_n(index_.data() + at, run.size, run.index);
  }
  // Only what was counted is cleared: most scenes have more materials than a stream meets.
  for (const std::uint32_t key : keys_) counts_[key] = 0;
}

}  // namespace sheaf
