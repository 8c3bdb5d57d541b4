// A mesh that stands in scene JSON itself, read and written.
#ifndef SHEAF_FORMATS_SCENE_MESH_H_
#define SHEAF_FORMATS_SCENE_MESH_H_

#include "sheaf/scene.h"
#include "src/formats/json_cursor.h"
#include "src/formats/scene_values.h"

namespace sheaf {

Mesh ReadMesh(const JsonCursor& value);

Json MeshJson(const Mesh& mesh);

}  // namespace sheaf

#endif  // SHEAF_FORMATS_SCENE_MESH_H_
