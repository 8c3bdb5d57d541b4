// A mesh that stands in scene JSON itself, read and written.
#ifndef SHEAF_FORMATS_SCENE_MESH_H_
#define SHEAF_FORMATS_SCENE_MESH_H_

#include <glm/common.hpp>

#include "sheaf/scene.h"
#include "src/formats/json_cursor.h"
#include "src/formats/scene_values.h"

namespace sheaf {

Mesh ReadMesh(const JsonCursor& value);

Json MeshJson(const Mesh& mesh);

// A vertex's colour of a model, within what scene JSON has: some programs write less than 0.
inline glm::vec3 VertexColour(const glm::vec3& colour) {
  return glm::clamp(colour, static_cast<float>(kStrength.low), static_cast<float>(kStrength.high));
}

}  // namespace sheaf

#endif  // SHEAF_FORMATS_SCENE_MESH_H_
