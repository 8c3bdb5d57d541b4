// The scene or model that a command is about.
#ifndef SHEAF_APP_OPEN_SCENE_H_
#define SHEAF_APP_OPEN_SCENE_H_

#include <optional>
#include <string>
#include <vector>

#include "sheaf/error.h"
#include "sheaf/formats.h"
#include "sheaf/scene.h"
#include "src/formats/decoded_images.h"
#include "src/scene/bounds.h"

namespace CLI {
class App;
}

namespace sheaf {

enum class Floor { kNone, kUnderLoneModels };

// How a file becomes a scene: the options of every command that reads one.
struct SceneOptions {
  bool allow_outside = false;
  bool strict = false;  // warnings are errors
  std::optional<int> cone_sides;
  std::optional<Vec3d> eye, look_at;     // of the scene's first camera
  std::optional<Projection> projection;  // likewise
  std::optional<double> fov;             // likewise, degrees
  std::optional<double> time;  // seconds: the moment of animations and of cameras on paths
  double fps = 24;             // frames a second
  std::string animation;       // the one that counts, by name; empty: all
  // No options themselves. Of the pictures, width over height, where the command line gives their
  // size; a frame, instead of a time; degrees by which cameras are turned about the scene.
  std::optional<double> aspect, frame;
  double turn = 0;
  // Whether a lone model gets a floor for its shadow. No option itself: commands that show it ask.
  Floor floor = Floor::kNone;
};

void AddSceneOptions(CLI::App& app, SceneOptions& options);

// --time, --fps and --animation, of commands that show one moment.
void AddMomentOptions(CLI::App& app, SceneOptions& options);

// The name of one of these options that the command line has, if any.
std::optional<std::string> GivenSceneOption(const SceneOptions& options);

// The floor of a lone model.
struct Ground {
  Object disk;
  Material material;
};

struct OpenedScene {
  Scene scene;  // at the moment of the options
  std::vector<std::string> warnings;
  std::vector<std::string> files;  // that it was read from
  double duration = 0;             // seconds of its animations
  KeyLight key_light = KeyLight::kAbsent;
  // At rest, so that they are the same at all moments.
  std::vector<Camera> cameras;
  std::optional<Bounds> bounds;  // of what the file holds, where a frame is asked for
  std::optional<Ground> ground;
  DecodedImages images;  // for the next moment
};
Result<OpenedScene> OpenSceneWithWarnings(const std::string& path, const SceneOptions& options);

// Moves a scene that was opened from `path` to the moment of `options`, which differ from those it
// was opened with in that alone. Pointers into the scene end. Reads the file once more where it has
// animations.
Status PoseScene(const std::string& path, const SceneOptions& options, OpenedScene* opened);

// An error where there are warnings and they may not be.
Status CheckStrict(const std::string& path, const std::vector<std::string>& warnings,
                   const SceneOptions& options);

// A scene whose warnings are printed on stderr, or kept; errors in any case where they may not be.
enum class Verbosity { kWarnings, kErrorsOnly };
Result<OpenedScene> OpenSceneAndFiles(const std::string& path, const SceneOptions& options,
                                      Verbosity verbosity = Verbosity::kWarnings);
Result<Scene> OpenScene(const std::string& path, const SceneOptions& options,
                        Verbosity verbosity = Verbosity::kWarnings);

// A file that a command writes, and the option that asks for it.
struct Output {
  const char* option;
  std::string path;  // "-" and none at all are no file
};

// No output may replace a file that the same run reads, or another output. kUsage otherwise.
Status CheckOutputs(const std::vector<Output>& outputs, const std::vector<std::string>& inputs);

}  // namespace sheaf

#endif  // SHEAF_APP_OPEN_SCENE_H_
