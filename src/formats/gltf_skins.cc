#include "src/formats/gltf_skins.h"

#include <fmt/format.h>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <utility>

#include "src/formats/gltf_accessors.h"

namespace sheaf {
namespace {

Transform MatrixAt(const std::vector<double>& values, std::size_t index) {
  const auto at = [&](int column, int row) {
    return values[16 * index + static_cast<std::size_t>(4 * column + row)];
  };
  Transform matrix;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) matrix.linear[column][row] = at(column, row);
    matrix.translation[row] = at(3, row);
  }
  return matrix;
}

// Takes normals along: of any length, and on the same side where the map mirrors.
glm::dmat3 NormalMatrix(const glm::dmat3& m) {
  const glm::dmat3 cofactors(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]),
                             glm::cross(m[0], m[1]));
  return glm::dot(m[0], cofactors[0]) < 0 ? -cofactors : cofactors;
}

// One set of joints and weights, four a vertex; empty where the primitive has no such set.
struct Influences {
  GltfNumbers joints, weights;
};

// False with a fault.
bool ReadInfluences(GltfDocument& document, const tinygltf::Primitive& primitive,
                    const std::string& place, int set, std::size_t vertices, Influences* out) {
  const auto joints = primitive.attributes.find(fmt::format("JOINTS_{}", set));
  const auto weights = primitive.attributes.find(fmt::format("WEIGHTS_{}", set));
  if (joints == primitive.attributes.end() || weights == primitive.attributes.end()) return true;
  auto indices = ReadAccessor(document, joints->second, 4, 4);
  auto shares = indices ? ReadAccessor(document, weights->second, 4, 4) : std::nullopt;
  if (!shares) return false;
  if (indices->count() != vertices || shares->count() != vertices) {
    return document.Fail(place, fmt::format("joints and weights of {} and {} vertices of {}",
                                            indices->count(), shares->count(), vertices));
  }
  *out = {*std::move(indices), *std::move(shares)};
  return true;
}

}  // namespace

std::optional<std::vector<Transform>> ReadJoints(GltfDocument& document, int skin,
                                                 const std::vector<Transform>& globals) {
  const auto& skins = document.model().skins;
  const std::string place = fmt::format("/skins/{}", skin);
  if (!IsIndexOf(skin, skins)) {
    document.Fail(place, fmt::format("there are {} skins", skins.size()));
    return std::nullopt;
  }
  const tinygltf::Skin& from = skins[static_cast<std::size_t>(skin)];
  std::optional<GltfNumbers> inverse_bind;
  if (from.inverseBindMatrices >= 0) {
    inverse_bind = ReadAccessor(document, from.inverseBindMatrices, 16, 16);
    if (!inverse_bind) return std::nullopt;
    if (inverse_bind->count() < from.joints.size()) {
      document.Fail(place, fmt::format("{} matrices for {} joints", inverse_bind->count(),
                                       from.joints.size()));
      return std::nullopt;
    }
  }
  std::vector<Transform> joints;
  for (std::size_t i = 0; i < from.joints.size(); ++i) {
    if (!IsIndexOf(from.joints[i], globals)) {
      document.Fail(place, fmt::format("node {} of {}", from.joints[i], globals.size()));
      return std::nullopt;
    }
    const Transform& global = globals[static_cast<std::size_t>(from.joints[i])];
    joints.push_back(inverse_bind ? global * MatrixAt(inverse_bind->values, i) : global);
  }
  return joints;
}

bool ApplySkin(GltfDocument& document, const tinygltf::Primitive& primitive,
               const std::string& place, const std::vector<Transform>& joints, Mesh* mesh) {
  const std::size_t vertices = mesh->positions.size();
  std::vector<Influences> sets;
  for (int set = 0;; ++set) {
    Influences influences;
    if (!ReadInfluences(document, primitive, place, set, vertices, &influences)) return false;
    if (influences.joints.values.empty()) break;
    sets.push_back(std::move(influences));
  }
  for (std::size_t v = 0; v < vertices; ++v) {
    Transform sum{glm::dmat3(0.0), Vec3d(0.0)};
    double total = 0;
    for (const Influences& influences : sets) {
      for (std::size_t k = 4 * v; k < 4 * v + 4; ++k) {
        const double weight = influences.weights.values[k], joint = influences.joints.values[k];
        if (weight == 0) continue;
        if (!(joint >= 0 && joint < static_cast<double>(joints.size()))) {
          return document.Fail(place, fmt::format("joint {} of {}", joint, joints.size()));
        }
        const Transform& moved = joints[static_cast<std::size_t>(joint)];
        sum.linear += weight * moved.linear;
        sum.translation += weight * moved.translation;
        total += weight;
      }
    }
    if (!(total > 0)) continue;  // a vertex without weights stays where it is
    // Weights are to add up to 1; bytes often miss it by a little.
    mesh->positions[v] =
        glm::vec3((sum.linear * Vec3d(mesh->positions[v]) + sum.translation) / total);
    if (!mesh->normals.empty()) {
      const Vec3d turned = NormalMatrix(sum.linear / total) * Vec3d(mesh->normals[v]);
      const double length = glm::length(turned);
      mesh->normals[v] = length > 0 ? glm::vec3(turned / length) : glm::vec3(0.0f);
    }
  }
  return true;
}

bool ApplyMorph(GltfDocument& document, const tinygltf::Primitive& primitive,
                const std::string& place, const std::vector<double>& weights, Mesh* mesh) {
  const auto add = [&](int accessor, double weight, std::vector<glm::vec3>& to) {
    const auto numbers = ReadAccessor(document, accessor, 3, 3);
    if (!numbers) return false;
    if (numbers->count() != to.size()) {
      return document.Fail(
          place, fmt::format("a morph target of {} vertices of {}", numbers->count(), to.size()));
    }
    for (std::size_t i = 0; i < to.size(); ++i) {
      const Vec3d step(numbers->values[3 * i], numbers->values[3 * i + 1],
                       numbers->values[3 * i + 2]);
      to[i] = glm::vec3(Vec3d(to[i]) + weight * step);
    }
    return true;
  };
  for (std::size_t t = 0; t < primitive.targets.size() && t < weights.size(); ++t) {
    if (weights[t] == 0) continue;
    for (const auto& [name, accessor] : primitive.targets[t]) {
      if (name == "POSITION") {
        if (!add(accessor, weights[t], mesh->positions)) return false;
      } else if (name == "NORMAL" && !mesh->normals.empty()) {
        if (!add(accessor, weights[t], mesh->normals)) return false;
      } else if (name != "NORMAL" && name != "TANGENT") {
        document.Warn(place, "morph targets move positions and normals alone", name);
      }
    }
  }
  return true;
}

}  // namespace sheaf
