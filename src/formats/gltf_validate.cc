#include "src/formats/gltf_validate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <string>

#include "src/formats/printable.h"

namespace sheaf {
namespace {

constexpr int kMaxNesting = 256;

// Those that are read, and those without which a picture is the same.
constexpr std::string_view kRead[] = {"EXT_mesh_gpu_instancing",
                                      "KHR_lights_punctual",
                                      "KHR_materials_emissive_strength",
                                      "KHR_materials_ior",
                                      "KHR_materials_pbrSpecularGlossiness",
                                      "KHR_materials_specular",
                                      "KHR_materials_transmission",
                                      "KHR_materials_unlit",
                                      "KHR_materials_volume",
                                      "KHR_materials_variants",
                                      "KHR_mesh_quantization",
                                      "KHR_texture_transform",
                                      "KHR_xmp",
                                      "KHR_xmp_json_ld"};

// Those that are named where they cost something: by the image or the primitive.
constexpr std::string_view kNamedWhereUsed[] = {
    "EXT_texture_avif", "EXT_texture_webp", "KHR_texture_basisu", "MSFT_texture_dds", kDraco,
    kMeshopt[0],        kMeshopt[1]};

// Those that change looks alone, besides materials.
constexpr std::string_view kLooks[] = {
    "EXT_lights_ies",      "EXT_lights_image_based", "EXT_texture_video", "KHR_animation_pointer",
    "KHR_technique_webgl", "KHR_techniques_webgl",   "MSFT_lod"};

template <std::size_t kCount>
bool IsOneOf(std::string_view name, const std::string_view (&names)[kCount]) {
  return std::find(std::begin(names), std::end(names), name) != std::end(names);
}

bool NeedsNoWord(std::string_view name) {
  return IsOneOf(name, kRead) || IsOneOf(name, kNamedWhereUsed);
}

bool IsHarmless(std::string_view name) {
  return NeedsNoWord(name) || IsOneOf(name, kLooks) || name.starts_with("KHR_materials_") ||
         name.starts_with("EXT_materials_");
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

bool CheckNesting(std::string_view json, GltfDocument& document) {
  if (!NestsTooDeep(json)) return true;
  return document.Fail("", fmt::format("values nest deeper than {}", kMaxNesting));
}

bool CheckExtensions(GltfDocument& document) {
  const auto& used = document.model().extensionsUsed;
  const auto& required = document.model().extensionsRequired;
  for (const std::string& extension : required) {
    if (IsHarmless(extension)) continue;
    return document.Fail("/extensionsRequired",
                         fmt::format("the extension \"{}\" is not known", Printable(extension)));
  }
  const auto warn = [&](const std::string& extension) {
    if (NeedsNoWord(extension)) return;
    document.Warn("", fmt::format("the extension \"{}\" is not known, and is passed over",
                                  Printable(extension)));
  };
  for (const std::string& extension : used) warn(extension);
  for (const std::string& extension : required) {
    if (std::find(used.begin(), used.end(), extension) == used.end()) warn(extension);
  }
  return true;
}

}  // namespace sheaf
