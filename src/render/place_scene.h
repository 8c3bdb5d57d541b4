// Where a scene is computed: near the origin and of moderate size, wherever its user put it.
//
// A float's error grows with its distance from the origin. A scene is therefore moved and scaled in
// double before anything of it is rounded (docs/numerics.md).
#ifndef SHEAF_RENDER_PLACE_SCENE_H_
#define SHEAF_RENDER_PLACE_SCENE_H_

#include <limits>

#include "sheaf/scene.h"
#include "src/scene/bounds.h"

namespace sheaf {

// From the user's coordinates to those that are computed in. As it is made it changes no bit.
struct ScenePlacement {
  Vec3d origin{0.0};
  double scale = 1;  // a power of two
  // About how far the eye is from what it sees nearest, as the user counts.
  double nearest = std::numeric_limits<double>::infinity();

  Vec3d Point(const Vec3d& p) const { return (p - origin) * scale; }
  double Length(double length) const { return length * scale; }
};

// For what `camera` sees of `scene`. A scene that already lies well stays where it is.
ScenePlacement PlaceScene(const Scene& scene, const Camera& camera);

// Likewise for a group, whose objects have these bounds, wherever it stands.
ScenePlacement PlaceGroup(const Bounds& bounds);

}  // namespace sheaf

#endif  // SHEAF_RENDER_PLACE_SCENE_H_
