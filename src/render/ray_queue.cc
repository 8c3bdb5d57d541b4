#include "src/render/ray_queue.h"

#include <type_traits>

#include "simd/streams.h"

namespace sheaf {
namespace {

// field[i] becomes field[order[i]].
template <typename T>
void Permute(T* field, const std::vector<std::uint32_t>& order, std::vector<T>& scratch) {
  scratch.assign(field, field + order.size());
  for (std::size_t i = 0; i < order.size(); ++i) field[i] = scratch[order[i]];
}

}  // namespace

template <typename Real>
void ParentOrder<Real>::Apply(RayQueue<Real>& queue, std::uint32_t first,
                              std::uint32_t parent_count) {
  constexpr std::uint32_t kNone = 0xffffffffu;
  auto paths = queue.paths.output(first);
  ray_of_parent_.assign(parent_count, kNone);
  for (std::uint32_t i = 0; i < queue.count - first; ++i) ray_of_parent_[paths.parent[i]] = i;
  order_.clear();
  for (const std::uint32_t ray : ray_of_parent_) {
    if (ray != kNone) order_.push_back(ray);
  }

  const auto permute = [&](auto* field) {
    if constexpr (std::is_same_v<decltype(field), Real*>) {
      Permute(field, order_, numbers_);
    } else {
      Permute(field, order_, ids_);
    }
  };
  auto rays = queue.rays.output(first);
  ForEachField(rays, permute);
  ForEachField(paths, permute);
}

template class ParentOrder<float>;
template class ParentOrder<double>;

}  // namespace sheaf
