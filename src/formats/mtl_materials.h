// What the materials of MTL libraries become.
#ifndef SHEAF_FORMATS_MTL_MATERIALS_H_
#define SHEAF_FORMATS_MTL_MATERIALS_H_

#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "sheaf/scene.h"
#include "src/formats/image.h"
#include "src/formats/mtl.h"
#include "src/formats/scene_files.h"

namespace sheaf {

// Materials of one OBJ, with their textures: docs/formats.md, "OBJ and MTL". What cannot be shown
// is a warning.
class MtlMaterials {
 public:
  explicit MtlMaterials(SceneFiles& files) : files_(files) {}

  Material Make(const MtlMaterial& from);

 private:
  using ImagePointer = std::shared_ptr<const Image>;

  void AddBaseColour(const MtlMaterial& from, Material* material);
  void AddEmission(const MtlMaterial& from, Material* material);
  void AddNormals(const MtlMaterial& from, Material* material);
  void AddAlpha(const MtlMaterial& from, double opacity, Material* material);
  double OpacityOf(const MtlMaterial& from);
  // Null where there is no such statement, or with a warning.
  ImagePointer Load(const MtlMaterial& from, std::string_view statement);
  ImagePointer WithAlpha(const ImagePointer& base, const ImagePointer& mask);

  SceneFiles& files_;
  ImageCache images_;
  std::map<std::pair<ImagePointer, ImagePointer>, ImagePointer> masked_;  // by base and mask
};

}  // namespace sheaf

#endif  // SHEAF_FORMATS_MTL_MATERIALS_H_
