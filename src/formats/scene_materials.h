// The materials of scene JSON, read and written.
#ifndef SHEAF_FORMATS_SCENE_MATERIALS_H_
#define SHEAF_FORMATS_SCENE_MATERIALS_H_

#include <string>

#include "sheaf/scene.h"
#include "src/formats/image.h"
#include "src/formats/json_cursor.h"
#include "src/formats/scene_files.h"
#include "src/formats/scene_values.h"

namespace sheaf {

// Where the images of a scene file come from, and how its colours are encoded.
struct ColourSource {
  const std::string& path;
  SceneFiles& files;
  ImageCache images = {};
  Transfer decode = Transfer::kLinear;
};

Material ReadMaterial(const JsonCursor& value, ColourSource* source, NameTable* names);

// Colours are written linear, and images by their names.
Json MaterialJson(const Material& material);

}  // namespace sheaf

#endif  // SHEAF_FORMATS_SCENE_MATERIALS_H_
