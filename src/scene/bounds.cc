#include "src/scene/bounds.h"

#include <glm/common.hpp>

#include "src/scene/shapes.h"

namespace sheaf {

std::optional<Bounds> BoundsOf(const Scene& scene) {
  std::optional<Bounds> bounds;
  for (const Object& object : scene.objects) {
    ForEachExtreme(object.shape, [&](const Vec3d& point) {
      if (!bounds) bounds = Bounds{point, point};
      bounds->min = glm::min(bounds->min, point);
      bounds->max = glm::max(bounds->max, point);
    });
  }
  return bounds;
}

}  // namespace sheaf
