// What the command line of `sheaf compare` asks for.
#ifndef SHEAF_APP_COMPARE_REQUEST_H_
#define SHEAF_APP_COMPARE_REQUEST_H_

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "src/app/choose.h"
#include "src/app/open_scene.h"
#include "src/app/parse_options.h"

namespace CLI {
class App;
}

namespace sheaf {

// The command line as it was given.
struct CompareRequest {
  const CLI::App* command = nullptr;  // knows which options were given
  SceneOptions options;
  std::vector<std::string> inputs;  // one scene, or pictures of which the first is the reference
  // Of a scene:
  CameraChoice choice;
  std::optional<PixelSize> size;
  std::optional<int> samples, max_ulp;
  std::vector<std::string> targets = {"all"};
  std::vector<int> threads = {1};
  std::string precision = "strict";
  // Of pictures:
  std::string transfer = "linear";
  std::vector<std::pair<std::string, double>> limits;  // of --fail, by metric

  std::string progress = "auto";
  bool json = false;
};

void AddCompareOptions(CLI::App& app, CompareRequest& request);

}  // namespace sheaf

#endif  // SHEAF_APP_COMPARE_REQUEST_H_
