#include "src/scene/transform.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "src/core/match.h"
#include "src/core/strict_tan.h"

namespace sheaf {
namespace {

class ObjectMover {
 public:
  explicit ObjectMover(const Transform& transform)
      : transform_(transform),
        // Normals go with the cofactors: the inverse transposed, without its scale.
        cofactors_(glm::cross(transform.linear[1], transform.linear[2]),
                   glm::cross(transform.linear[2], transform.linear[0]),
                   glm::cross(transform.linear[0], transform.linear[1])),
        mirrors_(glm::determinant(transform.linear) < 0) {}

  // Returns what is wrong, or nothing.
  std::string Move(Object& object) const {
    return Match(
        object.shape, [&](Sphere& sphere) { return Move(sphere); },
        [&](Quad& quad) { return Move(quad); }, [&](Triangle& triangle) { return Move(triangle); },
        [&](Mesh& mesh) { return Move(mesh); });
  }

 private:
  const char* Move(Sphere& sphere) const {
    if (!transform_.KeepsSpheres()) {
      return "a sphere can be turned, moved and scaled alike along all axes only";
    }
    sphere.center = transform_.Point(sphere.center);
    sphere.radius *= transform_.Scale();
    return "";
  }
  const char* Move(Quad& quad) const {
    for (Vec3d& corner : quad.corners) corner = transform_.Point(corner);
    return "";
  }
  const char* Move(Triangle& triangle) const {
    for (Vec3d& vertex : triangle.vertices) vertex = transform_.Point(vertex);
    return "";
  }
  const char* Move(Mesh& mesh) const {
    for (glm::vec3& p : mesh.positions) p = glm::vec3(transform_.Point(Vec3d(p)));
    for (glm::vec3& n : mesh.normals) {
      const Vec3d normal = cofactors_ * Vec3d(n);
      const double length = glm::length(normal);
      n = length > 0 ? glm::vec3(normal / length) : glm::vec3(0);
    }
    // A mirror turns the order of corners round, and with it the front.
    if (mirrors_) {
      for (auto& corners : mesh.triangles) std::swap(corners[1], corners[2]);
    }
    const bool is_finite =
        std::all_of(mesh.positions.begin(), mesh.positions.end(), [](const glm::vec3& p) {
          return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
        });
    return is_finite ? "" : "a vertex is not finite after the transform";
  }

  const Transform& transform_;
  glm::dmat3 cofactors_;
  bool mirrors_;
};

}  // namespace

bool Transform::KeepsSpheres() const {
  const double size = Scale();
  for (int i = 0; i < 3; ++i) {
    if (!(std::abs(glm::length(linear[i]) - size) <= 1e-6 * size)) return false;
    if (!(std::abs(glm::dot(linear[i], linear[(i + 1) % 3])) <= 1e-6 * size * size)) return false;
  }
  return true;
}

double Transform::Scale() const { return glm::length(linear[0]); }

Transform operator*(const Transform& a, const Transform& b) {
  return {a.linear * b.linear, a.linear * b.translation + a.translation};
}

Transform RotationAbout(const Vec3d& axis, double degrees) {
  const Vec3d a = axis / glm::length(axis);
  // Exact for the quarter turns that people write, and the same with every C library.
  double turn = degrees - 360 * std::floor(degrees / 360);
  double sin_sign = 1;
  if (turn > 180) turn = 360 - turn, sin_sign = -1;
  const double cos = turn <= 90 ? StrictCosDegrees(turn) : -StrictCosDegrees(180 - turn);
  const double sin =
      sin_sign * (turn <= 90 ? StrictCosDegrees(90 - turn) : StrictCosDegrees(turn - 90));
  const double rest = 1 - cos;
  // Rodrigues' formula, by columns.
  Transform rotation;
  rotation.linear = glm::dmat3(
      a.x * a.x * rest + cos, a.x * a.y * rest + a.z * sin, a.x * a.z * rest - a.y * sin,
      a.x * a.y * rest - a.z * sin, a.y * a.y * rest + cos, a.y * a.z * rest + a.x * sin,
      a.x * a.z * rest + a.y * sin, a.y * a.z * rest - a.x * sin, a.z * a.z * rest + cos);
  return rotation;
}

std::string TransformScene(const Transform& transform, Scene* scene) {
  const ObjectMover mover(transform);
  for (Object& object : scene->objects) {
    const std::string fault = mover.Move(object);
    if (!fault.empty()) return fault;
  }
  for (Light& light : scene->lights) {
    Match(
        light.source,
        [&](PointLight& point) {
          point.position = transform.Point(point.position);
          if (point.cone) point.cone->direction = transform.Vector(point.cone->direction);
        },
        [&](DirectionalLight& sun) { sun.direction = transform.Vector(sun.direction); });
  }
  for (Camera& camera : scene->cameras) {
    camera.eye = transform.Point(camera.eye);
    camera.look_at = transform.Point(camera.look_at);
    camera.up = transform.Vector(camera.up);
    Match(
        camera.projection, [](Perspective&) {},
        [&](Orthographic& lens) { lens.height *= transform.Scale(); });
  }
  return "";
}

}  // namespace sheaf
