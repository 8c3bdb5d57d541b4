// A long batch of rays in parts that a kernel takes at once.
#ifndef SHEAF_BVH_RAY_BATCHES_H_
#define SHEAF_BVH_RAY_BATCHES_H_

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "simd/streams.h"

namespace sheaf {

// Rays that a kernel takes at once: a kernel counts in 32 bits, callers may have more.
inline constexpr std::size_t kMaxBatch = std::size_t{1} << 24;
static_assert(kMaxBatch % kMaxLanes == 0);

// Calls f(first, n) for the parts of [0, count) in their order, n in [1, step].
template <typename F>
void ForEachBatch(std::size_t count, std::size_t step, F f) {
  for (std::size_t first = 0; first < count;) {
    const std::size_t n = std::min(step, count - first);
    f(first, static_cast<std::uint32_t>(n));
    first += n;
  }
}

}  // namespace sheaf

#endif  // SHEAF_BVH_RAY_BATCHES_H_
