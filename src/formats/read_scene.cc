#include "src/formats/read_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <new>
#include <utility>

#include "src/formats/format_table.h"
#include "src/formats/printable.h"
#include "src/formats/read_file.h"
#include "src/formats/scene_json.h"
#include "src/formats/studio.h"
#include "src/formats/suggest_name.h"

namespace sheaf {
namespace {

KeyLight Complete(Scene* scene, const ReadOptions& options) {
  if (scene->cameras.empty() && options.camera) scene->cameras.push_back(*options.camera);
  if (scene->cameras.empty()) {
    const double usual = static_cast<double>(scene->settings.width) / scene->settings.height;
    const double aspect = options.aspect.value_or(usual);
    scene->cameras.push_back(CameraThatFrames(*scene, {0, 1, 0}, aspect));
  }
  if (!scene->lights.empty()) return KeyLight::kAbsent;
  AddStudio(scene);
  scene->settings.samples = 4;
  scene->settings.contrast = 0.1;
  return KeyLight::kAdded;
}

// Whether some model of the scene has the animation that is asked for.
Status CheckAnimation(const std::string& path, const SceneFiles& files) {
  const std::string& name = files.options().animation;
  const std::vector<std::string>& known = files.animations();
  if (name.empty() || std::find(known.begin(), known.end(), name) != known.end()) return Done{};
  return SceneError(
      path, fmt::format("no animation \"{}\"{} ({})", Printable(name),
                        DidYouMean(name, {known.begin(), known.end()}),
                        known.empty()
                            ? "it has none"
                            : "it has: " + Printable(fmt::format("{}", fmt::join(known, ", ")))));
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
  DecodedImages images;
  return ReadScene(path, options, images);
}

Result<ReadSceneResult> ReadScene(const std::string& path, const ReadOptions& options,
                                  DecodedImages& images) {
  SceneFiles files(path, options, &images);
  files.Enter(path);
  Result<Scene> scene = ReadSceneFile(path, files);
  if (files.fault()) return *files.fault();
  if (!scene) return scene.error();
  if (const Status known = CheckAnimation(path, files); !known) return known.error();
  KeyLight key_light = KeyLight::kAbsent;
  if (IsModelPath(path)) {
    key_light = Complete(&scene.value(), options);
    scene.value().settings.transfer = FindFormat(path)->model_transfer;
  }
  return ReadSceneResult{std::move(scene).value(), key_light, files.warnings().Lines(),
                         files.paths(), files.duration()};
}

}  // namespace sheaf
