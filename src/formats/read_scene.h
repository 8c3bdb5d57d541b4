// Reads a model, and adds what a picture of it needs.
#ifndef SHEAF_FORMATS_READ_SCENE_H_
#define SHEAF_FORMATS_READ_SCENE_H_

#include <string>

#include "sheaf/error.h"
#include "sheaf/formats.h"
#include "sheaf/scene.h"
#include "src/formats/scene_files.h"

namespace sheaf {

// Whether the path's ending is that of a scene or a model, and of a model alone.
bool IsScenePath(const std::string& path);
bool IsModelPath(const std::string& path);

// What the file holds and nothing more: a model may lack cameras, lights and materials of its own.
Result<Scene> ReadSceneFile(const std::string& path, SceneFiles& files);

// ReadScene that decodes no image again which is in `images`, and puts there what it decodes.
Result<ReadSceneResult> ReadScene(const std::string& path, const ReadOptions& options,
                                  DecodedImages& images);

// What models without materials are made of: matt and grey. White ambient light shows a part of the
// colours of all models.
inline constexpr double kModelAmbient = 0.25;
Material PlainMaterial();

}  // namespace sheaf

#endif  // SHEAF_FORMATS_READ_SCENE_H_
