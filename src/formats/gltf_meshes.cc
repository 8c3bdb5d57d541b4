#include "src/formats/gltf_meshes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <utility>
#include <variant>

#include "simd/tree.h"
#include "src/formats/gltf_accessors.h"

namespace sheaf {
namespace {

// An attribute of vertices and how many components it may have.
struct Attribute {
  std::string name;
  int low, high;
};

// Fills `out`, which stays empty where the attribute is absent. Where `count` is not 0 there must
// be as many elements.
template <typename Vector>
bool ReadAttribute(GltfDocument& document, const tinygltf::Primitive& primitive,
                   const std::string& place, const Attribute& attribute, std::size_t count,
                   std::vector<Vector>* out) {
  const auto found = primitive.attributes.find(attribute.name);
  if (found == primitive.attributes.end()) return true;
  const auto numbers = ReadAccessor(document, found->second, attribute.low, attribute.high);
  if (!numbers) return false;
  const std::size_t given = numbers->count();
  if (count != 0 && given != count) {
    return document.Fail(
        place, fmt::format("{} has {} elements, POSITION {}", attribute.name, given, count));
  }
  out->resize(given);
  for (std::size_t i = 0; i < given; ++i) {
    for (int c = 0; c < Vector::length(); ++c) {
      const double value = numbers->values[i * numbers->components + static_cast<std::size_t>(c)];
      if (!(std::abs(value) <= kMaxCoordinate)) {
        return document.Fail(
            place, fmt::format("{} {}: a number is not finite, or beyond 1e30", attribute.name, i));
      }
      (*out)[i][c] = static_cast<float>(value);
    }
  }
  return true;
}

}  // namespace

bool GltfMeshes::Add(int index, const std::string& node_name, const Transform& transform) {
  const auto& meshes = document_.model().meshes;
  if (!IsIndexOf(index, meshes)) {
    return document_.Fail("/nodes", fmt::format("mesh {} of {}", index, meshes.size()));
  }
  const auto& primitives = meshes[static_cast<std::size_t>(index)].primitives;
  for (std::size_t i = 0; i < primitives.size(); ++i) {
    const std::string place = fmt::format("/meshes/{}/primitives/{}", index, i);
    const std::string name = primitives.size() == 1 ? node_name : "";
    if (!AddPrimitive(primitives[i], place, name, transform)) return false;
  }
  return true;
}

bool GltfMeshes::AddPrimitive(const tinygltf::Primitive& primitive, const std::string& place,
                              const std::string& name, const Transform& transform) {
  if (primitive.mode >= 0 && primitive.mode < TINYGLTF_MODE_TRIANGLES) {
    document_.Warn(place, "points and lines are passed over");
    return true;
  }
  Mesh mesh;
  if (!ReadPrimitive(primitive, place, &mesh)) return false;
  const std::size_t triangles = mesh.triangles.size();
  Scene one;
  one.objects.push_back({name, std::move(mesh), materials_.MaterialOf(primitive.material)});
  const std::string fault = TransformScene(transform, &one);
  if (!fault.empty()) return document_.Fail(place, fault);
  triangles_ += triangles;
  if (triangles_ > kMaxTreePrimitives) {
    return document_.Fail(place, fmt::format("more than {} triangles in all", kMaxTreePrimitives));
  }
  scene_.objects.push_back(std::move(one.objects[0]));
  return true;
}

bool GltfMeshes::ReadPrimitive(const tinygltf::Primitive& primitive, const std::string& place,
                               Mesh* mesh) {
  const auto& materials = document_.model().materials;
  if (primitive.material >= 0 && !IsIndexOf(primitive.material, materials)) {
    return document_.Fail(place,
                          fmt::format("material {} of {}", primitive.material, materials.size()));
  }
  const auto read = [&](const Attribute& attribute, std::size_t count, auto* out) {
    return ReadAttribute(document_, primitive, place, attribute, count, out);
  };
  if (!read({"POSITION", 3, 3}, 0, &mesh->positions)) return false;
  const std::size_t count = mesh->positions.size();
  if (count == 0) return document_.Fail(place, "no POSITION");
  if (!read({"NORMAL", 3, 3}, count, &mesh->normals) ||
      !read({TextureCoordinates(primitive), 2, 2}, count, &mesh->uv) ||
      !read({"COLOR_0", 3, 4}, count, &mesh->colours)) {
    return false;
  }
  for (glm::vec3& colour : mesh->colours) colour = glm::max(colour, glm::vec3(0));
  return ReadTriangles(primitive, place, mesh);
}

bool GltfMeshes::ReadTriangles(const tinygltf::Primitive& primitive, const std::string& place,
                               Mesh* mesh) {
  std::vector<std::uint32_t> corners;
  if (!ReadCorners(primitive, place, mesh->positions.size(), &corners)) return false;
  const int mode = primitive.mode < 0 ? TINYGLTF_MODE_TRIANGLES : primitive.mode;
  if (mode == TINYGLTF_MODE_TRIANGLES && corners.size() % 3 != 0) {
    return document_.Fail(place, fmt::format("{} corners do not divide by 3", corners.size()));
  }
  for (std::size_t i = 0; i + 2 < corners.size(); i += mode == TINYGLTF_MODE_TRIANGLES ? 3 : 1) {
    const std::size_t odd = mode == TINYGLTF_MODE_TRIANGLE_STRIP && i % 2 ? 1 : 0;
    const std::size_t first = mode == TINYGLTF_MODE_TRIANGLE_FAN ? 0 : i;
    mesh->triangles.push_back({corners[first], corners[i + 1 + odd], corners[i + 2 - odd]});
  }
  return true;
}

bool GltfMeshes::ReadCorners(const tinygltf::Primitive& primitive, const std::string& place,
                             std::size_t vertices, std::vector<std::uint32_t>* out) {
  if (primitive.indices < 0) {
    for (std::uint32_t i = 0; i < vertices; ++i) out->push_back(i);
    return true;
  }
  const auto numbers = ReadAccessor(document_, primitive.indices, 1, 1);
  if (!numbers) return false;
  for (const double value : numbers->values) {
    if (!(value >= 0 && value < static_cast<double>(vertices)) || value != std::floor(value)) {
      return document_.Fail(place, fmt::format("vertex {} of {}", value, vertices));
    }
    out->push_back(static_cast<std::uint32_t>(value));
  }
  return true;
}

// The set that the material's texture asks for.
std::string GltfMeshes::TextureCoordinates(const tinygltf::Primitive& primitive) const {
  int set = 0;
  if (primitive.material >= 0) {
    const auto& material =
        document_.model().materials[static_cast<std::size_t>(primitive.material)];
    set = material.pbrMetallicRoughness.baseColorTexture.texCoord;
  }
  return fmt::format("TEXCOORD_{}", set);
}

}  // namespace sheaf
