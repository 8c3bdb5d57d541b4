// The box around what a scene holds.
#ifndef SHEAF_SCENE_BOUNDS_H_
#define SHEAF_SCENE_BOUNDS_H_

#include <optional>
#include <vector>

#include "sheaf/scene.h"
#include "src/scene/shapes.h"

namespace sheaf {

struct Bounds {
  Vec3d min, max;
};

// The smallest box around a shape; nothing around a mesh without triangles.
std::optional<Bounds> BoundsOf(const Shape& shape);

// The smallest box around objects; nothing where there are none.
std::optional<Bounds> BoundsOf(const std::vector<Object>& objects);

// A box around all objects and instances, the smallest around objects; nothing where there are
// none.
std::optional<Bounds> BoundsOf(const Scene& scene);

}  // namespace sheaf

#endif  // SHEAF_SCENE_BOUNDS_H_
