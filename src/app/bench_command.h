// `sheaf bench`: rays a second by target, with intervals, and a verdict against an earlier run.
#ifndef SHEAF_APP_BENCH_COMMAND_H_
#define SHEAF_APP_BENCH_COMMAND_H_

#include <optional>
#include <string>
#include <vector>

#include "src/app/choose.h"
#include "src/app/exit_code.h"
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
  bool absolute = false;
  std::string json;  // empty: a table; "-": stdout; else a file, besides the table
};

CLI::App* AddBenchCommand(CLI::App& app, BenchRequest& request);

// kDifferent where a row became slower than in the baseline.
Result<ExitCode> RunBench(const BenchRequest& request);

}  // namespace sheaf

#endif  // SHEAF_APP_BENCH_COMMAND_H_
