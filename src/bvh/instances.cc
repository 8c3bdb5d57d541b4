#include "sheaf/instances.h"

#include <algorithm>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "src/bvh/build_instances.h"
#include "src/bvh/geometry_access.h"
#include "src/bvh/instances_access.h"
#include "src/bvh/tree.h"
#include "src/scene/affine_map.h"

namespace sheaf {
namespace {

AffineMap RowsOf(const Place& place) {
  AffineMap map;
  for (std::size_t k = 0; k < 12; ++k) map.row[k / 4][k % 4] = place.to_world[k];
  return map;
}

Error Fault(std::size_t place, const std::string& what) {
  return {ErrorKind::kUsage, "place " + std::to_string(place) + ": " + what};
}

std::array<float, 3> ArrayOf(const float (&bound)[3]) { return {bound[0], bound[1], bound[2]}; }

}  // namespace

template <typename Real>
InstancesOf<Real>::InstancesOf() = default;
template <typename Real>
InstancesOf<Real>::InstancesOf(InstancesOf&&) noexcept = default;
template <typename Real>
InstancesOf<Real>& InstancesOf<Real>::operator=(InstancesOf&&) noexcept = default;
template <typename Real>
InstancesOf<Real>::~InstancesOf() = default;

template <typename Real>
Result<InstancesOf<Real>> InstancesOf<Real>::Build(Geometries geometries,
                                                   std::span<const Place> places, int threads) {
  if (places.size() > kMaxTreePrimitives) {
    return Error{ErrorKind::kUsage, std::to_string(places.size()) + " places, at most " +
                                        std::to_string(kMaxTreePrimitives) + " are possible"};
  }
  std::vector<TreeView<Real>> trees;
  for (std::size_t i = 0; i < geometries.size(); ++i) {
    if (!geometries[i]) {
      return Error{ErrorKind::kUsage, "geometry " + std::to_string(i) + " is null"};
    }
    trees.push_back(GeometryAccess::TreeOf(*geometries[i]));
  }
  std::vector<PlacedObject> placed;
  placed.reserve(places.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (places[i].geometry >= geometries.size()) {
      return Fault(i, "geometry " + std::to_string(places[i].geometry) + " of " +
                          std::to_string(geometries.size()));
    }
    AffineMap map = RowsOf(places[i]);
    if (const std::string fault = FaultOf(map); !fault.empty()) return Fault(i, fault);
    // Trees are in numbers of their own scale, a power of two.
    const auto scale =
        static_cast<double>(GeometryAccess::ScaleOf(*geometries[places[i].geometry]));
    for (auto& row : map.row) {
      for (int axis = 0; axis < 3; ++axis) row[axis] /= scale;
    }
    placed.push_back({map, places[i].geometry});
  }
  auto data = std::make_unique<Data>();
  data->geometries.assign(geometries.begin(), geometries.end());
  data->forest = BuildInstances<Real>(placed, std::move(trees), threads);
  InstancesOf instances;
  instances.data_ = std::move(data);
  return instances;
}

template <typename Real>
std::array<float, 3> InstancesOf<Real>::lower() const {
  constexpr float kMax = std::numeric_limits<float>::max();
  return data_ ? ArrayOf(data_->forest.all_lower) : std::array<float, 3>{kMax, kMax, kMax};
}
template <typename Real>
std::array<float, 3> InstancesOf<Real>::upper() const {
  constexpr float kMax = std::numeric_limits<float>::max();
  return data_ ? ArrayOf(data_->forest.all_upper) : std::array<float, 3>{-kMax, -kMax, -kMax};
}

template <typename Real>
InstanceStatistics InstancesOf<Real>::statistics() const {
  InstanceStatistics statistics{};
  statistics.bytes = sizeof(*this);
  if (!data_) return statistics;
  const InstanceForest<Real>& forest = data_->forest;
  statistics.instances = static_cast<std::uint32_t>(forest.object.size());
  statistics.geometries = static_cast<std::uint32_t>(data_->geometries.size());
  statistics.nodes = forest.node_count;
  statistics.bytes +=
      sizeof(Data) + forest.bytes() + data_->geometries.capacity() * sizeof(data_->geometries[0]);
  statistics.depth = DepthOf(forest.nodes.data(), forest.node_count);
  return statistics;
}

template class InstancesOf<float>;
template class InstancesOf<double>;

}  // namespace sheaf
