// The scene or model that a command is about.
#ifndef SHEAF_APP_OPEN_SCENE_H_
#define SHEAF_APP_OPEN_SCENE_H_

#include <optional>
#include <string>
#include <vector>

#include "src/core/error.h"
#include "src/scene/scene.h"

namespace CLI {
class App;
}

namespace sheaf {

// How a file becomes a scene: the options of every command that reads one.
struct SceneOptions {
  bool allow_outside = false;
  std::optional<int> cone_sides;
  std::optional<Vec3d> eye, look_at;  // of the scene's first camera
  std::optional<double> fov;          // likewise, degrees
};

void AddSceneOptions(CLI::App& app, SceneOptions& options);

struct OpenedScene {
  Scene scene;
  std::vector<std::string> warnings;
};
Result<OpenedScene> OpenSceneWithWarnings(const std::string& path, const SceneOptions& options);

// The same; prints the warnings on stderr.
Result<Scene> OpenScene(const std::string& path, const SceneOptions& options);

}  // namespace sheaf

#endif  // SHEAF_APP_OPEN_SCENE_H_
