#include "src/formats/gltf_instances.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "src/formats/gltf_accessors.h"
#include "src/formats/gltf_textures.h"

namespace sheaf {
namespace {

// Copies of so few triangles in all are faster to trace than instances.
constexpr std::uint64_t kWorthSharing = 20'000;

constexpr const char* kExtension = "EXT_mesh_gpu_instancing";

// An attribute of places, of which each may be absent.
struct PlaceAttribute {
  const char* name;
  int components;
  std::optional<GltfNumbers> numbers = std::nullopt;
};

// Fills the numbers of those attributes that are there, all of them as many. Returns how many.
std::optional<std::size_t> ReadAttributes(GltfDocument& document, const tinygltf::Value& extension,
                                          const std::string& place,
                                          PlaceAttribute (&attributes)[3]) {
  std::optional<std::size_t> count;
  const tinygltf::Value given = extension.Get("attributes");
  for (PlaceAttribute& attribute : attributes) {
    if (!given.Has(attribute.name)) continue;
    const int accessor = given.Get(attribute.name).GetNumberAsInt();
    attribute.numbers =
        ReadAccessor(document, accessor, attribute.components, attribute.components);
    if (!attribute.numbers) return std::nullopt;
    const std::size_t n = attribute.numbers->count();
    if (count && *count != n) {
      document.Fail(place, fmt::format("{}: {} has {} elements, another {}", kExtension,
                                       attribute.name, n, *count));
      return std::nullopt;
    }
    count = n;
  }
  if (!count) document.Fail(place, fmt::format("{} has no attributes", kExtension));
  return count;
}

std::uint64_t TrianglesOf(const tinygltf::Model& model, const tinygltf::Mesh& mesh) {
  std::uint64_t triangles = 0;
  for (const tinygltf::Primitive& primitive : mesh.primitives) {
    const auto position = primitive.attributes.find("POSITION");
    const int accessor = primitive.indices >= 0                   ? primitive.indices
                         : position != primitive.attributes.end() ? position->second
                                                                  : -1;
    if (IsIndexOf(accessor, model.accessors)) {
      triangles += model.accessors[static_cast<std::size_t>(accessor)].count / 3;
    }
  }
  return triangles;
}

}  // namespace

glm::dmat3 TurnOf(double x, double y, double z, double w) {
  const double length = x * x + y * y + z * z + w * w;
  const double s = length > 0 ? 2 / length : 0;
  return {1 - s * (y * y + z * z), s * (x * y + w * z),     s * (x * z - w * y),
          s * (x * y - w * z),     1 - s * (x * x + z * z), s * (y * z + w * x),
          s * (x * z + w * y),     s * (y * z - w * x),     1 - s * (x * x + y * y)};
}

std::optional<std::vector<Transform>> ReadPlaces(GltfDocument& document, const tinygltf::Node& node,
                                                 const std::string& place) {
  const tinygltf::Value* extension = FindExtension(node.extensions, kExtension);
  if (extension == nullptr) return std::vector<Transform>(1);
  PlaceAttribute attributes[3] = {{"TRANSLATION", 3}, {"ROTATION", 4}, {"SCALE", 3}};
  const auto count = ReadAttributes(document, *extension, place, attributes);
  if (!count) return std::nullopt;
  std::vector<Transform> places(*count);
  for (std::size_t i = 0; i < *count; ++i) {
    const auto at = [&](int attribute, std::size_t k) {
      const GltfNumbers& numbers = *attributes[attribute].numbers;
      return numbers.values[numbers.components * i + k];
    };
    if (attributes[1].numbers) places[i].linear = TurnOf(at(1, 0), at(1, 1), at(1, 2), at(1, 3));
    for (int axis = 0; axis < 3; ++axis) {
      const auto k = static_cast<std::size_t>(axis);
      if (attributes[2].numbers) places[i].linear[axis] *= at(2, k);
      if (attributes[0].numbers) places[i].translation[axis] = at(0, k);
    }
  }
  return places;
}

void SharedMeshes::Count(const tinygltf::Node& node, std::size_t places) {
  if (MayShare(node)) places_[node.mesh] += places;
}

bool SharedMeshes::IsShared(const tinygltf::Node& node) const {
  const auto found = places_.find(node.mesh);
  if (!MayShare(node) || found == places_.end() || found->second < 2) return false;
  if (!IsIndexOf(node.mesh, model_.meshes)) return false;
  const auto& mesh = model_.meshes[static_cast<std::size_t>(node.mesh)];
  return TrianglesOf(model_, mesh) * found->second >= kWorthSharing;
}

}  // namespace sheaf
