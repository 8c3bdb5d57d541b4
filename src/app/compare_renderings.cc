#include "src/app/compare_renderings.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "sheaf/render.h"
#include "src/app/interrupt.h"
#include "src/app/json_text.h"
#include "src/app/progress.h"
#include "src/app/standard_output.h"
#include "src/formats/printable.h"
#include "src/lab/object_at.h"
#include "src/lab/picture_metrics.h"
#include "src/scene/shapes.h"

namespace sheaf {
namespace {

using Json = nlohmann::ordered_json;

// A target on a number of threads. No choice of these may change a bit of the picture.
struct Contender {
  std::string target;
  int threads;
  std::string Name() const {
    return fmt::format("{}, {} thread{}", target, threads, threads == 1 ? "" : "s");
  }
};

Result<Film> RenderWith(const Contender& renderer, const Scene& scene, const Camera& camera,
                        RenderOptions options) {
  const Status chosen = ChooseTarget(renderer.target, options);
  if (!chosen) return chosen.error();
  options.threads = renderer.threads;
  FrameWatch watch(ProgressStyle::kNone, camera.name, options, 1);
  RenderStats stats;
  Result<Film> film = Render(scene, camera, options, &stats, watch.progress());
  if (const Status going = CheckInterrupted(); !going) return going.error();
  if (film && stats.target != renderer.target) {
    return Usage(
        fmt::format("--targets: {} was asked for and {} ran", renderer.target, stats.target));
  }
  return film;
}

Result<std::vector<Contender>> ListRenderers(const CompareRequest& request) {
  const Result<std::vector<std::string>> targets = ExpandTargets(request.targets);
  if (!targets) return targets.error();
  std::vector<Contender> renderers;
  for (const int threads : request.threads) {
    for (const std::string& target : targets.value()) renderers.push_back({target, threads});
  }
  return renderers;
}

std::string ObjectName(const Scene& scene, const Camera& camera, const RenderOptions& options,
                       int x, int y) {
  const auto object = ObjectAt(scene, camera, options.width, options.height, x, y);
  if (!object) return "background";
  const std::string& name = sheaf::ObjectAt(scene, *object).name;
  return name.empty() ? fmt::format("object {}", *object) : fmt::format("\"{}\"", Printable(name));
}

// In hexadecimal, so that a difference of one bit shows.
std::string PixelText(const float* rgb) {
  return fmt::format("({:a}, {:a}, {:a})", rgb[0], rgb[1], rgb[2]);
}

Json PixelJson(const float* rgb) {
  return {fmt::format("{:a}", rgb[0]), fmt::format("{:a}", rgb[1]), fmt::format("{:a}", rgb[2])};
}

// Adds one comparison to `json` and returns its line.
std::string DescribeDifference(const Scene& scene, const Camera& camera,
                               const RenderOptions& options, const Film& expected,
                               const Film& found, const FilmDifference& difference, Json& json) {
  json["pixels"] = difference.pixels;
  json["most_ulps"] = difference.most_ulps;
  if (difference.pixels == 0) {
    return difference.most_ulps == 0
               ? "same bits"
               : fmt::format("within the allowed, at most {} ULP apart", difference.most_ulps);
  }
  const int x = difference.x, y = difference.y;
  const std::string object = ObjectName(scene, camera, options, x, y);
  const float *a = expected.pixel(x, y), *b = found.pixel(x, y);
  json["first"] = {
      {"x", x}, {"y", y}, {"object", object}, {"reference", PixelJson(a)}, {"value", PixelJson(b)}};
  return fmt::format("{} pixels differ, by up to {} ULP; first ({}, {}) on {}: {} and not {}",
                     difference.pixels, difference.most_ulps, x, y, object, PixelText(b),
                     PixelText(a));
}

}  // namespace

Result<ExitCode> CompareRenderings(const CompareRequest& request) {
  const Result<std::vector<Contender>> listed = ListRenderers(request);
  if (!listed) return listed.error();
  const std::vector<Contender>& renderers = listed.value();
  if (renderers.size() < 2) {
    return Usage("--targets, --threads: there is one rendering, and nothing to compare it with");
  }
  const Precision precision = PrecisionOf(request.precision);
  if (precision == Precision::kFast) {
    return Usage(
        "--precision fast: has other bits on every target by design (docs/numerics.md), so that "
        "there is nothing to compare");
  }
  const std::string& path = request.inputs.front();
  const Result<Scene> read = OpenScene(path, request.options);
  if (!read) return read.error();
  const Scene& scene = read.value();
  const auto cameras = ChooseCameras(request.choice, request.options, path, scene);
  if (!cameras) return cameras.error();

  RenderOptions options = FrameOptions(scene.settings, request.size, request.samples);
  options.precision = precision;

  CatchInterrupts();
  Json json = {{"scene", path}, {"reference", renderers.front().Name()}, {"runs", Json::array()}};
  std::uint64_t differing = 0, runs = 0;
  StepWatch watch(ProgressStyleNamed(request.progress), "compare",
                  cameras.value().size() * renderers.size());
  for (const Camera* camera : cameras.value()) {
    const Result<Film> expected = RenderWith(renderers.front(), scene, *camera, options);
    if (!expected) return expected.error();
    watch.Advance();
    for (std::size_t i = 1; i < renderers.size(); ++i) {
      const Result<Film> found = RenderWith(renderers[i], scene, *camera, options);
      if (!found) return found.error();
      watch.Advance();
      const FilmDifference difference = CompareFilms(
          expected.value(), found.value(), static_cast<std::uint32_t>(request.max_ulp.value_or(0)));
      Json run = {{"camera", camera->name},
                  {"target", renderers[i].target},
                  {"threads", renderers[i].threads}};
      const std::string line = DescribeDifference(scene, *camera, options, expected.value(),
                                                  found.value(), difference, run);
      json["runs"].push_back(run);
      ++runs;
      differing += difference.pixels > 0;
      if (request.json) continue;
      watch.Clear();
      const Status written = WriteStandardOutput(
          fmt::format("{}: {}: {}\n", Printable(camera->name), renderers[i].Name(), line));
      if (!written) return written.error();
    }
  }
  const Status written =
      WriteStandardOutput(request.json ? JsonText(json)
                                       : fmt::format("{} of {} renderings differ from {}\n",
                                                     differing, runs, renderers.front().Name()));
  if (!written) return written.error();
  return differing == 0 ? ExitCode::kOk : ExitCode::kDifferent;
}

}  // namespace sheaf
