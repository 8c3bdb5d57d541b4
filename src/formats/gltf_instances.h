// Where the nodes of a glTF file put their meshes, and which meshes are worth sharing.
#ifndef SHEAF_FORMATS_GLTF_INSTANCES_H_
#define SHEAF_FORMATS_GLTF_INSTANCES_H_

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "src/formats/gltf_document.h"
#include "src/scene/transform.h"

namespace sheaf {

// The places of a node's mesh, within the node: one, or those of EXT_mesh_gpu_instancing. Nothing,
// and a fault in the document, where these are malformed.
std::optional<std::vector<Transform>> ReadPlaces(GltfDocument& document, const tinygltf::Node& node,
                                                 const std::string& place);

// The turn of a quaternion x, y, z, w of any length; none of length 0.
glm::dmat3 TurnOf(double x, double y, double z, double w);

// Counts the places of meshes, and says of which copies would take more than instances do.
class SharedMeshes {
 public:
  explicit SharedMeshes(const tinygltf::Model& model) : model_(model) {}

  // Nodes with skins or weights of their own have meshes of their own.
  static bool MayShare(const tinygltf::Node& node) { return node.skin < 0 && node.weights.empty(); }
  void Count(const tinygltf::Node& node, std::size_t places);
  bool IsShared(const tinygltf::Node& node) const;

 private:
  const tinygltf::Model& model_;
  std::map<int, std::uint64_t> places_;  // by mesh
};

}  // namespace sheaf

#endif  // SHEAF_FORMATS_GLTF_INSTANCES_H_
