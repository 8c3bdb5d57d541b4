#include "src/scene/direction.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace sheaf {

double LargestComponent(const Vec3d& v) {
  return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

bool GivesDirection(const Vec3d& vector) { return LargestComponent(vector) >= 1e-30; }

Vec3d Normalized(const Vec3d& vector) {
  const Vec3d v = vector / LargestComponent(vector);  // so that no square over- or underflows
  return v / std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
}

bool SpansPlane(const Vec3d& u, const Vec3d& v) {
  if (!GivesDirection(u) || !GivesDirection(v)) return false;
  return glm::length(glm::cross(Normalized(u), Normalized(v))) >= 1e-6;
}

ViewFault FindViewFault(const Camera& camera) {
  const Vec3d view = camera.look_at - camera.eye;
  if (!GivesDirection(view)) return ViewFault::kNoDirection;
  return SpansPlane(view, camera.up) ? ViewFault::kNone : ViewFault::kParallelToUp;
}

const char* TextOf(ViewFault fault) {
  switch (fault) {
    case ViewFault::kNoDirection:
      return "the camera looks at its own eye";
    case ViewFault::kParallelToUp:
      return "the view direction is parallel to up";
    case ViewFault::kNone:
      break;
  }
  return "";
}

bool HasTerm(const Falloff& falloff, double least) {
  return std::max({falloff.constant, falloff.linear, falloff.quadratic}) >= least;
}

}  // namespace sheaf
