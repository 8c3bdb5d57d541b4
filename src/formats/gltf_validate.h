// What a glTF file must keep to before anything in it is read.
#ifndef SHEAF_FORMATS_GLTF_VALIDATE_H_
#define SHEAF_FORMATS_GLTF_VALIDATE_H_

#include <string_view>

#include "src/formats/gltf_document.h"

namespace sheaf {

// False with a fault where values nest deep: tinygltf follows them down the stack.
bool CheckNesting(std::string_view bytes, GltfDocument& document);

// False with a fault where the file requires an extension that is not known; those that it merely
// uses are warnings.
bool CheckExtensions(GltfDocument& document);

}  // namespace sheaf

#endif  // SHEAF_FORMATS_GLTF_VALIDATE_H_
