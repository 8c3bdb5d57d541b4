// What the command line of `sheaf bench` asks for.
#ifndef SHEAF_APP_BENCH_REQUEST_H_
#define SHEAF_APP_BENCH_REQUEST_H_

#include <optional>
#include <string>
#include <vector>

#include "src/app/choose.h"
#include "src/app/open_scene.h"
#include "src/app/parse_options.h"

namespace CLI {
class App;
}

namespace sheaf {

// The command line as it was given.
struct BenchRequest {
  SceneOptions options;
  std::string scene;
  std::string camera;  // empty: the scene's first
  std::optional<PixelSize> size;
  std::optional<int> samples, repetitions;
  std::vector<std::string> targets = {"all"};
  std::vector<int> threads = {1};
  std::string baseline;  // empty: none
  bool absolute = false, force = false;
  bool kernels = false;  // instead of a scene's frames
  const CLI::App* command = nullptr;
  std::string progress = "auto";
  std::string json;  // empty: a table; "-": stdout; else a file, besides the table
};

void AddBenchOptions(CLI::App& app, BenchRequest& request);

}  // namespace sheaf

#endif  // SHEAF_APP_BENCH_REQUEST_H_
