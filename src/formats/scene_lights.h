// The lights of scene JSON, read and written.
#ifndef SHEAF_FORMATS_SCENE_LIGHTS_H_
#define SHEAF_FORMATS_SCENE_LIGHTS_H_

#include "sheaf/scene.h"
#include "src/formats/json_cursor.h"
#include "src/formats/scene_values.h"

namespace sheaf {

// Turns "E0", the illuminance at a reference point, into the intensity that causes it.
// Its "name" is read by the caller, who knows the others.
Light ReadLight(JsonObject* object);

Json LightJson(const Light& light);

}  // namespace sheaf

#endif  // SHEAF_FORMATS_SCENE_LIGHTS_H_
