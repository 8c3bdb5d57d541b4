#include "src/render/bin_hits.h"

#include <algorithm>
#include <numeric>

#include "simd/query.h"

namespace sheaf {
namespace {

std::uint32_t KeyOf(const PrimitiveInfo& info) {
  return 1 + kKindCount * info.material + static_cast<std::uint32_t>(info.kind());
}

HitBin BinOf(std::uint32_t key, const HitBatch& batch) {
  return {(key - 1) / kKindCount, static_cast<PrimitiveKind>((key - 1) % kKindCount), batch};
}

// The first position from `i` on of another id than that at `i`; eight at a time, for vectors.
std::uint32_t EndOfRun(const std::uint32_t* ids, std::uint32_t i, std::uint32_t count) {
  constexpr std::uint32_t kStep = 8;
  const std::uint32_t id = ids[i];
  for (; i + kStep <= count; i += kStep) {
    std::uint32_t differs = 0;
    for (std::uint32_t k = 0; k < kStep; ++k) differs |= ids[i + k] ^ id;
    if (differs != 0) break;
  }
  while (i < count && ids[i] == id) ++i;
  return i;
}

}  // namespace

void HitBinner::Bin(const std::uint32_t* hit_primitives, std::uint32_t count,
                    std::span<const PrimitiveInfo> primitives) {
  for (auto* array : {&ray_, &index_, &primitive_}) array->Reserve(StreamCapacity(count));
  // Neighbouring rays mostly hit the same primitive, so that a run of them costs one look-up.
  runs_.clear();
  keys_.assign(1, 0);
  for (std::uint32_t i = 0; i < count;) {
    const std::uint32_t first = i, primitive = hit_primitives[i];
    i = EndOfRun(hit_primitives, i, count);
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
  if (runs_.size() > 0 && counts_[runs_.front().key] == count) {
    return BinAlike(runs_.front().key, hit_primitives, count);
  }
  missed_rays_ = {ray_.data(), counts_[0]};
  std::uint32_t first = 0;
  std::sort(keys_.begin(), keys_.end());
  for (const std::uint32_t key : keys_) {
    const std::uint32_t size = counts_[key];
    if (key > 0) {
      bins_.push_back(BinOf(
          key, {ray_.data() + first, index_.data() + first, primitive_.data() + first, size}));
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

// All rays met what has this key.
void HitBinner::BinAlike(std::uint32_t key, const std::uint32_t* hit_primitives,
                         std::uint32_t count) {
  std::iota(ray_.data(), ray_.data() + count, 0u);
  counts_[key] = 0;
  missed_rays_ = {ray_.data(), key == 0 ? count : 0};
  if (key == 0) return;
  for (const Run& run : runs_) std::fill_n(index_.data() + run.first, run.size, run.index);
  bins_.push_back(BinOf(key, {ray_.data(), index_.data(), hit_primitives, count}));
}

}  // namespace sheaf
