#include "src/app/pareto_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "src/app/interrupt.h"
#include "src/app/measure_pareto.h"
#include "src/app/measure_places.h"
#include "src/app/output_path.h"
#include "src/app/pareto_report.h"
#include "src/app/pareto_request.h"
#include "src/app/standard_output.h"
#include "src/core/atomic_file.h"
#include "src/formats/printable.h"

namespace sheaf {
namespace {

std::string FrontText(const ParetoRequest& request, std::vector<ParetoPoint> points) {
  std::sort(points.begin(), points.end(),
            [](const ParetoPoint& a, const ParetoPoint& b) { return a.seconds < b.seconds; });
  std::string text;
  for (const ParetoPoint& point : points) {
    if (point.is_on_front) text += PointText(point);
  }
  const auto answer = [&](const std::string& what, const ParetoPoint* point) {
    text += what + (point ? PointText(*point) : "no setting\n");
  };
  if (request.error) {
    answer(fmt::format("cheapest for error {:g}: ", *request.error),
           CheapestFor(points, *request.error));
  }
  if (request.time) {
    answer(fmt::format("best for {:g} s: ", *request.time), BestFor(points, *request.time));
  }
  return text;
}

// What one camera gave, as text for stdout; the report is in files that start with `stem`.
Result<std::string> ReportCamera(const ParetoRequest& request, const Scene& scene,
                                 const Camera& camera, const RenderOptions& base,
                                 const ParetoTitle& title, const std::string& stem) {
  Result<std::vector<std::string>> paths = std::vector<std::string>();
  std::string text;
  if (request.moved.empty() && request.scaled.empty()) {
    const auto points = MeasureCamera(request, scene, camera, base, title.repetitions);
    if (!points) return points.error();
    paths = WriteParetoReport(title, points.value(), stem);
    text = FrontText(request, points.value());
  } else {
    const auto points = MeasurePlaces(request, scene, camera, base, title.repetitions);
    if (!points) return points.error();
    paths = WritePlaceReport(title, points.value(), stem);
    for (const PlacePoint& point : points.value()) text += PlaceText(point);
  }
  if (!paths) return paths.error();
  for (const std::string& path : paths.value()) {
    Say(request, fmt::format("wrote {}", PrintablePath(path)));
  }
  return text;
}

Status RunPareto(const ParetoRequest& request) {
  const Result<Scene> scene =
      OpenScene(request.scene, request.options,
                request.quiet ? Verbosity::kErrorsOnly : Verbosity::kWarnings);
  if (!scene) return scene.error();
  const auto cameras = ChooseCameras(request.choice, request.options, request.scene, scene.value());
  if (!cameras) return cameras.error();
  std::error_code error;
  std::filesystem::create_directories(request.output, error);
  if (error) {
    return Error{ErrorKind::kInputOutput,
                 fmt::format("{}: no folder can be made there: {}", PrintablePath(request.output),
                             error.message())};
  }
  const Status writable = CheckWritable(request.output + "/report.json");
  if (!writable) return writable;

  RenderOptions base = FrameOptions(scene.value().settings, request.size, std::nullopt);
  base.threads = request.threads.value_or(1);
  const int repetitions = request.repetitions.value_or(3);
  CatchInterrupts();
  for (const Camera* camera : cameras.value()) {
    const ParetoTitle title{request.scene,
                            camera->name,
                            base.width,
                            base.height,
                            request.reference_samples.value_or(256),
                            base.threads,
                            repetitions};
    const Result<std::string> stem = ExpandPath(request.output + "/{camera}", camera->name);
    if (!stem) return stem.error();
    const auto text = ReportCamera(request, scene.value(), *camera, base, title, stem.value());
    if (!text) return text.error();
    const Status written = WriteStandardOutput(text.value());
    if (!written) return written;
  }
  return Done{};
}

}  // namespace

Command ParetoCommand() { return MakeCommand(&AddParetoOptions, &RunPareto); }

}  // namespace sheaf
