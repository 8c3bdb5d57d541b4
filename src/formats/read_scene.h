// Reads a model, and adds what a picture of it needs.
#ifndef SHEAF_FORMATS_READ_SCENE_H_
#define SHEAF_FORMATS_READ_SCENE_H_

#include <string>

#include "sheaf/error.h"
#include "sheaf/formats.h"
#include "sheaf/scene.h"
#include "src/formats/scene_files.h"
#include "src/scene/bounds.h"

namespace sheaf {

// Whether the path's ending is that of a scene or a model, and of a model alone.
bool IsScenePath(const std::string& path);
bool IsModelPath(const std::string& path);

// What the file holds and nothing more: a model may lack cameras, lights and materials of its own.
Result<Scene> ReadSceneFile(const std::string& path, SceneFiles& files);

// What models without materials are made of: matt and grey. White ambient light shows a part of the
// colours of all models.
inline constexpr double kModelAmbient = 0.25;
Material PlainMaterial();

// Turns the lights that were added to a scene without any, its first three, by the first camera:
// the key light over its left shoulder, a fill light from the right, a rim light from behind the
// model.
void AimStudio(Scene* scene);

// The camera "default": looks at the middle of the box from the front, a little from the right and
// above, so that its sphere just fits a picture that is `aspect` times as wide as high.
Camera CameraThatFrames(const Bounds& bounds, const Vec3d& up, double aspect);

}  // namespace sheaf

#endif  // SHEAF_FORMATS_READ_SCENE_H_
