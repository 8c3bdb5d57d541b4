// The settings of scene JSON, read and written.
#ifndef SHEAF_FORMATS_SCENE_SETTINGS_H_
#define SHEAF_FORMATS_SCENE_SETTINGS_H_

#include "sheaf/scene.h"
#include "src/formats/json_cursor.h"
#include "src/formats/scene_values.h"

namespace sheaf {

// Sets `decode` to how the colours of the file are encoded.
Settings ReadSettings(const JsonCursor& value, Transfer* decode);

Json SettingsJson(const Settings& settings);

}  // namespace sheaf

#endif  // SHEAF_FORMATS_SCENE_SETTINGS_H_
