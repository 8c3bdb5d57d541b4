// `sheaf pareto`: run time against error over the settings that trade one for the other.
#ifndef SHEAF_APP_PARETO_COMMAND_H_
#define SHEAF_APP_PARETO_COMMAND_H_

#include <optional>
#include <string>
#include <vector>

#include "sheaf/error.h"
#include "src/app/choose.h"
#include "src/app/open_scene.h"
#include "src/app/parse_options.h"

namespace CLI {
class App;
}

namespace sheaf {

// The command line as it was given.
struct ParetoRequest {
  SceneOptions options;
  std::string scene;
  CameraChoice choice;
  std::optional<PixelSize> size;
  std::string output;  // a folder; made where it is not there
  std::optional<int> reference_samples, repetitions, threads;
  std::optional<double> error, time;
  bool quiet = false;
};

CLI::App* AddParetoCommand(CLI::App& app, ParetoRequest& request);

Status RunPareto(const ParetoRequest& request);

}  // namespace sheaf

#endif  // SHEAF_APP_PARETO_COMMAND_H_
