// glTF 2.0 (Khronos), as .gltf with files or data URIs and as .glb.
#ifndef SHEAF_FORMATS_GLTF_H_
#define SHEAF_FORMATS_GLTF_H_

#include <string>
#include <string_view>

#include "sheaf/error.h"
#include "sheaf/scene.h"
#include "src/formats/scene_files.h"

namespace sheaf {

// Meshes, materials, cameras and lights of the file's scene, moved by their nodes. tinygltf parses;
// whatever indexes or counts is checked here. docs/formats.md lists what is read and what materials
// become. Errors are kScene, `name: /meshes/0/primitives/1: what`.
Result<Scene> ParseGltf(std::string_view bytes, const std::string& name, SceneFiles& files);

}  // namespace sheaf

#endif  // SHEAF_FORMATS_GLTF_H_
