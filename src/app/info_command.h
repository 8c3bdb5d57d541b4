// `sheaf info`: what this build and this machine can do, and what a scene holds.
#ifndef SHEAF_APP_INFO_COMMAND_H_
#define SHEAF_APP_INFO_COMMAND_H_

#include <string>

#include "sheaf/error.h"
#include "src/app/open_scene.h"

namespace CLI {
class App;
}

namespace sheaf {

struct InfoRequest {
  SceneOptions options;
  std::string scene;  // empty: none
  bool json = false;
};

// Adds the subcommand; parsing then fills `request`, which has to outlive `app`.
CLI::App* AddInfoCommand(CLI::App& app, InfoRequest& request);

Status RunInfo(const InfoRequest& request);

}  // namespace sheaf

#endif  // SHEAF_APP_INFO_COMMAND_H_
