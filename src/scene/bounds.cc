#include "src/scene/bounds.h"

#include <glm/common.hpp>

#include "src/core/match.h"

namespace sheaf {
namespace {

void Include(const Vec3d& point, std::optional<Bounds>& bounds) {
  if (!bounds) bounds = Bounds{point, point};
  bounds->min = glm::min(bounds->min, point);
  bounds->max = glm::max(bounds->max, point);
}

}  // namespace

std::optional<Bounds> BoundsOf(const Scene& scene) {
  std::optional<Bounds> bounds;
  for (const Object& object : scene.objects) {
    Match(
        object.shape,
        [&](const Sphere& sphere) {
          Include(sphere.center - sphere.radius, bounds);
          Include(sphere.center + sphere.radius, bounds);
        },
        [&](const Quad& quad) {
          for (const Vec3d& corner : quad.corners) Include(corner, bounds);
        },
        [&](const Triangle& triangle) {
          for (const Vec3d& vertex : triangle.vertices) Include(vertex, bounds);
        },
        [&](const Mesh& mesh) {
          for (const glm::vec3& vertex : mesh.positions) Include(Vec3d(vertex), bounds);
        });
  }
  return bounds;
}

}  // namespace sheaf
