// The scene graph of a glTF file, with the cameras and lights that hang in it.
#ifndef SHEAF_FORMATS_GLTF_NODES_H_
#define SHEAF_FORMATS_GLTF_NODES_H_

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "sheaf/scene.h"
#include "src/formats/gltf_document.h"
#include "src/formats/gltf_instances.h"
#include "src/formats/gltf_meshes.h"
#include "src/scene/transform.h"

namespace sheaf {

class GltfNodes {
 public:
  GltfNodes(GltfDocument& document, GltfMeshes& meshes, Scene& scene)
      : document_(document), meshes_(meshes), scene_(scene), shared_(document.model()) {}

  // Everything below the nodes of the file's scene. False with a fault in the document.
  bool Read();

 private:
  bool FindRoots(std::vector<int>* roots);
  // Fills globals_ and order_.
  bool Visit(int index, const Transform& parent, int depth);
  bool AddMesh(int index, const std::string& place, const Transform& transform);
  bool AddPlace(const tinygltf::Node& node, const std::string& place, const Transform& transform);
  bool AddCamera(const tinygltf::Node& node, const std::string& place, const Transform& transform);
  bool AddLight(const tinygltf::Node& node, const std::string& place, const Transform& transform);
  bool ReadSource(const tinygltf::Light& from, const std::string& place, const Vec3d& position,
                  const Vec3d& direction, Light* light);
  std::string FreeName(const std::string& wanted) const;

  GltfDocument& document_;
  GltfMeshes& meshes_;
  Scene& scene_;
  std::vector<bool> visited_;
  std::vector<Transform> globals_;                               // of all nodes
  std::vector<int> order_;                                       // of those in the scene
  std::map<int, std::optional<std::vector<Transform>>> joints_;  // by skin
  std::map<int, std::vector<Transform>> places_;                 // by node that has a mesh
  SharedMeshes shared_;
  std::map<int, std::uint32_t> groups_;  // of the scene, by mesh that is shared
};

}  // namespace sheaf

#endif  // SHEAF_FORMATS_GLTF_NODES_H_
