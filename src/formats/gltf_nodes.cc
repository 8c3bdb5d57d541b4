#include "src/formats/gltf_nodes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <set>
#include <utility>

#include "src/formats/gltf_skins.h"
#include "src/formats/printable.h"
#include "src/scene/affine_map.h"

namespace sheaf {
namespace {

constexpr int kMaxNodeDepth = 1024;
constexpr double kPi = 3.14159265358979323846;
constexpr double kDegrees = 57.295779513082320877;  // of a radian

Transform LocalTransform(const tinygltf::Node& node) {
  Transform local;
  if (node.matrix.size() == 16) {
    for (int column = 0; column < 3; ++column) {
      for (int row = 0; row < 3; ++row) {
        local.linear[column][row] = node.matrix[static_cast<std::size_t>(4 * column + row)];
      }
    }
    local.translation = {node.matrix[12], node.matrix[13], node.matrix[14]};
    return local;
  }
  if (node.rotation.size() == 4) {
    local.linear = TurnOf(node.rotation[0], node.rotation[1], node.rotation[2], node.rotation[3]);
  }
  if (node.scale.size() == 3) {
    for (int axis = 0; axis < 3; ++axis) {
      local.linear[axis] *= node.scale[static_cast<std::size_t>(axis)];
    }
  }
  if (node.translation.size() == 3) {
    local.translation = {node.translation[0], node.translation[1], node.translation[2]};
  }
  return local;
}

bool IsInRange(const Transform& transform) {
  for (int axis = 0; axis < 3; ++axis) {
    for (int k = 0; k < 3; ++k) {
      if (!(std::abs(transform.linear[axis][k]) <= kMaxCoordinate &&
            std::abs(transform.translation[k]) <= kMaxCoordinate)) {
        return false;
      }
    }
  }
  return true;
}

}  // namespace

bool GltfNodes::Read() {
  std::vector<int> roots;
  if (!FindRoots(&roots)) return false;
  const auto& nodes = document_.model().nodes;
  visited_.assign(nodes.size(), false);
  globals_.assign(nodes.size(), Transform{});
  for (const int root : roots) {
    if (!Visit(root, Transform{}, 0)) return false;
  }
  for (const int index : order_) {
    const tinygltf::Node& node = nodes[static_cast<std::size_t>(index)];
    if (node.mesh < 0) continue;
    auto places = ReadPlaces(document_, node, fmt::format("/nodes/{}", index));
    if (!places) return false;
    shared_.Count(node, places->size());
    places_[index] = std::move(*places);
  }
  // Skins need the transforms of all their joints, wherever these stand.
  for (const int index : order_) {
    const tinygltf::Node& node = nodes[static_cast<std::size_t>(index)];
    const Transform& transform = globals_[static_cast<std::size_t>(index)];
    const std::string place = fmt::format("/nodes/{}", index);
    if (node.mesh >= 0 && !AddMesh(index, place, transform)) return false;
    if (node.camera >= 0 && !AddCamera(node, place, transform)) return false;
    if (!AddLight(node, place, transform)) return false;
  }
  return true;
}

// Those of the default scene; without any scene the nodes that are no node's child.
bool GltfNodes::FindRoots(std::vector<int>* roots) {
  const tinygltf::Model& model = document_.model();
  if (!model.scenes.empty()) {
    const int scene = std::max(model.defaultScene, 0);
    if (!IsIndexOf(scene, model.scenes)) {
      return document_.Fail("/scene", fmt::format("scene {} of {}", scene, model.scenes.size()));
    }
    *roots = model.scenes[static_cast<std::size_t>(scene)].nodes;
    return true;
  }
  std::set<int> children;
  for (const auto& node : model.nodes) {
    children.insert(node.children.begin(), node.children.end());
  }
  for (int i = 0; i < static_cast<int>(model.nodes.size()); ++i) {
    if (!children.contains(i)) roots->push_back(i);
  }
  return true;
}

bool GltfNodes::Visit(int index, const Transform& parent, int depth) {
  const std::string place = fmt::format("/nodes/{}", index);
  const auto& nodes = document_.model().nodes;
  if (!IsIndexOf(index, nodes)) {
    return document_.Fail(place, fmt::format("there are {} nodes", nodes.size()));
  }
  const auto i = static_cast<std::size_t>(index);
  // Nodes form trees: whoever is met twice has two parents, or is its own ancestor.
  if (visited_[i])
    return document_.Fail(place, "the node is met twice: nodes must not form cycles");
  visited_[i] = true;
  if (depth > kMaxNodeDepth) return document_.Fail(place, "nodes nest too deep");
  const tinygltf::Node& node = nodes[i];
  const Transform transform = parent * LocalTransform(node);
  if (!IsInRange(transform)) {
    return document_.Fail(place, "its transform is not finite, or beyond 1e30");
  }
  globals_[i] = transform;
  order_.push_back(index);
  for (const int child : node.children) {
    if (!Visit(child, transform, depth + 1)) return false;
  }
  return true;
}

// Of a skin's mesh the node's own transform does not count: the joints say where it is.
bool GltfNodes::AddMesh(int index, const std::string& place, const Transform& transform) {
  const tinygltf::Node& node = document_.model().nodes[static_cast<std::size_t>(index)];
  if (node.skin < 0) {
    for (const Transform& within : places_[index]) {
      if (!AddPlace(node, place, transform * within)) return false;
    }
    return true;
  }
  const auto known = joints_.find(node.skin);
  if (known != joints_.end()) return meshes_.Add(node, transform, known->second);
  auto joints = ReadJoints(document_, node.skin, globals_);
  if (!joints) return false;
  const auto& skin = document_.model().skins[static_cast<std::size_t>(node.skin)];
  for (const int joint : skin.joints) {
    if (visited_[static_cast<std::size_t>(joint)]) continue;
    document_.Warn(place, "a joint is not in the scene, and stands at its origin");
  }
  return meshes_.Add(node, transform, joints_[node.skin] = std::move(joints));
}

// An instance where that takes less than a copy, and a copy where a transform flattens.
bool GltfNodes::AddPlace(const tinygltf::Node& node, const std::string& place,
                         const Transform& transform) {
  if (!IsInRange(transform)) {
    return document_.Fail(place, "its transform is not finite, or beyond 1e30");
  }
  if (!shared_.IsShared(node) || !FaultOf(MapOf(transform)).empty()) {
    return meshes_.Add(node, transform, std::nullopt);
  }
  const auto [known, is_new] = groups_.try_emplace(node.mesh);
  if (is_new) {
    std::vector<Object> others = std::exchange(scene_.objects, {});
    if (!meshes_.Add(node, Transform{}, std::nullopt)) return false;
    known->second = static_cast<std::uint32_t>(scene_.groups.size());
    const auto& mesh = document_.model().meshes[static_cast<std::size_t>(node.mesh)];
    scene_.groups.push_back({mesh.name, std::exchange(scene_.objects, std::move(others)), {}});
  }
  scene_.instances.push_back({node.name, known->second, transform.linear, transform.translation});
  if (scene_.instances.size() <= kMaxInstances) return true;
  return document_.Fail(place, fmt::format("more than {} instances", kMaxInstances));
}

std::string GltfNodes::FreeName(const std::string& wanted) const {
  const std::string base = wanted.empty() ? "camera" : wanted;
  std::string name = base;
  const auto is_taken = [&] {
    return std::any_of(scene_.cameras.begin(), scene_.cameras.end(),
                       [&](const Camera& camera) { return camera.name == name; });
  };
  for (int i = 2; is_taken(); ++i) name = fmt::format("{} {}", base, i);
  return name;
}

bool GltfNodes::AddCamera(const tinygltf::Node& node, const std::string& place,
                          const Transform& transform) {
  const auto& cameras = document_.model().cameras;
  if (!IsIndexOf(node.camera, cameras)) {
    return document_.Fail(place, fmt::format("camera {} of {}", node.camera, cameras.size()));
  }
  const tinygltf::Camera& from = cameras[static_cast<std::size_t>(node.camera)];
  const std::string camera_place = fmt::format("/cameras/{}", node.camera);
  Camera camera;
  camera.name = FreeName(node.name.empty() ? from.name : node.name);
  camera.eye = transform.translation;
  const Vec3d ahead = transform.Vector({0, 0, -1});
  camera.up = transform.Vector({0, 1, 0});
  if (!(glm::length(glm::cross(ahead, camera.up)) > 0)) {
    return document_.Fail(place, "the node's transform leaves its camera no direction");
  }
  camera.look_at = camera.eye + ahead;
  if (from.type == "orthographic") {
    const double height = 2 * from.orthographic.ymag;
    if (!(height > 0 && height <= kMaxCoordinate)) {
      return document_.Fail(camera_place, "ymag is not above 0");
    }
    camera.projection = Orthographic{height};
  } else {
    const double fov = from.perspective.yfov * kDegrees;
    if (!(fov > 0 && fov < 180))
      return document_.Fail(camera_place, "yfov is not between 0 and pi");
    camera.projection = Perspective{fov};
  }
  scene_.cameras.push_back(camera);
  return true;
}

bool GltfNodes::AddLight(const tinygltf::Node& node, const std::string& place,
                         const Transform& transform) {
  const auto extension = node.extensions.find("KHR_lights_punctual");
  if (extension == node.extensions.end() || !extension->second.Has("light")) return true;
  const int index = extension->second.Get("light").GetNumberAsInt();
  const auto& lights = document_.model().lights;
  if (!IsIndexOf(index, lights)) {
    return document_.Fail(place, fmt::format("light {} of {}", index, lights.size()));
  }
  const tinygltf::Light& from = lights[static_cast<std::size_t>(index)];
  const std::string light_place = fmt::format("/extensions/KHR_lights_punctual/lights/{}", index);
  Light light;
  light.name = node.name.empty() ? from.name : node.name;
  for (std::size_t c = 0; c < 3 && c < from.color.size(); ++c) {
    light.colour[static_cast<int>(c)] = from.color[c];
  }
  // Candela and lux: a matt white surface under E lux shines with E / pi candela a square metre.
  light.intensity = from.intensity / kPi;
  for (const double number : {from.intensity, light.colour.x, light.colour.y, light.colour.z}) {
    if (!(number >= 0 && number <= 1e12)) {
      return document_.Fail(light_place, "its colour or intensity is not in [0, 1e12]");
    }
  }
  if (from.range > 0) document_.Warn(light_place, "the range of a light is not read");
  const Vec3d direction = transform.Vector({0, 0, -1});
  if (!(glm::length(direction) > 0)) {
    return document_.Fail(place, "the transform leaves no direction");
  }
  if (!ReadSource(from, light_place, transform.translation, direction, &light)) return false;
  // Such numbers are those of lamps and suns: a picture needs an exposure.
  scene_.settings.ev.reset();
  scene_.lights.push_back(light);
  return true;
}

bool GltfNodes::ReadSource(const tinygltf::Light& from, const std::string& place,
                           const Vec3d& position, const Vec3d& direction, Light* light) {
  if (from.type == "directional") {
    light->source = DirectionalLight{direction};
    return true;
  }
  if (from.type != "point" && from.type != "spot") {
    return document_.Fail(place, fmt::format("unknown type \"{}\"", Printable(from.type, 40)));
  }
  PointLight point{position, {}};
  if (from.type == "spot") {
    Cone cone{direction, from.spot.innerConeAngle * kDegrees, from.spot.outerConeAngle * kDegrees};
    // Radians of the whole quarter turn, rounded, may come to a little more than 90 degrees.
    if (cone.outer < 90.0001) cone.outer = std::min(cone.outer, 90.0);
    if (!(cone.inner >= 0 && cone.inner < cone.outer && cone.outer <= 90)) {
      return document_.Fail(place, "its cone needs 0 <= inner < outer <= pi / 2");
    }
    point.cone = cone;
  }
  light->source = point;
  return true;
}

}  // namespace sheaf
