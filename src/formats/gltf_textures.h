// The textures and images of a glTF file.
#ifndef SHEAF_FORMATS_GLTF_TEXTURES_H_
#define SHEAF_FORMATS_GLTF_TEXTURES_H_

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sheaf/scene.h"
#include "src/formats/gltf_document.h"

namespace sheaf {

// A number of an object in an extension; `otherwise` where it has none.
double NumberIn(const tinygltf::Value& object, const char* key, double otherwise);
// The first numbers of an array there, into `out`, which keeps the rest.
template <typename Vector>
void NumbersIn(const tinygltf::Value& object, const char* key, Vector* out) {
  if (!object.IsObject() || !object.Has(key) || !object.Get(key).IsArray()) return;
  const tinygltf::Value& array = object.Get(key);
  for (int i = 0; i < Vector::length() && static_cast<std::size_t>(i) < array.ArrayLen(); ++i) {
    const tinygltf::Value& number = array.Get(i);
    if (number.IsNumber()) (*out)[i] = number.GetNumberAsDouble();
  }
}
// An extension of a part of the model; null where it has none.
const tinygltf::Value* FindExtension(const tinygltf::ExtensionMap& extensions, const char* name);

// How a material asks for a texture.
struct GltfTextureUse {
  int index = -1;  // none
  int set = 0;     // of the file's texture coordinates; then of the scene's two, 0 or 1
  TextureTransform transform;
};

GltfTextureUse TextureUse(int index, int set, const tinygltf::ExtensionMap& extensions);
// The same as a member of an extension.
GltfTextureUse TextureUseIn(const tinygltf::Value& object, const char* key);

class GltfTextures {
 public:
  explicit GltfTextures(GltfDocument& document) : document_(document) {}

  // Nothing where none is asked for, and, with a warning, where its image cannot be had.
  std::optional<Texture> Read(const GltfTextureUse& use, Transfer transfer);

 private:
  std::shared_ptr<const Image> ImageOf(int texture);
  void SetSampler(int index, Texture* out) const;

  struct Slot {
    bool is_read = false;
    std::shared_ptr<const Image> image;
  };

  GltfDocument& document_;
  std::vector<Slot> images_;
};

}  // namespace sheaf

#endif  // SHEAF_FORMATS_GLTF_TEXTURES_H_
