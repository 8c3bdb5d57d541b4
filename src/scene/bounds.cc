#include "src/scene/bounds.h"

#include <glm/common.hpp>
#include <variant>

namespace sheaf {
namespace {

class BoundsFinder {
 public:
  void operator()(const Sphere& sphere) {
    Include(sphere.center - sphere.radius);
    Include(sphere.center + sphere.radius);
  }
  void operator()(const Quad& quad) {
    for (const Vec3d& corner : quad.corners) Include(corner);
  }
  void operator()(const Triangle& triangle) {
    for (const Vec3d& vertex : triangle.vertices) Include(vertex);
  }
  void operator()(const Mesh& mesh) {
    for (const glm::vec3& vertex : mesh.positions) Include(Vec3d(vertex));
  }

  std::optional<Bounds> bounds;

 private:
  void Include(const Vec3d& point) {
    if (!bounds) bounds = Bounds{point, point};
    bounds->min = glm::min(bounds->min, point);
    bounds->max = glm::max(bounds->max, point);
  }
};

}  // namespace

std::optional<Bounds> BoundsOf(const Scene& scene) {
  BoundsFinder finder;
  for (const Object& object : scene.objects) std::visit(finder, object.shape);
  return finder.bounds;
}

}  // namespace sheaf
