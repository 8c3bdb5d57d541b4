// Writes a scene as scene JSON (docs/scene-format.md).
#ifndef SHEAF_FORMATS_WRITE_SCENE_JSON_H_
#define SHEAF_FORMATS_WRITE_SCENE_JSON_H_

#include <string>

#include "src/scene/scene.h"

namespace sheaf {

// ParseSceneJson reads the very numbers back. Objects refer to materials by name, so these need
// names of their own. Colours are written as they are: with Transfer::kSrgb the reader would decode
// them, so that transfer is refused by an assertion.
std::string SceneJsonText(const Scene& scene);

}  // namespace sheaf

#endif  // SHEAF_FORMATS_WRITE_SCENE_JSON_H_
