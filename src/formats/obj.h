// Wavefront OBJ with its material library, MTL.
#ifndef SHEAF_FORMATS_OBJ_H_
#define SHEAF_FORMATS_OBJ_H_

#include <string>
#include <string_view>

#include "sheaf/error.h"
#include "sheaf/scene.h"
#include "src/formats/scene_files.h"

namespace sheaf {

// One mesh object a group and material. What is not sound is left out with a warning; an error,
// kScene and `name:line: what`, is a text of which no face is left. docs/formats.md says what
// materials become.
Result<Scene> ParseObj(std::string_view text, const std::string& name, SceneFiles& files);

}  // namespace sheaf

#endif  // SHEAF_FORMATS_OBJ_H_
