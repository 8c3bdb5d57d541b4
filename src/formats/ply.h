// PLY, the Stanford polygon format (Turk 1994).
#ifndef SHEAF_FORMATS_PLY_H_
#define SHEAF_FORMATS_PLY_H_

#include <string>
#include <string_view>

#include "sheaf/error.h"
#include "sheaf/scene.h"
#include "src/formats/scene_files.h"

namespace sheaf {

// One mesh of ascii or binary PLY, of either byte order: positions (x y z), normals (nx ny nz),
// surface coordinates (u v, s t or texture_u texture_v; v up in the file), colours (red green blue:
// integers are sRGB, floats linear) and polygons (vertex_indices or vertex_index). Other elements
// and properties are skipped. Errors are kScene, `name:line: what` in headers and ascii, `name:
// vertex 3: what` in binary. Memory stays a small multiple of the text, whatever it claims.
Result<Mesh> ParsePly(std::string_view text, const std::string& name);

// The same as a scene of one object, grey where the mesh has no colours.
Result<Scene> ParsePlyScene(std::string_view text, const std::string& name, SceneFiles& files);

}  // namespace sheaf

#endif  // SHEAF_FORMATS_PLY_H_
