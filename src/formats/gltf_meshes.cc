#include "src/formats/gltf_meshes.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <limits>
#include <utility>
#include <variant>

#include "simd/tree.h"
#include "src/formats/gltf_accessors.h"
#include "src/formats/gltf_skins.h"
#include "src/formats/gltf_textures.h"
#include "src/formats/gltf_validate.h"
#include "src/formats/scene_mesh.h"

namespace sheaf {
namespace {

// An attribute of vertices and how many components it may have.
struct Attribute {
  std::string name;
  int low, high;
  double otherwise = 0;
};

constexpr double kUnusable = std::numeric_limits<double>::infinity();

// Whether floats have a number, and a scene's sums of a few.
bool IsUsable(double number) { return std::abs(number) <= kMaxCoordinate; }  // false for NaN

// Fills `out`, which stays empty where the attribute is absent. Where `count` is not 0 there must
// be as many elements. Numbers that are not usable become `otherwise`, with a warning.
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
      (*out)[i][c] = static_cast<float>(IsUsable(value) ? value : attribute.otherwise);
      if (IsUsable(value)) continue;
      document.Warn(place, "a number is not finite, or beyond 1e30",
                    fmt::format("{} {}", attribute.name, i));
    }
  }
  return true;
}

}  // namespace

bool GltfMeshes::Add(const tinygltf::Node& node, const Transform& transform,
                     const std::optional<std::vector<Transform>>& joints) {
  const auto& meshes = document_.model().meshes;
  if (!IsIndexOf(node.mesh, meshes)) {
    return document_.Fail("/nodes", fmt::format("mesh {} of {}", node.mesh, meshes.size()));
  }
  const tinygltf::Mesh& mesh = meshes[static_cast<std::size_t>(node.mesh)];
  const auto& primitives = mesh.primitives;
  const auto& weights = node.weights.empty() ? mesh.weights : node.weights;
  for (std::size_t i = 0; i < primitives.size(); ++i) {
    const std::string place = fmt::format("/meshes/{}/primitives/{}", node.mesh, i);
    const std::string name = primitives.size() == 1 ? node.name : "";
    if (!AddPrimitive(primitives[i], place, name, {transform, joints, weights})) return false;
  }
  return true;
}

bool GltfMeshes::AddPrimitive(const tinygltf::Primitive& primitive, const std::string& place,
                              const std::string& name, const Placement& placement) {
  if (IsLeftOut(primitive, place)) return true;
  Mesh mesh;
  if (!ReadPrimitive(primitive, place, &mesh) ||
      !ApplyMorph(document_, primitive, place, placement.weights, &mesh)) {
    return false;
  }
  if (placement.joints && !ApplySkin(document_, primitive, place, *placement.joints, &mesh)) {
    return false;
  }
  const std::size_t triangles = mesh.triangles.size();
  if (triangles == 0) return true;
  Scene one;
  one.objects.push_back({name, std::move(mesh), materials_.MaterialOf(primitive.material)});
  const std::string fault =
      TransformScene(placement.joints ? Transform{} : placement.transform, &one);
  if (!fault.empty()) return document_.Fail(place, fault);
  triangles_ += triangles;
  if (triangles_ > kMaxTreePrimitives) {
    return document_.Fail(place, fmt::format("more than {} triangles in all", kMaxTreePrimitives));
  }
  scene_.objects.push_back(std::move(one.objects[0]));
  return true;
}

// With a warning.
bool GltfMeshes::IsLeftOut(const tinygltf::Primitive& primitive, const std::string& place) {
  const auto leave_out = [&](std::string_view kind) {
    document_.LeaveOut(place, kind);
    return true;
  };
  if (primitive.mode >= 0 && primitive.mode < TINYGLTF_MODE_TRIANGLES) {
    return leave_out("points and lines are not drawn");
  }
  if (primitive.mode > TINYGLTF_MODE_TRIANGLE_FAN) return leave_out("its mode is not known");
  if (const char* compression = CompressionOf(primitive)) {
    return leave_out(fmt::format("compressed by {}, which is not read", compression));
  }
  if (!primitive.attributes.contains("POSITION")) return leave_out("a primitive has no POSITION");
  return false;
}

// The extension by which a primitive's data is compressed, with nothing else beside; or null.
const char* GltfMeshes::CompressionOf(const tinygltf::Primitive& primitive) const {
  const auto position = primitive.attributes.find("POSITION");
  const auto& accessors = document_.model().accessors;
  if (FindExtension(primitive.extensions, kDraco) != nullptr &&
      position != primitive.attributes.end() && IsIndexOf(position->second, accessors)) {
    const auto& accessor = accessors[static_cast<std::size_t>(position->second)];
    if (accessor.bufferView < 0 && !accessor.sparse.isSparse) return kDraco;
  }
  if (const char* compression = CompressionOf(primitive.indices)) return compression;
  for (const auto& [name, accessor] : primitive.attributes) {
    if (const char* compression = CompressionOf(accessor)) return compression;
  }
  return nullptr;
}

const char* GltfMeshes::CompressionOf(int accessor) const {
  const tinygltf::Model& model = document_.model();
  if (!IsIndexOf(accessor, model.accessors)) return nullptr;
  const int index = model.accessors[static_cast<std::size_t>(accessor)].bufferView;
  if (!IsIndexOf(index, model.bufferViews)) return nullptr;
  const tinygltf::BufferView& view = model.bufferViews[static_cast<std::size_t>(index)];
  if (!IsIndexOf(view.buffer, model.buffers) ||
      !model.buffers[static_cast<std::size_t>(view.buffer)].data.empty()) {
    return nullptr;
  }
  for (const char* name : kMeshopt) {
    if (FindExtension(view.extensions, name) != nullptr) return name;
  }
  return nullptr;
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
  if (!read({"POSITION", 3, 3, kUnusable}, 0, &mesh->positions)) return false;
  const std::size_t count = mesh->positions.size();
  return (count == 0 || (read({"NORMAL", 3, 3}, count, &mesh->normals) &&
                         ReadTextureCoordinates(primitive, place, mesh) &&
                         ReadColours(primitive, place, mesh))) &&
         ReadTriangles(primitive, place, mesh);
}

// By the sets that the material's textures ask for. Without theirs they show their first texel.
bool GltfMeshes::ReadTextureCoordinates(const tinygltf::Primitive& primitive,
                                        const std::string& place, Mesh* mesh) {
  const std::array<int, 2> sets = materials_.UseOf(primitive.material).sets;
  const std::size_t count = mesh->positions.size();
  const auto read = [&](int set, std::vector<glm::vec2>* uv) {
    const std::string name = fmt::format("TEXCOORD_{}", std::max(set, 0));
    if (!ReadAttribute(document_, primitive, place, {name, 2, 2}, count, uv)) return false;
    if (set < 0 || !uv->empty()) return true;
    document_.Warn(place, "a textured primitive has no coordinates", name);
    uv->resize(count, glm::vec2(0.0f));
    return true;
  };
  return read(sets[0], &mesh->uv) && (sets[1] < 0 || read(sets[1], &mesh->uv2));
}

bool GltfMeshes::ReadColours(const tinygltf::Primitive& primitive, const std::string& place,
                             Mesh* mesh) {
  const std::size_t count = mesh->positions.size();
  const auto found = primitive.attributes.find("COLOR_0");
  if (found == primitive.attributes.end()) return true;
  const GltfMaterialUse use = materials_.UseOf(primitive.material);
  if (use.alpha.mode != AlphaMode::kOpaque && !ReadAlphas(primitive, found->second, place, mesh)) {
    return false;
  }
  if (use.is_unlit) {
    document_.Warn(place, "an unlit material does not show the colours of vertices");
    return true;
  }
  if (!ReadAttribute(document_, primitive, place, {"COLOR_0", 3, 4}, count, &mesh->colours)) {
    return false;
  }
  for (glm::vec3& colour : mesh->colours) colour = VertexColour(colour);
  return true;
}

// Of colours that have an alpha. Where all are opaque the mesh has none.
bool GltfMeshes::ReadAlphas(const tinygltf::Primitive& primitive, int colours,
                            const std::string& place, Mesh* mesh) {
  const auto numbers = ReadAccessor(document_, colours, 3, 4);
  if (!numbers) return false;
  if (numbers->components < 4) return true;
  std::vector<float> alphas;
  bool is_opaque = true;
  for (std::size_t i = 3; i < numbers->values.size(); i += 4) {
    const double alpha = numbers->values[i];
    if (std::isnan(alpha))
      document_.Warn(place, "a number is not finite", fmt::format("COLOR_0 {}", i / 4));
    const double share = std::isnan(alpha) ? 1 : std::clamp(alpha, 0.0, 1.0);
    is_opaque = is_opaque && share == 1;
    alphas.push_back(static_cast<float>(share));
  }
  if (is_opaque || alphas.size() != mesh->positions.size()) return true;
  mesh->alphas = std::move(alphas);
  materials_.ShowAlpha(primitive.material);
  return true;
}

// Triangles of corners that are no vertices are left out.
bool GltfMeshes::ReadTriangles(const tinygltf::Primitive& primitive, const std::string& place,
                               Mesh* mesh) {
  std::vector<std::uint32_t> corners;
  if (!ReadCorners(primitive, mesh->positions.size(), &corners)) return false;
  const int mode = primitive.mode < 0 ? TINYGLTF_MODE_TRIANGLES : primitive.mode;
  if (mode == TINYGLTF_MODE_TRIANGLES && corners.size() % 3 != 0) {
    document_.Warn(place, "corners are left over that make no triangle");
  }
  const auto is_sound = [&](std::uint32_t corner) {
    if (corner >= mesh->positions.size()) return false;
    const glm::vec3& p = mesh->positions[corner];
    return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
  };
  for (std::size_t i = 0; i + 2 < corners.size(); i += mode == TINYGLTF_MODE_TRIANGLES ? 3 : 1) {
    const std::size_t odd = mode == TINYGLTF_MODE_TRIANGLE_STRIP && i % 2 ? 1 : 0;
    const std::size_t first = mode == TINYGLTF_MODE_TRIANGLE_FAN ? 0 : i;
    const std::array<std::uint32_t, 3> triangle{corners[first], corners[i + 1 + odd],
                                                corners[i + 2 - odd]};
    if (std::all_of(triangle.begin(), triangle.end(), is_sound)) {
      mesh->triangles.push_back(triangle);
    } else {
      document_.LeaveOut(place, "a triangle has a corner that is no vertex",
                         fmt::format("triangle {} of {} vertices", i, mesh->positions.size()));
    }
  }
  // No triangle uses them.
  for (std::uint32_t v = 0; v < mesh->positions.size(); ++v) {
    if (!is_sound(v)) mesh->positions[v] = glm::vec3(0.0f);
  }
  return true;
}

// Whatever is no index becomes the largest there is, which no vertex has.
bool GltfMeshes::ReadCorners(const tinygltf::Primitive& primitive, std::size_t vertices,
                             std::vector<std::uint32_t>* out) {
  if (primitive.indices < 0) {
    for (std::uint32_t i = 0; i < vertices; ++i) out->push_back(i);
    return true;
  }
  const auto numbers = ReadAccessor(document_, primitive.indices, 1, 1);
  if (!numbers) return false;
  for (const double value : numbers->values) {
    const bool is_index =
        value >= 0 && value < static_cast<double>(vertices) && value == std::floor(value);
    out->push_back(is_index ? static_cast<std::uint32_t>(value) : 0xffffffffu);
  }
  return true;
}

}  // namespace sheaf
