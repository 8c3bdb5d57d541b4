#include "src/app/compare_command.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <nlohmann/json.hpp>

#include "sheaf/render.h"
#include "src/app/add_options.h"
#include "src/app/interrupt.h"
#include "src/app/json_text.h"
#include "src/app/progress.h"
#include "src/app/standard_output.h"
#include "src/formats/picture.h"
#include "src/formats/printable.h"
#include "src/lab/picture_metrics.h"
#include "src/render/object_at.h"
#include "src/scene/srgb.h"

namespace sheaf {
namespace {

using Json = nlohmann::ordered_json;

// ---- Renderings of a scene ----

// What renders a frame: one of the things that must not change a bit.
struct Renderer {
  std::string target;
  int threads;
  std::string Name() const {
    return fmt::format("{}, {} thread{}", target, threads, threads == 1 ? "" : "s");
  }
};

Result<Film> RenderWith(const Renderer& renderer, const Scene& scene, const Camera& camera,
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

Result<std::vector<Renderer>> ListRenderers(const CompareRequest& request) {
  const Result<std::vector<std::string>> targets = ExpandTargets(request.targets);
  if (!targets) return targets.error();
  std::vector<Renderer> renderers;
  for (const int threads : request.threads) {
    for (const std::string& target : targets.value()) renderers.push_back({target, threads});
  }
  return renderers;
}

std::string ObjectName(const Scene& scene, const Camera& camera, const RenderOptions& options,
                       int x, int y) {
  const auto object = ObjectAt(scene, camera, options.width, options.height, x, y);
  if (!object) return "background";
  const std::string& name = scene.objects[*object].name;
  return name.empty() ? fmt::format("object {}", *object) : fmt::format("\"{}\"", Printable(name));
}

// Exact, for a bit to be seen.
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

Result<ExitCode> CompareRenderings(const CompareRequest& request) {
  const Result<std::vector<Renderer>> listed = ListRenderers(request);
  if (!listed) return listed.error();
  const std::vector<Renderer>& renderers = listed.value();
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
  for (const Camera* camera : cameras.value()) {
    const Result<Film> expected = RenderWith(renderers.front(), scene, *camera, options);
    if (!expected) return expected.error();
    for (std::size_t i = 1; i < renderers.size(); ++i) {
      const Result<Film> found = RenderWith(renderers[i], scene, *camera, options);
      if (!found) return found.error();
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

// ---- Pictures ----

struct Metric {
  const char* name;
  double (*value)(const PictureMetrics& metrics);
  bool more_is_better;
};

constexpr Metric kMetrics[] = {
    {"rmse", [](const PictureMetrics& m) { return m.rmse; }, false},
    {"psnr", [](const PictureMetrics& m) { return m.psnr; }, true},
    {"largest", [](const PictureMetrics& m) { return m.largest; }, false},
    {"over", [](const PictureMetrics& m) { return static_cast<double>(m.over); }, false},
    {"flip", [](const PictureMetrics& m) { return m.mean_flip; }, false},
};

const Metric* FindMetric(const std::string& name) {
  for (const Metric& metric : kMetrics) {
    if (name == metric.name) return &metric;
  }
  return nullptr;
}

std::optional<std::vector<std::pair<std::string, double>>> ParseLimits(const std::string& text) {
  std::vector<std::pair<std::string, double>> limits;
  for (const std::string& part : SplitAtCommas(text)) {
    const std::size_t equals = part.find('=');
    if (equals == std::string::npos || FindMetric(part.substr(0, equals)) == nullptr) return {};
    const auto value =
        ParseNumber(part.substr(equals + 1), 0, std::numeric_limits<double>::infinity());
    if (!value) return {};
    limits.emplace_back(part.substr(0, equals), *value);
  }
  return limits;
}

// Display values: those of a float picture, which are light, are encoded.
Result<Film> ReadDisplayValues(const std::string& path, Transfer transfer) {
  Result<ReadPictureResult> read = ReadPicture(path);
  if (!read) return read.error();
  Film film = std::move(read.value().film);
  if (transfer == Transfer::kSrgb && !read.value().is_display) {
    for (float& value : film.rgb) {
      value = static_cast<float>(SrgbEncode(static_cast<double>(value)));
    }
  }
  return film;
}

// A file of bytes holds what a display shows, from 0 to 1: beside it, light counts so far.
void ClampToDisplay(Film& film) {
  for (float& value : film.rgb) value = value > 0 ? std::min(value, 1.0f) : 0.0f;
}

bool IsFinite(const Film& film) {
  return std::all_of(film.rgb.begin(), film.rgb.end(), [](float v) { return std::isfinite(v); });
}

struct Comparison {
  PictureMetrics metrics;
  bool is_finite;  // whether both pictures are
};

// Every limit that is broken. What is not finite is beyond any, also where both pictures have it.
std::vector<std::string> BrokenLimits(const Comparison& comparison,
                                      const std::vector<std::pair<std::string, double>>& limits) {
  std::vector<std::string> broken;
  if (!comparison.is_finite && !limits.empty()) {
    broken.push_back("NaN or infinity breaks every limit");
  }
  for (const auto& [name, limit] : limits) {
    const Metric* metric = FindMetric(name);
    const double value = metric->value(comparison.metrics);
    if (metric->more_is_better ? !(value >= limit) : !(value <= limit)) {
      broken.push_back(fmt::format("{} {:.6g} breaks the limit of {:g}", name, value, limit));
    }
  }
  return broken;
}

// To two digits; never -0.
double Decibels(double psnr) { return std::round(100 * psnr) / 100 + 0.0; }

Result<ExitCode> ComparePictures(const CompareRequest& request) {
  if (request.inputs.size() < 2) {
    return Usage(
        fmt::format("{}: a second picture is missing", PrintablePath(request.inputs.front())));
  }
  const Transfer transfer = request.transfer == "srgb" ? Transfer::kSrgb : Transfer::kLinear;
  const Result<Film> reference = ReadDisplayValues(request.inputs.front(), transfer);
  if (!reference) return reference.error();
  const bool is_reference_finite = IsFinite(reference.value());
  std::optional<Film> shown_reference;  // clamped, where a picture asks for that
  Json json = {{"reference", request.inputs.front()}, {"pictures", Json::array()}};
  ExitCode code = ExitCode::kOk;
  std::string text;
  for (std::size_t i = 1; i < request.inputs.size(); ++i) {
    const std::string& path = request.inputs[i];
    Result<Film> test = ReadDisplayValues(path, transfer);
    if (!test) return test.error();
    const bool finite = is_reference_finite && IsFinite(test.value());
    const bool is_mixed = HoldsFloats(path) != HoldsFloats(request.inputs.front());
    if (is_mixed && !shown_reference) {
      shown_reference = reference.value();
      ClampToDisplay(*shown_reference);
    }
    if (is_mixed) ClampToDisplay(test.value());
    const Film& a = is_mixed ? *shown_reference : reference.value();
    const Film& b = test.value();
    if (a.width != b.width || a.height != b.height) {
      return Usage(fmt::format("{}: {}x{} pixels, and {} has {}x{}", PrintablePath(path), b.width,
                               b.height, PrintablePath(request.inputs.front()), a.width, a.height));
    }
    const PictureMetrics metrics = MeasurePictures(a, b, transfer);
    const std::vector<std::string> broken = BrokenLimits({metrics, finite}, request.limits);
    Json entry = {{"path", path}, {"identical", metrics.largest == 0}, {"finite", finite}};
    // JSON has no infinity: a metric that is not finite becomes null.
    for (const Metric& metric : kMetrics) entry[metric.name] = metric.value(metrics);
    entry["over"] = metrics.over;
    if (!broken.empty()) {
      entry["broken"] = broken;
      code = ExitCode::kDifferent;
    }
    json["pictures"].push_back(entry);
    text += fmt::format(
        "{}: rmse {:.6g}, psnr {:.2f} dB, largest error {:.6g}, {} pixels over 1/255, flip "
        "{:.6g}{}{}\n",
        PrintablePath(path), metrics.rmse, Decibels(metrics.psnr), metrics.largest, metrics.over,
        metrics.mean_flip, broken.empty() ? "" : "; ", fmt::join(broken, ", "));
  }
  const Status written = WriteStandardOutput(request.json ? JsonText(json) : text);
  if (!written) return written.error();
  return code;
}

// ---- The command line ----

enum class Mode { kRenderings, kPictures };

// An option that the other mode alone has would go unheard.
Status CheckOptions(const CLI::App& command, Mode mode) {
  for (const CLI::Option* option : command.get_options()) {
    const std::string name = option->get_name();
    if (option->count() == 0 || name == "INPUT" || name == "--json") continue;
    const bool is_of_pictures = name == "--transfer" || name == "--fail";
    if (is_of_pictures == (mode == Mode::kPictures)) continue;
    return Usage(fmt::format("{}: only where {} compared", name,
                             is_of_pictures ? "pictures are" : "a scene's renderings are"));
  }
  return Done{};
}

}  // namespace

CLI::App* AddCompareCommand(CLI::App& app, CompareRequest& request) {
  CLI::App* compare = app.add_subcommand(
      "compare", "Compare targets and threads on a scene bit by bit, or pictures by metrics");
  request.command = compare;
  compare->add_option("INPUT", request.inputs, "A scene; or pictures, the first the reference")
      ->required()
      ->option_text("...");
  AddCameraChoice(*compare, request.choice);
  AddSceneOptions(*compare, request.options);
  AddSize(*compare, request.size);
  AddInteger(*compare, "--spp", request.samples, 1, kMaxSamples, "Samples a pixel");
  AddTargets(*compare, request.targets,
             "What renders; the first is the reference. all: scalar and every usable one");
  AddThreads(*compare, request.threads);
  AddInteger(*compare, "--max-ulp", request.max_ulp, 0, std::numeric_limits<int>::max(),
             "Units in the last place that a channel may differ by; 0 if absent");
  AddPrecision(*compare, request.precision)->option_text("strict|double");
  compare->add_option("--transfer", request.transfer, "How 8-bit pictures encode light")
      ->option_text("linear|srgb")
      ->check(CLI::IsMember({"linear", "srgb"}));
  AddParsed(*compare, "--fail", request.limits, "METRIC=X[,...]",
            "a list of limits of rmse, psnr, largest, over or flip, like rmse=0.01,psnr=40",
            "Exit with 1 where a picture breaks a limit: rmse, psnr, largest, over, flip",
            &ParseLimits);
  compare->add_flag("--json", request.json, "The result as JSON");
  return compare;
}

Result<ExitCode> RunCompare(const CompareRequest& request) {
  const Mode mode = CheckPicturePath(request.inputs.front()) ? Mode::kPictures : Mode::kRenderings;
  if (const Status heard = CheckOptions(*request.command, mode); !heard) return heard.error();
  if (mode == Mode::kPictures) return ComparePictures(request);
  if (request.inputs.size() > 1) {
    return Usage(fmt::format("{}: no .png, .pfm or .exr, and of scenes there can be only one",
                             PrintablePath(request.inputs.front())));
  }
  return CompareRenderings(request);
}

}  // namespace sheaf
