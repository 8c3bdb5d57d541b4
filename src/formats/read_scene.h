// Reads a scene or a model in any format that is known, by its ending.
#ifndef SHEAF_FORMATS_READ_SCENE_H_
#define SHEAF_FORMATS_READ_SCENE_H_

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sheaf/error.h"
#include "sheaf/scene.h"
#include "src/scene/bounds.h"

namespace sheaf {

// Whether a scene may name files outside the folder that it lies in.
enum class Outside { kRefused, kAllowed };

struct ReadOptions {
  Outside outside = Outside::kRefused;
  int cone_sides = 32;  // of the triangles that stand for cones and cylinders, [3, kMaxConeSides]
};
inline constexpr int kMaxConeSides = 1024;

// What readers share while one scene is read: which files they may open, which are open, and what
// they have to say.
class SceneFiles {
 public:
  SceneFiles(const std::string& scene, const ReadOptions& options);

  const ReadOptions& options() const { return options_; }

  // The path of `reference`, as the file `from` names it: relative to its folder. An error, without
  // a place, where it leaves the scene's folder and may not.
  Result<std::string> Resolve(const std::string& from, const std::string& reference);

  // Includes: false where `path` is being read already.
  bool Enter(const std::string& path);
  void Leave() { open_.pop_back(); }

  // What is left out or replaced, and harms no more than the picture: one line each, each once.
  void Warn(std::string line);
  const std::vector<std::string>& warnings() const { return warnings_; }

  // The scene itself and whatever was resolved.
  const std::vector<std::string>& paths() const { return paths_; }

 private:
  ReadOptions options_;
  std::filesystem::path root_;
  std::vector<std::filesystem::path> open_;
  std::vector<std::string> warnings_;
  std::vector<std::string> paths_;
};

// Whether some reader takes files with this ending: .json, .nff, .obj, .ply, .gltf or .glb, in any
// case.
bool IsScenePath(const std::string& path);
bool IsModelPath(const std::string& path);  // all but .json

// What the file holds and nothing more: a model may lack cameras, lights and materials of its own.
Result<Scene> ReadModel(const std::string& path, SceneFiles& files);

// What models without materials are made of: matt and grey. White ambient light shows a part of the
// colours of all models.
inline constexpr double kModelAmbient = 0.25;
Material PlainMaterial();

enum class KeyLight { kAbsent, kAdded };

struct ReadSceneResult {
  Scene scene;
  KeyLight key_light = KeyLight::kAbsent;  // kAdded: the scene's first light
  std::vector<std::string> warnings;
  std::vector<std::string> files;  // that it was read from
};

// A scene that can be rendered: a model without a camera gets one that frames it, without a light a
// key light and white ambient light before a bright background. A malformed file is kScene, with
// file and place; one that cannot be opened kInputOutput.
Result<ReadSceneResult> ReadScene(const std::string& path, const ReadOptions& options = {});

// Turns an added key light so that it shines over the left shoulder of the first camera.
void AimKeyLight(Scene* scene);

// The camera "default": looks at the middle of the box from the front, a little from the right and
// above, so that its sphere just fits.
Camera CameraThatFrames(const Bounds& bounds, const Vec3d& up);

}  // namespace sheaf

#endif  // SHEAF_FORMATS_READ_SCENE_H_
