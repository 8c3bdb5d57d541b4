#include "src/app/pareto_request.h"

#include <fmt/format.h>

#include <limits>

#include "src/app/add_options.h"
#include "src/app/print_message.h"

namespace sheaf {

namespace {

// Numbers between commas, each in [min, 1e30].
std::optional<std::vector<double>> ParseNumbers(const std::string& text, double min) {
  std::vector<double> numbers;
  for (const std::string& part : SplitAtCommas(text)) {
    const std::optional<double> number = ParseNumber(part, min, 1e30);
    if (!number) return std::nullopt;
    numbers.push_back(*number);
  }
  return numbers;
}

}  // namespace

void AddParetoOptions(CLI::App& app, ParetoRequest& request) {
  AddInput(app, "SCENE", request.scene, Presence::kNeeded, "The scene file");
  AddSceneOptions(app, request.options);
  AddCameraChoice(app, request.choice);
  AddOutput(app, request.output, "FOLDER", "The folder for the report (needed)");
  AddSize(app, request.size);
  AddParsed(app, "--reference-spp", request.reference_samples, "N",
            fmt::format("a whole number above the {} samples of a setting, up to {}",
                        kMostParetoSamples, kMaxSamples),
            "Samples a pixel of the converged picture, in double, above 64; 256 if absent",
            [](const std::string& text) {
              return ParseInteger(text, kMostParetoSamples + 1, kMaxSamples);
            });
  AddInteger(app, "--repetitions", request.repetitions, 1, 1000,
             "Frames of each setting, of which the median counts; 3 if absent");
  AddThreads(app, request.threads, 0, "Threads; 1 if absent");
  constexpr double kMost = std::numeric_limits<double>::infinity();
  const auto parse = [](const std::string& text) { return ParseNumber(text, 0, kMost); };
  AddParsed(app, "--error", request.error, "E", "a number from 0",
            "Name the cheapest setting of at most this RMSE", parse);
  AddParsed(app, "--time", request.time, "SECONDS", "a number from 0",
            "Name the best setting that takes at most this long", parse);
  AddParsed(app, "--moved", request.moved, "D[,D]", "distances from 0 to 1e30, between commas",
            "Error and time where the scene is moved by D, instead of settings",
            [](const std::string& text) { return ParseNumbers(text, 0); });
  AddParsed(app, "--scaled", request.scaled, "S[,S]", "factors from 1e-30 to 1e30, between commas",
            "The same where it is scaled by S",
            [](const std::string& text) { return ParseNumbers(text, 1e-30); });
  AddChoice(app, "--progress", request.progress, {"auto", "plain", "none"},
            "What stderr shows meanwhile");
  AddFlag(app, "-q,--quiet", request.quiet, "Only errors on stderr");
}

ProgressStyle StyleOf(const ParetoRequest& request) {
  return ProgressStyleNamed(request.quiet ? "none" : request.progress);
}

void Say(const ParetoRequest& request, const std::string& line) {
  if (!request.quiet) PrintMessage(line);
}

}  // namespace sheaf
