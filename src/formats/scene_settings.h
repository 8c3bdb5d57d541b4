// The settings of scene JSON, read and written.
#ifndef SHEAF_FORMATS_SCENE_SETTINGS_H_
#define SHEAF_FORMATS_SCENE_SETTINGS_H_

#include "sheaf/scene.h"
#include "src/formats/json_cursor.h"
#include "src/formats/scene_materials.h"
#include "src/formats/scene_values.h"

namespace sheaf {

// Sets how the source decodes colours.
Settings ReadSettings(const JsonCursor& value, ColourSource* source);

Json SettingsJson(const Settings& settings);

}  // namespace sheaf

#endif  // SHEAF_FORMATS_SCENE_SETTINGS_H_
