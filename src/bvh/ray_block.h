// Rays from wherever they lie, as arrays that a kernel takes: gathered by stride, padded and at the
// scale that their geometry is traced at.
#ifndef SHEAF_BVH_RAY_BLOCK_H_
#define SHEAF_BVH_RAY_BLOCK_H_

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include "sheaf/geometry.h"
#include "simd/query.h"
#include "simd/streams.h"

namespace sheaf {

// Bytes from an element to the next; a stride of 0 is that of a plain array.
template <typename T>
constexpr std::size_t StrideOf(std::size_t stride) {
  return stride == 0 ? sizeof(T) : stride;
}

// Copies elements [first, first + count) of `from` to `to`. By bytes, because structures may be
// packed.
template <typename T>
void Gather(const T* from, std::size_t stride, std::size_t first, std::uint32_t count, T* to) {
  const auto* bytes = reinterpret_cast<const std::byte*>(from) + StrideOf<T>(stride) * first;
  for (std::uint32_t i = 0; i < count; ++i, bytes += StrideOf<T>(stride)) {
    std::memcpy(to + i, bytes, sizeof(T));
  }
}

// Copies from[0, count) to elements [first, first + count) of `to`, unless that is null.
template <typename T>
void Scatter(const T* from, std::uint32_t count, T* to, std::size_t stride, std::size_t first) {
  if (!to) return;
  auto* bytes = reinterpret_cast<std::byte*>(to) + StrideOf<T>(stride) * first;
  for (std::uint32_t i = 0; i < count; ++i, bytes += StrideOf<T>(stride)) {
    std::memcpy(bytes, from + i, sizeof(T));
  }
}

// At most kSize rays, a multiple of kMaxLanes.
template <typename Real, std::uint32_t kSize>
class RayBlock {
  static_assert(kSize % kMaxLanes == 0);

 public:
  // Takes rays [first, first + count). Lanes up to PaddedCount(count) have no direction.
  void Take(const RayArraysOf<Real>& rays, const TraceIntervalOf<Real>& interval, std::size_t first,
            std::uint32_t count, Real scale) {
    const Real* const from[] = {rays.origin_x,    rays.origin_y,    rays.origin_z,
                                rays.direction_x, rays.direction_y, rays.direction_z};
    for (std::size_t k = 0; k < 6; ++k) {
      Gather(from[k], rays.stride, first, count, numbers_[k]);
      Pad(numbers_[k], count);
      if (scale == 1) continue;
      for (std::uint32_t i = 0; i < count; ++i) numbers_[k][i] *= scale;
    }
    view_ = {numbers_[0],
             numbers_[1],
             numbers_[2],
             numbers_[3],
             numbers_[4],
             numbers_[5],
             TakeIf(rays.source, rays.stride, first, count, source_)};
    intervals_ = {TakeIf(interval.t_min, interval.stride, first, count, t_min_),
                  TakeIf(interval.t_max, interval.stride, first, count, t_max_), interval.all_t_min,
                  interval.all_t_max};
  }

  const RayView<Real>& view() const { return view_; }
  const RayIntervals<Real>& intervals() const { return intervals_; }

 private:
  template <typename T>
  static void Pad(T* lanes, std::uint32_t count) {
    for (std::uint32_t i = count; i < PaddedCount(count); ++i) lanes[i] = 0;
  }
  // `to`, or null where there is nothing.
  template <typename T>
  static const T* TakeIf(const T* from, std::size_t stride, std::size_t first, std::uint32_t count,
                         T* to) {
    if (!from) return nullptr;
    Gather(from, stride, first, count, to);
    Pad(to, count);
    return to;
  }

  alignas(kAlignment) Real numbers_[6][kSize];
  alignas(kAlignment) Real t_min_[kSize];
  alignas(kAlignment) Real t_max_[kSize];
  alignas(kAlignment) std::uint32_t source_[kSize];
  RayView<Real> view_;
  RayIntervals<Real> intervals_;
};

}  // namespace sheaf

#endif  // SHEAF_BVH_RAY_BLOCK_H_
