#include "src/render/place_scene.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <optional>

#include "src/render/round_corners.h"
#include "src/scene/bounds.h"
#include "src/scene/direction.h"
#include "src/scene/placed_groups.h"

namespace sheaf {
namespace {

// The eye may be this many times as far from the origin as from what it sees nearest, and a group's
// middle as its objects are from that.
constexpr double kMostDistances = 8;
// The largest coordinate of a scene that is not scaled. Box tests hold to 2^39, and light needs the
// squares of distances.
constexpr double kLeastSize = 0x1p-20, kMostSize = 0x1p36;

// The place that a picture is seen from, and how far from there the nearest thing lies that it may
// show: to its middle, and half its size.
struct Viewpoint {
  Vec3d place{0.0};
  double distance = std::numeric_limits<double>::infinity();
};

// Rays of an orthographic camera have no common eye: it is the point of the line of sight that is
// nearest to the object.
Vec3d PlaceFacing(const Camera& camera, const Vec3d& middle) {
  if (!std::holds_alternative<Orthographic>(camera.projection)) return camera.eye;
  const Vec3d forward = camera.look_at - camera.eye;
  return camera.eye +
         forward * (glm::dot(middle - camera.eye, forward) / glm::dot(forward, forward));
}

void Approach(const Camera& camera, const Bounds& object, Viewpoint& view) {
  const Vec3d middle = object.min + (object.max - object.min) * 0.5;
  const Vec3d place = PlaceFacing(camera, middle);
  const double distance = glm::length(middle - place) + glm::length(object.max - middle);
  if (distance < view.distance) view = {place, distance};
}

// The place rounded to a power of two near the distance, so that short numbers stay short: what
// touches in the user's coordinates still touches.
Vec3d OriginAt(const Viewpoint& view) {
  const double step = std::ldexp(1.0, std::ilogb(view.distance));
  Vec3d origin;
  for (int i = 0; i < 3; ++i) origin[i] = std::nearbyint(view.place[i] / step) * step;
  return origin;
}

// What brings a largest coordinate to a moderate size.
double ScaleFor(double size) {
  if (size >= kLeastSize && size <= kMostSize) return 1;
  return size > 0 && std::isfinite(size) ? std::ldexp(1.0, -std::ilogb(size)) : 1;
}

}  // namespace

ScenePlacement PlaceScene(const Scene& scene, const Camera& camera) {
  ScenePlacement placement;
  Viewpoint view;
  std::optional<Bounds> all;
  const auto include = [&](const Bounds& bounds) {
    Approach(camera, bounds, view);
    if (!all) all = bounds;
    *all = {glm::min(all->min, bounds.min), glm::max(all->max, bounds.max)};
  };
  for (const Object& object : scene.objects) {
    if (const std::optional<Bounds> bounds = BoundsOf(object.shape)) include(*bounds);
  }
  ForEachPlacedBox(scene, include);
  if (!(view.distance > 0) || !std::isfinite(view.distance)) return placement;
  placement.nearest = view.distance;
  if (LargestComponent(view.place) > kMostDistances * view.distance)
    placement.origin = OriginAt(view);
  placement.scale = ScaleFor(std::max({LargestComponent(all->min - placement.origin),
                                       LargestComponent(all->max - placement.origin),
                                       LargestComponent(camera.eye - placement.origin)}));
  FitCorner(scene, placement);
  return placement;
}

ScenePlacement PlaceGroup(const Bounds& bounds) {
  ScenePlacement placement;
  const Vec3d half = (bounds.max - bounds.min) * 0.5, middle = bounds.min + half;
  const double reach = LargestComponent(half);
  if (!(reach > 0) || !std::isfinite(reach)) return placement;
  if (LargestComponent(middle) > kMostDistances * reach) placement.origin = middle;
  placement.scale = ScaleFor(reach);
  return placement;
}

}  // namespace sheaf
