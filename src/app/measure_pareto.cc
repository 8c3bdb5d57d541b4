#include "src/app/measure_pareto.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>
#include <variant>

#include "sheaf/target.h"
#include "src/app/interrupt.h"
#include "src/app/print_message.h"
#include "src/app/render_timed.h"
#include "src/formats/printable.h"
#include "src/lab/picture_metrics.h"
#include "src/lab/pov_ray.h"
#include "src/lab/rank_statistics.h"

namespace sheaf {
namespace {

constexpr int kSamples[] = {1, 2, 4, 8, 16, 32, 64};
static_assert(*std::rbegin(kSamples) == kMostParetoSamples);
// POV-Ray reports whole milliseconds. A time shorter than this is no measurement.
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
      name += fmt::format(", min-throughput {:g}", options.min_throughput);
    return name + fmt::format(", depth {}", options.max_depth);
  }
};

// On the best target every combination in strict. In fast, in double and on the other targets only
// the samples vary.
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

Result<TimedFrame> RenderTimed(const Scene& scene, const Camera& camera, const Setting& setting) {
  RenderOptions options = setting.options;
  const Status chosen = ChooseTarget(setting.target, options);
  if (!chosen) return chosen.error();
  return RenderTimed(scene, camera, options);
}

// The error of a picture in two parts: its samples in double against the converged picture, and the
// picture against its samples in double; otherwise antialiasing would hide the arithmetic.
Result<ParetoPoint> MeasureSetting(const Scene& scene, const Camera& camera, Setting setting,
                                   const Film& converged) {
  const Result<TimedFrame> timed = RenderTimed(scene, camera, setting);
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
  const Result<TimedFrame> exact = RenderTimed(scene, camera, setting);
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

}  // namespace

Result<std::vector<ParetoPoint>> MeasureCamera(const ParetoRequest& request, const Scene& scene,
                                               const Camera& camera, const RenderOptions& base,
                                               int repetitions) {
  Setting reference{UsableTargets().front(), base};
  reference.options.precision = Precision::kDouble;
  reference.options.samples = request.reference_samples.value_or(256);
  reference.options.threads = 0;
  const std::string name = Printable(camera.name);
  Say(request, fmt::format("{}: the converged picture, {}", name, reference.Name()));
  const Result<TimedFrame> converged = RenderTimed(scene, camera, reference);
  if (!converged) return converged.error();
  const Film& film = converged.value().film;

  // Round by round over all settings, because a machine's clock drifts: a setting's repetitions are
  // spread over the run. The first round has the errors.
  const std::vector<Setting> settings = ListSettings(base);
  std::vector<ParetoPoint> points;
  std::vector<std::vector<double>> seconds;
  bool has_peer = true;
  // A setting's first frame goes with one in double, which counts as a step too.
  const auto rounds = static_cast<std::size_t>(repetitions);
  StepWatch watch(StyleOf(request), name, settings.size() * (rounds + 1));
  for (int round = 0; round < repetitions; ++round) {
    std::size_t index = 0;
    const auto add_time = [&](double time) {
      seconds.resize(std::max(seconds.size(), index + 1));
      seconds[index++].push_back(time);
    };
    for (const Setting& setting : settings) {
      if (round == 0) {
        const Result<ParetoPoint> point = MeasureSetting(scene, camera, setting, film);
        if (!point) return point.error();
        points.push_back(point.value());
        add_time(*point.value().seconds);
        watch.Advance();
      } else {
        const Result<TimedFrame> timed = RenderTimed(scene, camera, setting);
        if (!timed) return timed.error();
        add_time(timed.value().seconds);
      }
      watch.Advance();
    }
    if (!has_peer) continue;
    watch.Clear();
    if (HasPovRay()) Say(request, fmt::format("{}: round {}, POV-Ray", name, round + 1));
    const auto peer = MeasurePovRay(scene, camera, base, film);
    if (!peer && peer.error().kind == ErrorKind::kInterrupted) return peer.error();
    if (!peer) {
      PrintMessage(fmt::format("sheaf: {}; the report goes without it", peer.error().message));
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

}  // namespace sheaf
