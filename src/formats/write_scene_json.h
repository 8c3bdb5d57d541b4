// Writes a scene as scene JSON (docs/scene-format.md).
#ifndef SHEAF_FORMATS_WRITE_SCENE_JSON_H_
#define SHEAF_FORMATS_WRITE_SCENE_JSON_H_

#include <string>

#include "sheaf/scene.h"

namespace sheaf {

// ParseSceneJson reads the very numbers back, with images where the scene's textures name them.
// Objects refer to materials by name, so these need names of their own. Colours are written as they
// are, linear; Transfer::kSrgb then is for pictures alone.
std::string SceneJsonText(const Scene& scene);

// Gives materials, cameras and views names that scene JSON allows: none empty, none twice, no
// control characters; objects and lights those, or none.
void MakeNamesUnique(Scene* scene);

}  // namespace sheaf

#endif  // SHEAF_FORMATS_WRITE_SCENE_JSON_H_
