#include "src/app/pareto_command.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iterator>
#include <limits>
#include <utility>

#include "sheaf/render.h"
#include "sheaf/target.h"
#include "src/app/add_options.h"
#include "src/app/interrupt.h"
#include "src/app/pareto_report.h"
#include "src/app/progress.h"
#include "src/app/standard_output.h"
#include "src/core/atomic_file.h"
#include "src/formats/printable.h"
#include "src/lab/picture_metrics.h"
#include "src/lab/pov_ray.h"
#include "src/lab/rank_statistics.h"

namespace sheaf {
namespace {

constexpr int kSamples[] = {1, 2, 4, 8, 16, 32, 64};
constexpr int kMostSamples = *std::rbegin(kSamples);
// POV-Ray tells whole milliseconds: of less than this they are no measurement.
constexpr double kLeastPovRaySeconds = 0.01;
constexpr double kContrasts[] = {0.02, 0.05, 0.1};
constexpr double kWeights[] = {0, 0.01, 0.05};

// What renders one point. Targets have the same bits, so they share a picture.
struct Setting {
  std::string target;
  RenderOptions options;

  std::string Name() const {
    std::string name = fmt::format("{}, {} spp", PrecisionName(options.precision), options.samples);
    if (options.contrast) name += fmt::format(", adaptive {:g}", *options.contrast);
    if (options.min_throughput > 0)
      name += fmt::format(", min-weight {:g}", options.min_throughput);
    return name + fmt::format(", depth {}", options.max_depth);
  }
};

// All trades on the best target; sample counts alone in double, and on every other target.
std::vector<Setting> ListSettings(const RenderOptions& base) {
  const std::vector<std::string> usable = UsableTargets();
  std::vector<int> depths = {base.max_depth};
  for (const int less : {2, 3}) {
    if (less < base.max_depth) depths.push_back(less);
  }
  std::vector<Setting> settings;
  for (const int samples : kSamples) {
    Setting setting{usable.front(), base};
    setting.options.samples = samples;
    for (const int depth : depths) {
      for (const double weight : kWeights) {
        setting.options.max_depth = depth;
        setting.options.min_throughput = weight;
        setting.options.contrast.reset();
        settings.push_back(setting);
        for (const double contrast : kContrasts) {
          if (samples == 1) break;
          setting.options.contrast = contrast;
          settings.push_back(setting);
        }
      }
    }
    Setting plain{usable.front(), base};
    plain.options.samples = samples;
    plain.options.precision = Precision::kDouble;
    settings.push_back(plain);
    plain.options.precision = Precision::kFast;
    settings.push_back(plain);
    plain.options.precision = Precision::kStrict;
    for (std::size_t i = 1; i <= usable.size(); ++i) {
      plain.target = i < usable.size() ? usable[i] : "scalar";
      if (samples <= 4) settings.push_back(plain);
    }
  }
  return settings;
}

// As a display shows it: what is brighter than white would weigh more than anything seen.
Film Shown(Film film) {
  for (float& value : film.rgb) value = value > 0 ? std::min(value, 1.0f) : 0.0f;
  return film;
}

struct Timed {
  Film film;
  double seconds;
};

Result<Timed> RenderTimed(const Scene& scene, const Camera& camera, const Setting& setting) {
  RenderOptions options = setting.options;
  const Status chosen = ChooseTarget(setting.target, options);
  if (!chosen) return chosen.error();
  FrameWatch watch(ProgressStyle::kNone, camera.name, options, 1);
  RenderStats stats;
  Result<Film> film = Render(scene, camera, options, &stats, watch.progress());
  if (!film) return film.error();
  // The watch wakes ten times a second; a frame may be shorter.
  if (const Status going = CheckInterrupted(); !going) return going.error();
  return Timed{Shown(std::move(film).value()), stats.wall_seconds};
}

// The error of a picture in two parts: its samples in double against the converged picture, and the
// picture against its samples in double; otherwise antialiasing would hide the arithmetic.
Result<ParetoPoint> MeasureSetting(const Scene& scene, const Camera& camera, Setting setting,
                                   const Film& converged) {
  const Result<Timed> timed = RenderTimed(scene, camera, setting);
  if (!timed) return timed.error();
  ParetoPoint point{setting.target,
                    PrecisionName(setting.options.precision),
                    setting.Name(),
                    timed.value().seconds,
                    RootMeanSquare(converged, timed.value().film),
                    0,
                    0,
                    false};
  point.sampling = point.error;
  if (setting.options.precision == Precision::kDouble) return point;
  setting.target = UsableTargets().front();
  setting.options.precision = Precision::kDouble;
  setting.options.threads = 0;
  const Result<Timed> exact = RenderTimed(scene, camera, setting);
  if (!exact) return exact.error();
  point.numeric = RootMeanSquare(exact.value().film, timed.value().film);
  point.sampling = RootMeanSquare(converged, exact.value().film);
  return point;
}

constexpr char kPovRay[] = "POV-Ray";
// Its own antialiasing.
constexpr const char* kPovRaySettings[] = {"-A",        "+A0.3 +R2", "+A0.3 +R3", "+A0.3 +R4",
                                           "+A0.1 +R2", "+A0.1 +R3", "+A0.1 +R4"};

// One round over POV-Ray's settings, in their order, where it is installed and knows the
// projection.
Result<std::vector<ParetoPoint>> MeasurePovRay(const Scene& scene, const Camera& camera,
                                               const RenderOptions& base, const Film& converged) {
  std::vector<ParetoPoint> points;
  if (!HasPovRay() || !std::holds_alternative<Perspective>(camera.projection)) return points;
  for (const char* antialiasing : kPovRaySettings) {
    const Result<PovRender> render =
        RenderWithPovRay(scene, camera, base.width, base.height, antialiasing, PovPicture::kRead);
    // A terminal's Ctrl-C stops POV-Ray too, which then fails.
    if (const Status going = CheckInterrupted(); !going) return going.error();
    if (!render) return render.error();
    const double error = RootMeanSquare(converged, render.value().film);
    points.push_back({kPovRay, "", antialiasing, render.value().seconds, error, {}, error, false});
  }
  return points;
}

// Returns how many times were no measurement.
int DropCoarseTimes(std::vector<ParetoPoint>& points) {
  int dropped = 0;
  for (ParetoPoint& point : points) {
    if (point.renderer != kPovRay || *point.seconds >= kLeastPovRaySeconds) continue;
    point.seconds.reset();
    ++dropped;
  }
  return dropped;
}

void Say(const ParetoRequest& request, const std::string& line) {
  if (!request.quiet) std::fprintf(stderr, "%s\n", line.c_str());
}

Result<std::vector<ParetoPoint>> MeasureCamera(const ParetoRequest& request, const Scene& scene,
                                               const Camera& camera, const RenderOptions& base,
                                               int repetitions) {
  Setting reference{UsableTargets().front(), base};
  reference.options.precision = Precision::kDouble;
  reference.options.samples = request.reference_samples.value_or(256);
  reference.options.threads = 0;
  const std::string name = Printable(camera.name);
  Say(request, fmt::format("{}: the converged picture, {}", name, reference.Name()));
  const Result<Timed> converged = RenderTimed(scene, camera, reference);
  if (!converged) return converged.error();
  const Film& film = converged.value().film;

  // Round by round over all settings, because a machine's clock drifts: a setting's repetitions are
  // spread over the run. The first round has the errors.
  const std::vector<Setting> settings = ListSettings(base);
  std::vector<ParetoPoint> points;
  std::vector<std::vector<double>> seconds;
  bool has_peer = true;
  for (int round = 0; round < repetitions; ++round) {
    std::size_t index = 0;
    const auto add_time = [&](double time) {
      seconds.resize(std::max(seconds.size(), index + 1));
      seconds[index++].push_back(time);
    };
    for (const Setting& setting : settings) {
      if (index % 20 == 0) {
        Say(request, fmt::format("{}: round {} of {}, {} of {} settings", name, round + 1,
                                 repetitions, index, settings.size()));
      }
      if (round == 0) {
        const Result<ParetoPoint> point = MeasureSetting(scene, camera, setting, film);
        if (!point) return point.error();
        points.push_back(point.value());
        add_time(*point.value().seconds);
      } else {
        const Result<Timed> timed = RenderTimed(scene, camera, setting);
        if (!timed) return timed.error();
        add_time(timed.value().seconds);
      }
    }
    if (!has_peer) continue;
    if (HasPovRay()) Say(request, fmt::format("{}: round {}, POV-Ray", name, round + 1));
    const auto peer = MeasurePovRay(scene, camera, base, film);
    if (!peer && peer.error().kind == ErrorKind::kInterrupted) return peer.error();
    if (!peer) {
      std::fprintf(stderr, "sheaf: %s; the report goes without it\n", peer.error().message.c_str());
      has_peer = false;
      points.resize(settings.size());
      continue;
    }
    for (const ParetoPoint& point : peer.value()) {
      if (round == 0) points.push_back(point);
      add_time(*point.seconds);
    }
  }
  for (std::size_t i = 0; i < points.size(); ++i) points[i].seconds = Median(seconds[i]);
  const int untimed = DropCoarseTimes(points);
  if (untimed > 0) {
    Say(request, fmt::format("{}: {} settings of POV-Ray took less than {:g} ms, which it tells in "
                             "whole ones: no times, and not on the front",
                             name, untimed, 1e3 * kLeastPovRaySeconds));
  }
  MarkFront(points);
  return points;
}

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

}  // namespace

CLI::App* AddParetoCommand(CLI::App& app, ParetoRequest& request) {
  CLI::App* pareto =
      app.add_subcommand("pareto", "Chart run time against error over a scene's settings");
  pareto->add_option("SCENE", request.scene, "The scene file")->required()->option_text(" ");
  AddSceneOptions(*pareto, request.options);
  AddCameraChoice(*pareto, request.choice);
  AddOutput(*pareto, request.output, "FOLDER", "The folder for the report (needed)");
  AddSize(*pareto, request.size);
  // With as many samples as a setting has, the setting would have no error.
  AddParsed(
      *pareto, "--reference-spp", request.reference_samples, "N",
      fmt::format("a whole number above the {} samples of a setting, up to {}", kMostSamples,
                  kMaxSamples),
      "Samples a pixel of the converged picture, in double, above 64; 256 if absent",
      [](const std::string& text) { return ParseInteger(text, kMostSamples + 1, kMaxSamples); });
  AddInteger(*pareto, "--repetitions", request.repetitions, 1, 1000,
             "Frames of each setting, of which the median counts; 3 if absent");
  AddInteger(*pareto, "--threads", request.threads, 0, kMaxThreads, "Threads; 1 if absent");
  constexpr double kMost = std::numeric_limits<double>::infinity();
  const auto parse = [](const std::string& text) { return ParseNumber(text, 0, kMost); };
  AddParsed(*pareto, "--error", request.error, "E", "a number from 0",
            "Name the cheapest setting of at most this RMSE", parse);
  AddParsed(*pareto, "--time", request.time, "SECONDS", "a number from 0",
            "Name the best setting that takes at most this long", parse);
  pareto->add_flag("-q,--quiet", request.quiet, "Only errors on stderr");
  return pareto;
}

Status RunPareto(const ParetoRequest& request) {
  const Result<Scene> scene = OpenScene(request.scene, request.options);
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
    const auto points = MeasureCamera(request, scene.value(), *camera, base, repetitions);
    if (!points) return points.error();
    const ParetoTitle title{request.scene,
                            camera->name,
                            base.width,
                            base.height,
                            request.reference_samples.value_or(256),
                            base.threads,
                            repetitions};
    const Result<std::string> stem = ExpandPath(request.output + "/{camera}", camera->name);
    if (!stem) return stem.error();
    const auto paths = WriteParetoReport(title, points.value(), stem.value());
    if (!paths) return paths.error();
    const Status written = WriteStandardOutput(FrontText(request, points.value()));
    if (!written) return written;
    for (const std::string& path : paths.value())
      Say(request, fmt::format("wrote {}", PrintablePath(path)));
  }
  return Done{};
}

}  // namespace sheaf
