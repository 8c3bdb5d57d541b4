// The materials of a glTF file, and their textures.
#ifndef SHEAF_FORMATS_GLTF_MATERIALS_H_
#define SHEAF_FORMATS_GLTF_MATERIALS_H_

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sheaf/scene.h"
#include "src/formats/gltf_document.h"

namespace sheaf {

// Turns metallic and roughness into what a Whitted tracer has (docs/formats.md, "glTF").
class GltfMaterials {
 public:
  GltfMaterials(GltfDocument& document, Scene& scene) : document_(document), scene_(scene) {}

  // All of the file's materials, into the scene. False with a fault in the document.
  bool Read();

  // The scene's material for one of the file's; a plain one for -1.
  std::uint32_t MaterialOf(int index);

 private:
  bool ReadMaterial(std::size_t index);
  bool ReadTexture(int index, const std::string& place, Texture* out);
  bool LoadImage(std::size_t index, std::shared_ptr<const Image>* out);

  GltfDocument& document_;
  Scene& scene_;
  std::vector<std::shared_ptr<const Image>> images_;
  std::optional<std::uint32_t> plain_;
};

}  // namespace sheaf

#endif  // SHEAF_FORMATS_GLTF_MATERIALS_H_
