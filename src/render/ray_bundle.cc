#include "src/render/ray_bundle.h"

#include <algorithm>
#include <type_traits>
#include <vector>

namespace sheaf {

template <typename Real>
void OrderByParent(RayBundle<Real>& bundle, std::uint32_t first, std::uint32_t parent_count) {
  constexpr std::uint32_t kNone = 0xffffffffu;
  const std::uint32_t count = bundle.count - first;
  auto paths = bundle.paths.output(first);
  std::vector<std::uint32_t> ray_of_parent(parent_count, kNone);
  for (std::uint32_t i = 0; i < count; ++i) ray_of_parent[paths.parent[i]] = i;
  std::vector<std::uint32_t> order;
  order.reserve(count);
  for (const std::uint32_t ray : ray_of_parent) {
    if (ray != kNone) order.push_back(ray);
  }

  const auto permute = [&](auto* field) {
    std::vector<std::remove_reference_t<decltype(*field)>> permuted(count);
    for (std::uint32_t i = 0; i < count; ++i) permuted[i] = field[order[i]];
    std::copy(permuted.begin(), permuted.end(), field);
  };
  auto rays = bundle.rays.output(first);
  ForEachField(rays, permute);
  ForEachField(paths, permute);
}

template void OrderByParent(RayBundle<float>&, std::uint32_t, std::uint32_t);
template void OrderByParent(RayBundle<double>&, std::uint32_t, std::uint32_t);

}  // namespace sheaf
