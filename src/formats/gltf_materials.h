// The materials of a glTF file.
#ifndef SHEAF_FORMATS_GLTF_MATERIALS_H_
#define SHEAF_FORMATS_GLTF_MATERIALS_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "sheaf/scene.h"
#include "src/formats/gltf_document.h"
#include "src/formats/gltf_textures.h"

namespace sheaf {

// What meshes have to know of their material.
struct GltfMaterialUse {
  // Whose TEXCOORD its textures lie by, those of set 0 and those of set 1; -1: there are none.
  std::array<int, 2> sets = {-1, -1};
  bool is_unlit = false;
  Alpha alpha;  // what its mode makes of transparent vertices
};

// Turns metallic and roughness into what a Whitted tracer has (docs/formats.md, "glTF").
class GltfMaterials {
 public:
  GltfMaterials(GltfDocument& document, Scene& scene)
      : document_(document), scene_(scene), textures_(document) {}

  // All of the file's materials, into the scene. False with a fault in the document.
  bool Read();

  // The scene's material for one of the file's; a plain one for -1.
  std::uint32_t MaterialOf(int index);
  GltfMaterialUse UseOf(int index) const;
  // Told of one of the file's materials that it is seen on vertices which are not opaque.
  void ShowAlpha(int index);

 private:
  struct Surface;
  struct Uses;

  bool ReadMaterial(std::size_t index);
  Surface ReadSurface(const tinygltf::Material& from);
  Surface ReadSpecularGlossiness(const tinygltf::Value& from);
  std::array<int, 2> ChooseSets(Uses& uses, const std::string& place);
  void SetTextures(const tinygltf::Material& from, const Surface& surface, const Uses& uses,
                   Material* material);

  GltfDocument& document_;
  Scene& scene_;
  GltfTextures textures_;
  std::vector<GltfMaterialUse> uses_;
  std::optional<std::uint32_t> plain_;
};

}  // namespace sheaf

#endif  // SHEAF_FORMATS_GLTF_MATERIALS_H_
