// What a glTF file is made of before anything in it is read: its JSON, its binary chunk and the
// bytes behind URIs.
#ifndef SHEAF_FORMATS_GLTF_SOURCE_H_
#define SHEAF_FORMATS_GLTF_SOURCE_H_

#include <optional>
#include <string>
#include <string_view>

#include "sheaf/error.h"

namespace sheaf {

struct GltfSource {
  std::string_view json;
  std::optional<std::string_view> binary;  // the second chunk of a .glb
};

// The parts of a .glb, or of a .gltf, which is all JSON. Errors have no place.
Result<GltfSource> SplitGltf(std::string_view bytes);

inline constexpr std::string_view kGltf1 = "this is glTF 1.0; only 2.0 is read";

// RFC 2397: `data:` with a type that may be empty or have parameters, in base64 or with escapes.
bool IsDataUri(std::string_view uri);
std::optional<std::string> DecodeDataUri(std::string_view uri);

// The path that a relative URI names. `%` without two digits stands for itself, as `+` always does.
std::string DecodeUriPath(std::string_view uri);

// For messages: a path, or how long a data URI is.
std::string ShowUri(std::string_view uri);

}  // namespace sheaf

#endif  // SHEAF_FORMATS_GLTF_SOURCE_H_
