#include "src/render/bin_hits.h"

#include <algorithm>

namespace sheaf {

void HitBinner::Bin(const std::uint32_t* hit_primitives, std::uint32_t count,
                    std::span<const PrimitiveInfo> primitives) {
  if (ray_.size() < StreamCapacity(count)) {
    ray_.Allocate(StreamCapacity(count));
    local_.Allocate(StreamCapacity(count));
    primitive_.Allocate(StreamCapacity(count));
    keys_.resize(count);
  }
  std::fill(counts_.begin(), counts_.end(), 0u);
  for (std::uint32_t i = 0; i < count; ++i) {
    std::uint32_t key = 0;
    if (hit_primitives[i] != kNoPrimitive) {
      const PrimitiveInfo& info = primitives[hit_primitives[i]];
      key = 1 + 2 * info.material + (info.local & kTriangleBit ? 1 : 0);
    }
    keys_[i] = key;
    ++counts_[key];
  }

  bins_.clear();
  missed_rays_ = {ray_.data(), counts_[0]};
  std::uint32_t first = 0;
  for (std::uint32_t key = 0; key < counts_.size(); ++key) {
    const std::uint32_t size = counts_[key];
    if (key > 0 && size > 0) {
      bins_.push_back(
          {(key - 1) / 2,
           static_cast<ShapeKind>((key - 1) % 2),
           {ray_.data() + first, local_.data() + first, primitive_.data() + first, size}});
    }
    counts_[key] = first;
    first += size;
  }
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t at = counts_[keys_[i]]++;
    ray_[at] = i;
    if (keys_[i] == 0) continue;
    primitive_[at] = hit_primitives[i];
    local_[at] = primitives[hit_primitives[i]].local & ~kTriangleBit;
  }
}

}  // namespace sheaf
