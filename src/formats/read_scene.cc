#include "src/formats/read_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <new>

#include "src/formats/file_ending.h"
#include "src/formats/gltf.h"
#include "src/formats/nff.h"
#include "src/formats/obj.h"
#include "src/formats/ply.h"
#include "src/formats/printable.h"
#include "src/formats/read_file.h"
#include "src/formats/scene_json.h"

namespace sheaf {
namespace {

namespace fs = std::filesystem;

enum class Format { kJson, kNff, kObj, kPly, kGltf };

std::optional<Format> FormatOf(const std::string& path) {
  const std::string ending = FileEnding(path);
  if (ending == ".json") return Format::kJson;
  if (ending == ".nff") return Format::kNff;
  if (ending == ".obj") return Format::kObj;
  if (ending == ".ply") return Format::kPly;
  if (ending == ".gltf" || ending == ".glb") return Format::kGltf;
  return std::nullopt;
}

fs::path Canonical(const fs::path& path) {
  std::error_code error;
  const fs::path canonical = fs::weakly_canonical(path, error);
  return error ? fs::absolute(path, error).lexically_normal() : canonical;
}

void AddKeyLight(Scene* scene) {
  Light light;
  light.name = "key";
  light.intensity = 0.8;
  scene->lights.push_back(light);
  AimKeyLight(scene);
  scene->settings.ambient = Colour(1.0);
  scene->settings.background = Colour(0.8, 0.84, 0.9);
}

KeyLight Complete(Scene* scene) {
  if (scene->cameras.empty()) {
    const Bounds bounds = BoundsOf(*scene).value_or(Bounds{Vec3d(-1), Vec3d(1)});
    scene->cameras.push_back(CameraThatFrames(bounds, {0, 1, 0}));
  }
  if (!scene->lights.empty()) return KeyLight::kAbsent;
  AddKeyLight(scene);
  return KeyLight::kAdded;
}

}  // namespace

SceneFiles::SceneFiles(const std::string& scene, const ReadOptions& options)
    : options_(options), root_(Canonical(fs::path(scene).parent_path() / ".")), paths_{scene} {}

Result<std::string> SceneFiles::Resolve(const std::string& from, const std::string& reference) {
  if (reference.empty() || reference.find('\0') != std::string::npos) {
    return Error{ErrorKind::kScene, "no name of a file"};
  }
  const fs::path path = fs::path(from).parent_path() / reference;  // an absolute one stays
  if (options_.outside == Outside::kRefused) {
    const fs::path within = Canonical(path).lexically_relative(root_);
    if (within.empty() || *within.begin() == "..") {
      return Error{ErrorKind::kScene, "lies outside the scene's folder (see --allow-outside)"};
    }
  }
  paths_.push_back(path.string());
  return path.string();
}

bool SceneFiles::Enter(const std::string& path) {
  const fs::path canonical = Canonical(path);
  if (std::find(open_.begin(), open_.end(), canonical) != open_.end()) return false;
  open_.push_back(canonical);
  return true;
}

void SceneFiles::Warn(std::string line) {
  if (std::find(warnings_.begin(), warnings_.end(), line) == warnings_.end()) {
    warnings_.push_back(std::move(line));
  }
}

bool IsScenePath(const std::string& path) { return FormatOf(path).has_value(); }
bool IsModelPath(const std::string& path) {
  return IsScenePath(path) && FormatOf(path) != Format::kJson;
}

Material PlainMaterial() {
  Material material;
  material.name = "grey";
  material.base_colour = Colour(0.7);
  material.ambient = kModelAmbient;
  material.kd = 1;
  return material;
}

Result<Scene> ReadModel(const std::string& path, SceneFiles& files) {
  Result<std::string> text = ReadWholeFile(path);
  if (!text) return text.error();
  switch (FormatOf(path).value_or(Format::kJson)) {
    case Format::kNff:
      return ParseNff(text.value(), path, files.options().cone_sides);
    case Format::kObj:
      return ParseObj(text.value(), path, files);
    case Format::kGltf:
      return ParseGltf(text.value(), path, files);
    case Format::kPly: {
      Result<Mesh> mesh = ParsePly(text.value(), path);
      if (!mesh) return mesh.error();
      Scene scene;
      scene.materials.push_back(PlainMaterial());
      if (!mesh.value().colours.empty()) scene.materials[0].base_colour = Colour(1.0);
      scene.objects.push_back({"", std::move(mesh).value(), 0});
      return scene;
    }
    case Format::kJson:
      break;
  }
  return SceneError(path, "unknown format; the name must end in .nff, .obj, .ply, .gltf or .glb");
}

Result<ReadSceneResult> ReadScene(const std::string& path, const ReadOptions& options) {
  try {
    SceneFiles files(path, options);
    files.Enter(path);
    Result<Scene> scene = IsModelPath(path) ? ReadModel(path, files) : ReadSceneJson(path, files);
    if (!scene) return scene.error();
    KeyLight key_light = KeyLight::kAbsent;
    if (IsModelPath(path)) {
      key_light = Complete(&scene.value());
      // Models of today are made for displays; Haines' are older than that.
      if (FormatOf(path) != Format::kNff) scene.value().settings.transfer = Transfer::kSrgb;
    }
    return ReadSceneResult{std::move(scene).value(), key_light, files.warnings(), files.paths()};
  } catch (const std::bad_alloc&) {
    return InputError(path, "not enough memory to read the file");
  }
}

void AimKeyLight(Scene* scene) {
  const Camera& camera = scene->cameras.front();
  const Vec3d ahead = glm::normalize(camera.look_at - camera.eye);
  const Vec3d right = glm::normalize(glm::cross(ahead, camera.up));
  const Vec3d up = glm::cross(right, ahead);
  scene->lights.front().source = DirectionalLight{ahead + 0.6 * right - 0.9 * up};
}

Camera CameraThatFrames(const Bounds& bounds, const Vec3d& up) {
  Camera camera;
  camera.name = "default";
  // Of a model at the very limit neither point lies where no scene may have one.
  const auto within = [](const Vec3d& p) { return glm::clamp(p, -kMaxCoordinate, kMaxCoordinate); };
  camera.look_at = within((bounds.min + bounds.max) * 0.5);
  camera.up = up;
  constexpr double kFov = 40, kSine = 0.34202014332566873;  // of half of it
  const double radius = std::max(glm::length(bounds.max - bounds.min) * 0.5, 1e-6);
  const Vec3d away = glm::normalize(Vec3d(0.45, 0.35, 1));
  camera.eye = within(camera.look_at + away * (radius / kSine));
  camera.projection = Perspective{kFov};
  return camera;
}

}  // namespace sheaf
