// How joints and weights move the vertices of a glTF primitive (glTF 2.0, 3.7.2.2 and 3.7.3).
#ifndef SHEAF_FORMATS_GLTF_SKINS_H_
#define SHEAF_FORMATS_GLTF_SKINS_H_

#include <optional>
#include <string>
#include <vector>

#include "sheaf/scene.h"
#include "src/formats/gltf_document.h"
#include "src/scene/transform.h"

namespace sheaf {

// Where each joint of a skin takes a vertex at rest; `globals` are the transforms of all nodes.
// Nothing, with a fault in the document, where the skin is malformed.
std::optional<std::vector<Transform>> ReadJoints(GltfDocument& document, int skin,
                                                 const std::vector<Transform>& globals);

// Moves a primitive's vertices and normals by its JOINTS_n and WEIGHTS_n. False with a fault.
bool ApplySkin(GltfDocument& document, const tinygltf::Primitive& primitive,
               const std::string& place, const std::vector<Transform>& joints, Mesh* mesh);

// Adds its targets, each times its weight. False with a fault.
bool ApplyMorph(GltfDocument& document, const tinygltf::Primitive& primitive,
                const std::string& place, const std::vector<double>& weights, Mesh* mesh);

}  // namespace sheaf

#endif  // SHEAF_FORMATS_GLTF_SKINS_H_
