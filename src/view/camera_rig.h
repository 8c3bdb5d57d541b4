// A camera that a hand moves: about what it looks at, about itself, and through the scene.
//
// The camera's `up` is the axis that it turns about, so that its horizon stays level and a scene
// file's camera with the same `up` can stand in its place.
#ifndef SHEAF_VIEW_CAMERA_RIG_H_
#define SHEAF_VIEW_CAMERA_RIG_H_

#include "sheaf/scene.h"

namespace sheaf {

class CameraRig {
 public:
  CameraRig() = default;
  explicit CameraRig(const Camera& camera) : camera_(camera) {}

  const Camera& camera() const { return camera_; }

  // Moves the eye on a sphere about look_at: to the right and up, as the camera sees it. It stops
  // short of the poles, where `up` would say nothing.
  void Orbit(double right_degrees, double up_degrees);
  // Turns the camera about its eye: look_at moves.
  void Look(double right_degrees, double up_degrees);
  // Moves eye and look_at together, in parts of the distance between them.
  void Fly(double right, double up, double ahead);
  // Multiplies the distance to look_at, or the height that an orthographic camera sees.
  void Zoom(double factor);
  // Multiplies the angle of a perspective or fisheye camera, within what Projection allows.
  void Widen(double factor);

  // Unit vectors, as the camera sees them.
  Vec3d Ahead() const;
  Vec3d Right() const;

 private:
  // The degrees by which `ahead` may be raised towards `up`, of `degrees`.
  double Raised(const Vec3d& ahead, double degrees) const;

  Camera camera_;
};

}  // namespace sheaf

#endif  // SHEAF_VIEW_CAMERA_RIG_H_
