// Instances through all levels, as one list.
#ifndef SHEAF_SCENE_PLACED_GROUPS_H_
#define SHEAF_SCENE_PLACED_GROUPS_H_

#include <cstdint>
#include <optional>
#include <vector>

#include "sheaf/error.h"
#include "sheaf/scene.h"
#include "src/scene/bounds.h"
#include "src/scene/transform.h"

namespace sheaf {

// A place where the objects of a group stand.
struct PlacedGroup {
  std::uint32_t group;
  Transform to_world;
};

inline Transform TransformOf(const Instance& instance) {
  return {instance.linear, instance.translation};
}

// How many places a scene's instances make, through all levels; a number above kMaxInstances where
// there are more than that.
std::uint64_t CountPlacedGroups(const Scene& scene);

// They in order, each instance before those that its group is made of. Groups keep their rules.
std::vector<PlacedGroup> PlaceGroups(const Scene& scene);

// The box around what a box becomes.
Bounds Mapped(const Transform& transform, const Bounds& bounds);

// The scene with copies of objects in place of instances. Fails with kScene where an object cannot
// be moved so: a sphere that would be an ellipsoid.
Result<Scene> Flattened(const Scene& scene);

// Calls f(box) for the box around each place of a scene where anything stands.
template <typename F>
void ForEachPlacedBox(const Scene& scene, F f) {
  std::vector<std::optional<Bounds>> boxes;
  for (const Group& group : scene.groups) boxes.push_back(BoundsOf(group.objects));
  for (const PlacedGroup& placed : PlaceGroups(scene)) {
    if (boxes[placed.group]) f(Mapped(placed.to_world, *boxes[placed.group]));
  }
}

}  // namespace sheaf

#endif  // SHEAF_SCENE_PLACED_GROUPS_H_
