// What a glTF file must keep to before anything in it is read.
#ifndef SHEAF_FORMATS_GLTF_VALIDATE_H_
#define SHEAF_FORMATS_GLTF_VALIDATE_H_

#include <string_view>

#include "src/formats/gltf_document.h"

namespace sheaf {

// Compressions of geometry, which are not read.
inline constexpr const char* kDraco = "KHR_draco_mesh_compression";
inline constexpr const char* kMeshopt[] = {"EXT_meshopt_compression", "KHR_meshopt_compression"};

// False with a fault where values nest deep: tinygltf follows them down the stack.
bool CheckNesting(std::string_view json, GltfDocument& document);

// Says what is lost by extensions that are not read. False with a fault where the file requires one
// without which its geometry may be another.
bool CheckExtensions(GltfDocument& document);

}  // namespace sheaf

#endif  // SHEAF_FORMATS_GLTF_VALIDATE_H_
