// PLY, the Stanford polygon format (Turk 1994).
#ifndef SHEAF_FORMATS_PLY_H_
#define SHEAF_FORMATS_PLY_H_

#include <string>
#include <string_view>

#include "sheaf/error.h"
#include "sheaf/scene.h"
#include "src/formats/scene_files.h"

namespace sheaf {

// Ascii or binary PLY, of either byte order, as one object a texture: docs/formats.md says what is
// read. What is not sound is left out with a warning. Errors are kScene, `name:line: what` in
// headers and ascii, `name: vertex 3: what` in binary. Memory stays a small multiple of the text,
// whatever it claims.
Result<Scene> ParsePlyScene(std::string_view text, const std::string& name, SceneFiles& files);

}  // namespace sheaf

#endif  // SHEAF_FORMATS_PLY_H_
