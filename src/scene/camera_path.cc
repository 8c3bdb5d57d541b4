#include <algorithm>
#include <cstddef>

#include "sheaf/scene.h"
#include "src/scene/projection.h"

namespace sheaf {
namespace {

// How fast a point moves at key `i`, a frame: as from the key before to the one after (Catmull and
// Rom 1974, by Bessel's weights where keys are not evenly spaced). Not at all where it stands still
// on either side, so that the spline does not swing beyond a place where the camera is to rest.
Vec3d Speed(const std::vector<CameraKey>& path, std::size_t i, Vec3d CameraKey::*point) {
  const auto slope = [&](std::size_t from) {
    return (path[from + 1].*point - path[from].*point) / (path[from + 1].frame - path[from].frame);
  };
  const std::size_t last = path.size() - 1;
  const Vec3d before = slope(i == 0 ? 0 : i - 1), after = slope(i == last ? last - 1 : i);
  if (before == Vec3d(0.0) || after == Vec3d(0.0)) return Vec3d(0.0);
  if (i == 0 || i == last) return before;
  const double left = path[i].frame - path[i - 1].frame;
  const double right = path[i + 1].frame - path[i].frame;
  return (before * right + after * left) / (left + right);
}

// Hermite's cubic from key `i` to the next, at the share `t` of the way.
Vec3d PointAt(const std::vector<CameraKey>& path, std::size_t i, double t,
              Vec3d CameraKey::*point) {
  const double frames = path[i + 1].frame - path[i].frame;
  const Vec3d a = path[i].*point, b = path[i + 1].*point;
  const Vec3d leave = Speed(path, i, point) * frames, arrive = Speed(path, i + 1, point) * frames;
  const Vec3d way = b - a;
  return a +
         t * (leave + t * (3.0 * way - 2.0 * leave - arrive + t * (leave + arrive - 2.0 * way)));
}

void Take(const CameraKey& key, Camera* camera) {
  camera->eye = key.eye;
  camera->look_at = key.look_at;
  SetParameter(camera->projection, key.lens);
}

}  // namespace

Camera CameraAt(const Camera& camera, double frame) {
  Camera moved = camera;
  moved.path.clear();
  const std::vector<CameraKey>& path = camera.path;
  if (path.empty()) return moved;
  const auto after =
      std::upper_bound(path.begin(), path.end(), frame,
                       [](double at, const CameraKey& key) { return at < key.frame; });
  if (after == path.begin() || after == path.end()) {
    Take(after == path.begin() ? path.front() : path.back(), &moved);
    return moved;
  }
  const auto i = static_cast<std::size_t>(after - path.begin()) - 1;
  const double t = (frame - path[i].frame) / (after->frame - path[i].frame);
  Take({frame, PointAt(path, i, t, &CameraKey::eye), PointAt(path, i, t, &CameraKey::look_at),
        path[i].lens + t * (after->lens - path[i].lens)},
       &moved);
  return moved;
}

}  // namespace sheaf
