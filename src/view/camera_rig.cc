#include "src/view/camera_rig.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <variant>

#include "src/scene/projection.h"
#include "src/scene/transform.h"

namespace sheaf {
namespace {

constexpr double kMostElevation = 89;  // degrees from the horizon
// Nearer than this to what it looks at, or farther, a camera is of no use.
constexpr double kLeastDistance = 1e-20, kMostDistance = 1e20;

}  // namespace

Vec3d CameraRig::Ahead() const { return glm::normalize(camera_.look_at - camera_.eye); }

Vec3d CameraRig::Right() const { return glm::normalize(glm::cross(Ahead(), camera_.up)); }

double CameraRig::Raised(const Vec3d& ahead, double degrees) const {
  const double sine = glm::dot(ahead, glm::normalize(camera_.up));
  const double elevation = glm::degrees(std::asin(std::clamp(sine, -1.0, 1.0)));
  // A camera of a file may start beyond the limit: it is not moved further, nor thrown back.
  const double lowest = std::min(-kMostElevation, elevation);
  const double highest = std::max(kMostElevation, elevation);
  return std::clamp(elevation + degrees, lowest, highest) - elevation;
}

void CameraRig::Orbit(double right_degrees, double up_degrees) {
  const Transform turn = RotationAbout(camera_.up, right_degrees);
  // An eye that rises looks down.
  const Transform raise = RotationAbout(Right(), Raised(Ahead(), -up_degrees));
  const Vec3d arm = raise.Vector(camera_.eye - camera_.look_at);
  camera_.eye = camera_.look_at + turn.Vector(arm);
}

void CameraRig::Look(double right_degrees, double up_degrees) {
  const Transform turn = RotationAbout(camera_.up, -right_degrees);
  const Transform raise = RotationAbout(Right(), Raised(Ahead(), up_degrees));
  camera_.look_at = camera_.eye + turn.Vector(raise.Vector(camera_.look_at - camera_.eye));
}

void CameraRig::Fly(double right, double up, double ahead) {
  const Vec3d forward = Ahead(), across = Right();
  const double distance = glm::length(camera_.look_at - camera_.eye);
  const Vec3d above = glm::cross(across, forward);
  const Vec3d shift = (across * right + above * up + forward * ahead) * distance;
  const Vec3d eye = camera_.eye + shift;
  const Vec3d reach = glm::max(glm::abs(eye), glm::abs(camera_.look_at + shift));
  if (!(std::max({reach.x, reach.y, reach.z}) <= kMaxCoordinate)) return;
  camera_.eye = eye;
  camera_.look_at += shift;
}

void CameraRig::Zoom(double factor) {
  if (auto* flat = std::get_if<Orthographic>(&camera_.projection)) {
    flat->height = std::clamp(flat->height * factor, kLeastDistance, kMostDistance);
    return;
  }
  const Vec3d arm = (camera_.eye - camera_.look_at) * factor;
  const double distance = glm::length(arm);
  if (!(distance >= kLeastDistance && distance <= kMostDistance)) return;
  const Vec3d eye = camera_.look_at + arm;
  // Far from the origin a double holds no smaller distance.
  if (glm::length(eye - camera_.look_at) > 0.5 * distance) camera_.eye = eye;
}

void CameraRig::Widen(double factor) {
  const ProjectionKind& kind = KindOf(camera_.projection);
  if (kind.unit != ProjectionUnit::kDegrees) return;
  const double angle = ParameterOf(camera_.projection) * factor;
  SetParameter(camera_.projection, std::clamp(angle, 0.1, std::min(kind.largest, 170.0)));
}

}  // namespace sheaf
