// The cameras of scene JSON, read and written.
#ifndef SHEAF_FORMATS_SCENE_CAMERAS_H_
#define SHEAF_FORMATS_SCENE_CAMERAS_H_

#include "sheaf/scene.h"
#include "src/formats/json_cursor.h"
#include "src/formats/scene_values.h"

namespace sheaf {

Camera ReadCamera(const JsonCursor& value, NameTable* names);

Json CameraJson(const Camera& camera);

}  // namespace sheaf

#endif  // SHEAF_FORMATS_SCENE_CAMERAS_H_
