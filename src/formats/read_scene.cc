#include "src/formats/read_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <iterator>
#include <new>
#include <utility>

#include "src/formats/format_table.h"
#include "src/formats/printable.h"
#include "src/formats/read_file.h"
#include "src/formats/scene_json.h"

namespace sheaf {
namespace {

// A light of a studio, and where it stands beside the camera: right, up and behind it.
struct StudioLight {
  const char* name;
  double intensity;
  Vec3d place;
  bool casts_shadows;
};
// The first falls over the left shoulder; the second lifts its shadows; the third draws the upper
// edge from behind.
constexpr StudioLight kStudio[] = {{"key", 0.75, {-0.6, 0.9, 1.0}, true},
                                   {"fill", 0.15, {1.0, 0.2, 0.8}, false},
                                   {"rim", 0.3, {0.4, 0.8, -1.0}, true}};

void AddStudio(Scene* scene) {
  for (const StudioLight& studio : kStudio) {
    Light light;
    light.name = studio.name;
    light.intensity = studio.intensity;
    light.casts_shadows = studio.casts_shadows;
    scene->lights.push_back(light);
  }
  AimStudio(scene);
  scene->settings.ambient = Colour(1.0);
  scene->settings.background = Colour(0.8, 0.84, 0.9);
  scene->settings.environment =
      Gradient{{0.42, 0.5, 0.62}, scene->settings.background, {0.5, 0.48, 0.46}};
}

KeyLight Complete(Scene* scene, double aspect) {
  if (scene->cameras.empty()) {
    const Bounds bounds = BoundsOf(*scene).value_or(Bounds{Vec3d(-1), Vec3d(1)});
    scene->cameras.push_back(CameraThatFrames(bounds, {0, 1, 0}, aspect));
  }
  if (!scene->lights.empty()) return KeyLight::kAbsent;
  AddStudio(scene);
  return KeyLight::kAdded;
}

// Whether it begins with a brace or a comment. Files without an ending may be scenes all the same.
bool LooksLikeJson(const std::string& text) {
  const std::size_t first = text.find_first_not_of("\xEF\xBB\xBF \t\r\n");
  return first != std::string::npos && (text[first] == '{' || text[first] == '/');
}

}  // namespace

bool IsScenePath(const std::string& path) {
  const FileFormat* format = FormatOf(path);
  return format != nullptr && format->content != FileContent::kPicture;
}

bool IsModelPath(const std::string& path) {
  const FileFormat* format = FormatOf(path);
  return format != nullptr && format->content == FileContent::kModel;
}

Material PlainMaterial() {
  Material material;
  material.name = "grey";
  material.base_colour = Colour(0.7);
  material.ambient = kModelAmbient;
  material.kd = 1;
  return material;
}

Result<Scene> ReadSceneFile(const std::string& path, SceneFiles& files) {
  const FormatRow* row = FindFormat(path);
  const bool is_known = row != nullptr && row->parse != nullptr;
  const Result<std::string> text = ReadWholeFile(path, is_known ? row->max_bytes : kMaxTextBytes);
  if (!text) return text.error();
  if (is_known) return row->parse(text.value(), path, files);
  if (LooksLikeJson(text.value())) return ParseSceneJson(text.value(), path, files);
  return Error{ErrorKind::kScene,
               fmt::format("{}: {}; a scene's name ends in {}", PrintablePath(path),
                           row != nullptr ? "a picture" : "of no known format", SceneEndings())};
}

Result<ReadSceneResult> ReadScene(const std::string& path, const ReadOptions& options) {
  try {
    SceneFiles files(path, options);
    files.Enter(path);
    Result<Scene> scene = ReadSceneFile(path, files);
    if (!scene) return scene.error();
    KeyLight key_light = KeyLight::kAbsent;
    if (IsModelPath(path)) {
      const Settings& settings = scene.value().settings;
      const double usual = static_cast<double>(settings.width) / settings.height;
      key_light = Complete(&scene.value(), options.aspect.value_or(usual));
      scene.value().settings.transfer = FindFormat(path)->model_transfer;
    }
    return ReadSceneResult{std::move(scene).value(), key_light, files.warnings().Lines(),
                           files.paths()};
  } catch (const std::bad_alloc&) {
    return InputError(path, "not enough memory to read the file");
  }
}

void AimStudio(Scene* scene) {
  const Camera& camera = scene->cameras.front();
  const Vec3d ahead = glm::normalize(camera.look_at - camera.eye);
  const Vec3d right = glm::normalize(glm::cross(ahead, camera.up));
  const Vec3d up = glm::cross(right, ahead);
  for (std::size_t i = 0; i < std::size(kStudio); ++i) {
    const Vec3d& place = kStudio[i].place;
    scene->lights[i].source = DirectionalLight{place.z * ahead - place.x * right - place.y * up};
  }
}

Camera CameraThatFrames(const Bounds& bounds, const Vec3d& up, double aspect) {
  Camera camera;
  camera.name = "default";
  // Of a model at the very limit neither point lies where no scene may have one.
  const auto within = [](const Vec3d& p) { return glm::clamp(p, -kMaxCoordinate, kMaxCoordinate); };
  camera.look_at = within((bounds.min + bounds.max) * 0.5);
  camera.up = up;
  constexpr double kFov = 40, kSine = 0.34202014332566873,
                   kTangent = 0.36397023426620234;  // of half
  // A picture that is higher than wide has the narrower angle across.
  const double across = aspect * kTangent;
  const double sine = aspect < 1 ? across / std::sqrt(1 + across * across) : kSine;
  const double radius = std::max(glm::length(bounds.max - bounds.min) * 0.5, 1e-6);
  const Vec3d away = glm::normalize(Vec3d(0.45, 0.35, 1));
  camera.eye = within(camera.look_at + away * (radius / sine));
  camera.projection = Perspective{kFov};
  return camera;
}

}  // namespace sheaf
