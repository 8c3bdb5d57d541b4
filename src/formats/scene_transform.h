// Reads a transform from a scene file.
#ifndef SHEAF_FORMATS_SCENE_TRANSFORM_H_
#define SHEAF_FORMATS_SCENE_TRANSFORM_H_

#include "src/formats/json_cursor.h"
#include "src/scene/transform.h"

namespace sheaf {

// One step, or an array of steps that are done in turn; the identity where the value is absent.
Transform ReadTransform(const JsonCursor& value);

}  // namespace sheaf

#endif  // SHEAF_FORMATS_SCENE_TRANSFORM_H_
