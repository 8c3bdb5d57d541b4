// `sheaf convert`: scenes into scene JSON, pictures into another format.
#ifndef SHEAF_APP_CONVERT_COMMAND_H_
#define SHEAF_APP_CONVERT_COMMAND_H_

#include <optional>
#include <string>

#include "sheaf/error.h"
#include "src/app/open_scene.h"

namespace CLI {
class App;
}

namespace sheaf {

struct ConvertRequest {
  SceneOptions options;
  std::string input, output;
  std::optional<int> bits;
  std::optional<std::string> transfer;  // keep, if absent
};

// Adds the subcommand; parsing then fills `request`, which has to outlive `app`.
CLI::App* AddConvertCommand(CLI::App& app, ConvertRequest& request);

Status RunConvert(const ConvertRequest& request);

}  // namespace sheaf

#endif  // SHEAF_APP_CONVERT_COMMAND_H_
