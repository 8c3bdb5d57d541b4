#include "src/app/compare_request.h"

#include <limits>

#include "src/app/add_options.h"
#include "src/app/compare_pictures.h"

namespace sheaf {
namespace {

std::optional<std::vector<std::pair<std::string, double>>> ParseLimits(const std::string& text) {
  std::vector<std::pair<std::string, double>> limits;
  for (const std::string& part : SplitAtCommas(text)) {
    const std::size_t equals = part.find('=');
    if (equals == std::string::npos || !IsMetric(part.substr(0, equals))) return {};
    const auto value =
        ParseNumber(part.substr(equals + 1), 0, std::numeric_limits<double>::infinity());
    if (!value) return {};
    limits.emplace_back(part.substr(0, equals), *value);
  }
  return limits;
}

}  // namespace

void AddCompareOptions(CLI::App& app, CompareRequest& request) {
  request.command = &app;
  AddInputs(app, "INPUT", request.inputs, Presence::kNeeded,
            "A scene; or pictures, the first the reference");
  AddCameraChoice(app, request.choice);
  AddSceneOptions(app, request.options);
  AddMomentOptions(app, request.options);
  AddSize(app, request.size);
  AddInteger(app, "--spp", request.samples, 1, kMaxSamples, "Samples a pixel");
  AddTargets(app, request.targets,
             "What renders; the first is the reference. all: scalar and every usable one");
  AddThreads(app, request.threads);
  AddInteger(app, "--max-ulp", request.max_ulp, 0, std::numeric_limits<int>::max(),
             "Units in the last place that a channel may differ by; 0 if absent");
  AddPrecision(app, request.precision, "strict|double");
  AddChoice(app, "--transfer", request.transfer, {"linear", "srgb"},
            "How 8-bit pictures encode light");
  AddParsed(app, "--fail", request.limits, "METRIC=X[,...]",
            "a list of limits of rmse, psnr, largest, over or flip, like rmse=0.01,psnr=40",
            "Exit with 1 where a picture breaks a limit: rmse, psnr, largest, over, flip",
            &ParseLimits);
  AddChoice(app, "--progress", request.progress, {"auto", "plain", "none"},
            "What stderr shows meanwhile");
  AddFlag(app, "--json", request.json, "The result as JSON");
}

}  // namespace sheaf
