// Reads a mesh that stands in a scene file itself.
#ifndef SHEAF_FORMATS_SCENE_MESH_H_
#define SHEAF_FORMATS_SCENE_MESH_H_

#include "sheaf/scene.h"
#include "src/formats/json_cursor.h"

namespace sheaf {

Mesh ReadMesh(const JsonCursor& value);

}  // namespace sheaf

#endif  // SHEAF_FORMATS_SCENE_MESH_H_
