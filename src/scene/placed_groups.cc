#include "src/scene/placed_groups.h"

#include <algorithm>
#include <glm/common.hpp>
#include <string>
#include <utility>

#include "src/scene/shapes.h"

namespace sheaf {
namespace {

void Place(const Scene& scene, const std::vector<Instance>& instances, const Transform& outer,
           std::vector<PlacedGroup>& placed) {
  for (const Instance& instance : instances) {
    const Transform to_world = outer * TransformOf(instance);
    const Group& group = scene.groups[instance.group];
    if (!group.objects.empty()) placed.push_back({instance.group, to_world});
    Place(scene, group.instances, to_world, placed);
  }
}

}  // namespace

std::uint64_t CountPlacedGroups(const Scene& scene) {
  constexpr std::uint64_t kTooMany = kMaxInstances + std::uint64_t{1};
  std::vector<std::uint64_t> places;  // that one instance of each group makes
  const auto count = [&](const std::vector<Instance>& instances) {
    std::uint64_t sum = 0;
    for (const Instance& instance : instances) {
      sum = std::min(kTooMany, sum + places[instance.group]);
    }
    return sum;
  };
  for (const Group& group : scene.groups) {
    places.push_back((group.objects.empty() ? 0 : 1) + count(group.instances));
  }
  return count(scene.instances);
}

std::vector<PlacedGroup> PlaceGroups(const Scene& scene) {
  std::vector<PlacedGroup> placed;
  placed.reserve(CountPlacedGroups(scene));
  Place(scene, scene.instances, Transform(), placed);
  return placed;
}

Result<Scene> Flattened(const Scene& scene) {
  Scene flat = scene;
  flat.groups.clear();
  flat.instances.clear();
  for (const PlacedGroup& placed : PlaceGroups(scene)) {
    for (Object object : scene.groups[placed.group].objects) {
      const std::string fault = TransformShape(placed.to_world, &object.shape);
      if (!fault.empty()) return Error{ErrorKind::kScene, "an instance: " + fault};
      flat.objects.push_back(std::move(object));
    }
  }
  return flat;
}

Bounds Mapped(const Transform& transform, const Bounds& bounds) {
  Bounds mapped{transform.translation, transform.translation};
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3d a = transform.linear[axis] * bounds.min[axis];
    const Vec3d b = transform.linear[axis] * bounds.max[axis];
    mapped.min += glm::min(a, b);
    mapped.max += glm::max(a, b);
  }
  return mapped;
}

}  // namespace sheaf
