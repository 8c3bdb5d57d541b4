// The meshes of a glTF file.
#ifndef SHEAF_FORMATS_GLTF_MESHES_H_
#define SHEAF_FORMATS_GLTF_MESHES_H_

#include <cstdint>
#include <string>
#include <vector>

#include "sheaf/scene.h"
#include "src/formats/gltf_document.h"
#include "src/formats/gltf_materials.h"
#include "src/scene/transform.h"

namespace sheaf {

class GltfMeshes {
 public:
  GltfMeshes(GltfDocument& document, GltfMaterials& materials, Scene& scene)
      : document_(document), materials_(materials), scene_(scene) {}

  // A mesh of the file where a node puts it: an object a primitive. False with a fault in the
  // document.
  bool Add(int index, const std::string& node_name, const Transform& transform);

 private:
  bool AddPrimitive(const tinygltf::Primitive& primitive, const std::string& place,
                    const std::string& name, const Transform& transform);
  bool ReadPrimitive(const tinygltf::Primitive& primitive, const std::string& place, Mesh* mesh);
  bool ReadTriangles(const tinygltf::Primitive& primitive, const std::string& place, Mesh* mesh);
  bool ReadCorners(const tinygltf::Primitive& primitive, const std::string& place,
                   std::size_t vertices, std::vector<std::uint32_t>* out);
  std::string TextureCoordinates(const tinygltf::Primitive& primitive) const;

  GltfDocument& document_;
  GltfMaterials& materials_;
  Scene& scene_;
  std::uint64_t triangles_ = 0;  // of all meshes
};

}  // namespace sheaf

#endif  // SHEAF_FORMATS_GLTF_MESHES_H_
