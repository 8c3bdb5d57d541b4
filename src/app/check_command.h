// `sheaf check`: is this scene sound, and what of it would be skipped?
#ifndef SHEAF_APP_CHECK_COMMAND_H_
#define SHEAF_APP_CHECK_COMMAND_H_

#include <string>
#include <vector>

#include "sheaf/error.h"
#include "src/app/exit_code.h"
#include "src/app/open_scene.h"

namespace CLI {
class App;
}

namespace sheaf {

struct CheckRequest {
  SceneOptions options;
  std::vector<std::string> scenes;
  bool json = false;
};

// Adds the subcommand; parsing then fills `request`, which has to outlive `app`.
CLI::App* AddCheckCommand(CLI::App& app, CheckRequest& request);

// Reads every scene, also after a bad one, and prints the errors; the code is that of the first.
Result<ExitCode> RunCheck(const CheckRequest& request);

}  // namespace sheaf

#endif  // SHEAF_APP_CHECK_COMMAND_H_
