// Wavefront OBJ with its material library, MTL.
#ifndef SHEAF_FORMATS_OBJ_H_
#define SHEAF_FORMATS_OBJ_H_

#include <string>
#include <string_view>

#include "sheaf/error.h"
#include "sheaf/scene.h"
#include "src/formats/scene_files.h"

namespace sheaf {

// One mesh object a group and material. tinyobjloader reads the text once it is known to be sound:
// the library takes bad numbers for 0. Errors are kScene, `name:line: what`. A material library
// that is missing is a warning; docs/formats.md says what materials become.
Result<Scene> ParseObj(std::string_view text, const std::string& name, SceneFiles& files);

}  // namespace sheaf

#endif  // SHEAF_FORMATS_OBJ_H_
