// The scene or model that a command is about.
#ifndef SHEAF_APP_OPEN_SCENE_H_
#define SHEAF_APP_OPEN_SCENE_H_

#include <optional>
#include <string>
#include <vector>

#include "sheaf/error.h"
#include "sheaf/scene.h"

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
  // Of the pictures, width over height, where the command line gives their size. No option itself.
  std::optional<double> aspect;
  // Whether a lone model gets a floor for its shadow. No option itself: commands that show it ask.
  Floor floor = Floor::kNone;
};

void AddSceneOptions(CLI::App& app, SceneOptions& options);

// The name of one of these options that the command line has, if any.
std::optional<std::string> GivenSceneOption(const SceneOptions& options);

struct OpenedScene {
  Scene scene;
  std::vector<std::string> warnings;
  std::vector<std::string> files;  // that it was read from
};
Result<OpenedScene> OpenSceneWithWarnings(const std::string& path, const SceneOptions& options);

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
