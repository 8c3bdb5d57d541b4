// Counts what a scene has, and so what the renderer pays for.
#ifndef SHEAF_APP_SCENE_SUMMARY_H_
#define SHEAF_APP_SCENE_SUMMARY_H_

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "sheaf/scene.h"
#include "src/scene/bounds.h"

namespace sheaf {

// Something that a scene may have or lack. A material counts only where an object uses it.
struct Feature {
  std::string name;
  bool present;
};

struct SceneSummary {
  std::size_t spheres = 0, triangles = 0, disks = 0;  // a quad is two triangles
  std::optional<Bounds> bounds;                       // nothing where the scene has no object
  std::vector<Feature> features;                      // always the same names in the same order
};

SceneSummary Summarize(const Scene& scene);

}  // namespace sheaf

#endif  // SHEAF_APP_SCENE_SUMMARY_H_
