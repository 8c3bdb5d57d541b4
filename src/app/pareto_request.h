// What the command line of `sheaf pareto` asks for.
#ifndef SHEAF_APP_PARETO_REQUEST_H_
#define SHEAF_APP_PARETO_REQUEST_H_

#include <optional>
#include <string>
#include <vector>

#include "src/app/choose.h"
#include "src/app/open_scene.h"
#include "src/app/parse_options.h"
#include "src/app/progress.h"

namespace CLI {
class App;
}

namespace sheaf {

// A setting has at most so many samples. The converged picture needs more: with the same samples a
// setting would have no error.
inline constexpr int kMostParetoSamples = 64;

// The command line as it was given.
struct ParetoRequest {
  SceneOptions options;
  std::string scene;
  CameraChoice choice;
  std::optional<PixelSize> size;
  std::string output;  // a folder; made where it is not there
  std::optional<int> reference_samples, repetitions, threads;
  std::optional<double> error, time;
  // Other places of the scene: moved by so much, or scaled by so much, each by itself.
  std::vector<double> moved, scaled;
  std::string progress = "auto";
  bool quiet = false;
};

void AddParetoOptions(CLI::App& app, ParetoRequest& request);

// What --progress and --quiet ask for.
ProgressStyle StyleOf(const ParetoRequest& request);

// A line for a person, unless --quiet.
void Say(const ParetoRequest& request, const std::string& line);

}  // namespace sheaf

#endif  // SHEAF_APP_PARETO_REQUEST_H_
