// The meshes of a glTF file.
#ifndef SHEAF_FORMATS_GLTF_MESHES_H_
#define SHEAF_FORMATS_GLTF_MESHES_H_

#include <cstdint>
#include <optional>
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

  // The mesh of a node, where `transform` puts it or, of a skin, where its joints do: an object a
  // primitive. False with a fault in the document.
  bool Add(const tinygltf::Node& node, const Transform& transform,
           const std::optional<std::vector<Transform>>& joints);

 private:
  // What a node gives to all primitives of its mesh.
  struct Placement {
    const Transform& transform;
    const std::optional<std::vector<Transform>>& joints;
    const std::vector<double>& weights;  // of the morph targets
  };

  bool AddPrimitive(const tinygltf::Primitive& primitive, const std::string& place,
                    const std::string& name, const Placement& placement);
  bool IsLeftOut(const tinygltf::Primitive& primitive, const std::string& place);
  const char* CompressionOf(const tinygltf::Primitive& primitive) const;
  const char* CompressionOf(int accessor) const;
  bool ReadPrimitive(const tinygltf::Primitive& primitive, const std::string& place, Mesh* mesh);
  bool ReadColours(const tinygltf::Primitive& primitive, const std::string& place, Mesh* mesh);
  bool ReadAlphas(const tinygltf::Primitive& primitive, int colours, const std::string& place,
                  Mesh* mesh);
  bool ReadTextureCoordinates(const tinygltf::Primitive& primitive, const std::string& place,
                              Mesh* mesh);
  bool ReadTriangles(const tinygltf::Primitive& primitive, const std::string& place, Mesh* mesh);
  bool ReadCorners(const tinygltf::Primitive& primitive, std::size_t vertices,
                   std::vector<std::uint32_t>* out);

  GltfDocument& document_;
  GltfMaterials& materials_;
  Scene& scene_;
  std::uint64_t triangles_ = 0;  // of all meshes
};

}  // namespace sheaf

#endif  // SHEAF_FORMATS_GLTF_MESHES_H_
