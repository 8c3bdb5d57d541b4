#include "src/scene/transform.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <utility>
#include <variant>

#include "src/core/match.h"
#include "src/core/strict_tan.h"
#include "src/scene/placed_groups.h"
#include "src/scene/projection.h"
#include "src/scene/shapes.h"

namespace sheaf {
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
  for (Object& object : scene->objects) {
    const std::string fault = TransformShape(transform, &object.shape);
    if (!fault.empty()) return fault;
  }
  for (Instance& instance : scene->instances) {
    const Transform moved = transform * TransformOf(instance);
    instance.linear = moved.linear;
    instance.translation = moved.translation;
  }
  for (Light& light : scene->lights) {
    const bool is_round = std::holds_alternative<DiskLight>(light.source) ||
                          std::holds_alternative<SphereLight>(light.source);
    if (is_round && !transform.KeepsSpheres()) {
      return "a round light can be turned, moved and scaled alike along all axes only";
    }
    Match(
        light.source,
        [&](PointLight& point) {
          point.position = transform.Point(point.position);
          if (point.cone) point.cone->direction = transform.Vector(point.cone->direction);
        },
        [&](DirectionalLight& sun) { sun.direction = transform.Vector(sun.direction); },
        [&](RectangleLight& rectangle) {
          rectangle.center = transform.Point(rectangle.center);
          rectangle.u = transform.Vector(rectangle.u);
          rectangle.v = transform.Vector(rectangle.v);
          // Mirrored, it would shine from its other side.
          if (glm::determinant(transform.linear) < 0) std::swap(rectangle.u, rectangle.v);
        },
        [&](DiskLight& disk) {
          disk.center = transform.Point(disk.center);
          disk.radius *= transform.Scale();
          disk.direction = transform.Vector(disk.direction);
        },
        [&](SphereLight& sphere) {
          sphere.center = transform.Point(sphere.center);
          sphere.radius *= transform.Scale();
        });
  }
  for (Camera& camera : scene->cameras) {
    camera.eye = transform.Point(camera.eye);
    camera.look_at = transform.Point(camera.look_at);
    camera.up = transform.Vector(camera.up);
    const bool has_length = KindOf(camera.projection).unit == ProjectionUnit::kLength;
    const double lens = has_length ? transform.Scale() : 1;
    SetParameter(camera.projection, ParameterOf(camera.projection) * lens);
    if (camera.lens) {
      if (!transform.KeepsSpheres()) {
        return "a lens can be turned, moved and scaled alike along all axes only";
      }
      camera.lens->aperture *= transform.Scale();
      if (camera.lens->focus) *camera.lens->focus *= transform.Scale();
    }
    for (CameraKey& key : camera.path) {
      key.eye = transform.Point(key.eye);
      key.look_at = transform.Point(key.look_at);
      key.lens *= lens;
    }
  }
  return "";
}

}  // namespace sheaf
