// Affine maps of scenes: a matrix and a shift.
#ifndef SHEAF_SCENE_TRANSFORM_H_
#define SHEAF_SCENE_TRANSFORM_H_

#include <glm/mat3x3.hpp>
#include <string>

#include "sheaf/scene.h"

namespace sheaf {

struct Transform {
  glm::dmat3 linear{1.0};  // columns: where the axes go
  Vec3d translation{0.0};

  Vec3d Point(const Vec3d& p) const { return linear * p + translation; }
  Vec3d Vector(const Vec3d& v) const { return linear * v; }

  // Whether every length grows alike: rotations, mirrors and uniform scales, to 1e-6.
  bool KeepsSpheres() const;
  // Of a map that does: the factor.
  double Scale() const;
};

// First `b`, then `a`.
Transform operator*(const Transform& a, const Transform& b);

// Turns by `degrees` about `axis`, of any length but 0, counter-clockwise seen from its tip.
Transform RotationAbout(const Vec3d& axis, double degrees);

// Moves every object, instance, light and camera. Falloffs stay as they are: intensity belongs to
// the light, not to its surroundings. An empty string, or what cannot be moved so.
std::string TransformScene(const Transform& transform, Scene* scene);

}  // namespace sheaf

#endif  // SHEAF_SCENE_TRANSFORM_H_
