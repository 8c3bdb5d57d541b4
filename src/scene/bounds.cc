#include "src/scene/bounds.h"

#include <glm/common.hpp>

#include "src/scene/placed_groups.h"

namespace sheaf {
namespace {

void Include(const Vec3d& point, std::optional<Bounds>& bounds) {
  if (!bounds) bounds = Bounds{point, point};
  bounds->min = glm::min(bounds->min, point);
  bounds->max = glm::max(bounds->max, point);
}

}  // namespace

std::optional<Bounds> BoundsOf(const Shape& shape) {
  std::optional<Bounds> bounds;
  ForEachExtreme(shape, [&](const Vec3d& point) { Include(point, bounds); });
  return bounds;
}

std::optional<Bounds> BoundsOf(const std::vector<Object>& objects) {
  std::optional<Bounds> bounds;
  for (const Object& object : objects) {
    ForEachExtreme(object.shape, [&](const Vec3d& point) { Include(point, bounds); });
  }
  return bounds;
}

std::optional<Bounds> BoundsOf(const Scene& scene) {
  std::optional<Bounds> bounds = BoundsOf(scene.objects);
  ForEachPlacedBox(scene, [&](const Bounds& box) {
    Include(box.min, bounds);
    Include(box.max, bounds);
  });
  return bounds;
}

}  // namespace sheaf
