#include "src/formats/gltf_validate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <string>

#include "src/formats/printable.h"

namespace sheaf {
namespace {

constexpr int kMaxNesting = 256;

constexpr std::string_view kKnownExtensions[] = {
    "KHR_lights_punctual", "KHR_materials_ior", "KHR_materials_transmission",
    "KHR_mesh_quantization", "KHR_materials_emissive_strength"};

bool IsKnown(std::string_view extension) {
  return std::find(std::begin(kKnownExtensions), std::end(kKnownExtensions), extension) !=
         std::end(kKnownExtensions);
}

// The JSON of a .gltf, or that of a .glb: its first chunk, or nothing where there is none.
std::string_view JsonOf(std::string_view bytes) {
  if (!bytes.starts_with("glTF")) return bytes;
  constexpr std::size_t kHeader = 20;  // of the file and of the chunk
  return bytes.size() > kHeader ? bytes.substr(kHeader) : std::string_view();
}

bool NestsTooDeep(std::string_view json) {
  int depth = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < json.size() && depth <= kMaxNesting; ++i) {
    const char c = json[i];
    if (in_string) {
      if (c == '\\') ++i;
      in_string = c != '"';
    } else if (c == '"') {
      in_string = true;
    } else if (c == '[' || c == '{') {
      ++depth;
    } else if (c == ']' || c == '}') {
      if (--depth == 0) return false;  // the end of the JSON; binary chunks may follow
    }
  }
  return depth > kMaxNesting;
}

}  // namespace

bool CheckNesting(std::string_view bytes, GltfDocument& document) {
  if (!NestsTooDeep(JsonOf(bytes))) return true;
  return document.Fail("", fmt::format("values nest deeper than {}", kMaxNesting));
}

bool CheckExtensions(GltfDocument& document) {
  for (const std::string& extension : document.model().extensionsRequired) {
    if (!IsKnown(extension)) {
      return document.Fail("/extensionsRequired",
                           fmt::format("the extension \"{}\" is not known", Printable(extension)));
    }
  }
  for (const std::string& extension : document.model().extensionsUsed) {
    if (IsKnown(extension)) continue;
    document.Warn("", fmt::format("the extension \"{}\" is not known, and is passed over",
                                  Printable(extension)));
  }
  return true;
}

}  // namespace sheaf
