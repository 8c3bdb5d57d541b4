// Reads a light from a scene file.
#ifndef SHEAF_FORMATS_SCENE_LIGHTS_H_
#define SHEAF_FORMATS_SCENE_LIGHTS_H_

#include "sheaf/scene.h"
#include "src/formats/json_cursor.h"

namespace sheaf {

// Turns "E0", the illuminance at a reference point, into the intensity that causes it.
// Its "name" is read by the caller, who knows the others.
Light ReadLight(JsonObject* object);

}  // namespace sheaf

#endif  // SHEAF_FORMATS_SCENE_LIGHTS_H_
