#include "src/app/plan_render.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <utility>

#include "src/app/choose.h"
#include "src/app/output_path.h"
#include "src/app/plan_frames.h"
#include "src/app/print_message.h"
#include "src/app/suspect_scene.h"

namespace sheaf {
namespace {

// Of --error without --spp.
constexpr int kMostForError = 1024;

Result<RenderOptions> MergeOptions(const RenderRequest& request, const Settings& settings) {
  RenderOptions options = FrameOptions(settings, request.size, request.samples);
  options.max_depth = request.max_depth.value_or(settings.max_depth);
  options.contrast = request.contrast;
  options.error = request.error;
  // The scene's samples may be those of a picture without such a goal.
  if (request.error && !request.samples) options.samples = std::max(options.samples, kMostForError);
  if (request.error && request.contrast) return Usage("--error: not together with --adaptive");
  options.budget = request.budget;
  if (request.budget && !request.samples) options.samples = kMaxSamples;
  if (!request.samples && !request.contrast && !request.error && !request.budget) {
    options.contrast = settings.contrast;
    options.error = settings.error;
  }
  options.min_throughput = request.min_throughput.value_or(0);
  options.integrator = settings.integrator;
  for (const Integrator integrator : kIntegrators) {
    if (request.integrator == IntegratorName(integrator)) options.integrator = integrator;
  }
  options.crop = request.crop;
  if (const Status chosen = ChooseTarget(request.target, options); !chosen) return chosen.error();
  options.precision = PrecisionOf(request.precision);
  if (options.precision == Precision::kFast && options.target.is_scalar()) {
    return Usage("--precision fast: needs a SIMD target, not --target scalar");
  }
  options.threads = request.threads.value_or(options.threads);
  options.tile_size = request.tile_size.value_or(options.tile_size);
  options.layers = request.layers;
  if (request.part) {
    const auto [part, parts] = *request.part;
    if (parts > options.height) {
      return Usage(
          fmt::format("--tile {}/{}: the picture has {} rows", part, parts, options.height));
    }
    // Rows as even as can be, whatever the number of parts.
    const auto row = [rows = std::int64_t{options.height}, count = parts](int i) {
      return static_cast<int>(rows * i / count);
    };
    options.crop = PixelRect{0, row(part - 1), options.width, row(part)};
  }
  options.timing = request.statistics.empty() ? Timing::kOff : Timing::kOn;
  if (options.crop && (options.crop->x1 > options.width || options.crop->y1 > options.height)) {
    return Usage(fmt::format("--crop: {},{},{},{} is not inside the picture of {}x{}",
                             options.crop->x0, options.crop->y0, options.crop->x1, options.crop->y1,
                             options.width, options.height));
  }
  return options;
}

ProgressStyle ChooseProgressStyle(const RenderRequest& request) {
  return ProgressStyleNamed(request.quiet ? "none" : request.progress);
}

// What makes a sequence of more than one frame all one picture; empty where something moves.
std::string StillSequence(const RenderRequest& request, const OpenedScene& opened,
                          const std::vector<Frame>& frames) {
  const std::optional<FrameRange> range = SequenceOf(request);
  if (!range || range->count() == 1 || request.turntable || opened.duration > 0) return "";
  const bool moves = std::any_of(frames.begin(), frames.end(), [&](const Frame& frame) {
    return opened.cameras[frame.camera_index].path.size() > 1;
  });
  return moves ? "" : "--frames: nothing moves, so that all frames show the same";
}

Result<OpenedScene> OpenFirst(const RenderRequest& request, ProgressStyle style) {
  const ReadingNotice notice(style, request.scene);
  const std::optional<FrameRange> sequence = SequenceOf(request);
  const SceneOptions options = sequence ? OptionsAt(request, sequence->first) : request.options;
  return OpenSceneAndFiles(request.scene, options,
                           request.quiet ? Verbosity::kErrorsOnly : Verbosity::kWarnings);
}

// What follows from other options.
void FillIn(RenderRequest* request) {
  if (!request->no_floor) request->options.floor = Floor::kUnderLoneModels;
  if (request->size) {
    request->options.aspect = static_cast<double>(request->size->width) / request->size->height;
  }
}

}  // namespace

Result<RenderPlan> PlanRender(const RenderRequest& given) {
  RenderPlan plan;
  plan.request = given;
  RenderRequest& request = plan.request;
  if (request.output == "-") request.output = kStandardOutputPath;
  // Whatever can be refused is refused before the work.
  if (const Status sound = CheckCommandLine(request); !sound) return sound.error();
  FillIn(&request);
  plan.style = ChooseProgressStyle(request);
  Result<OpenedScene> opened = OpenFirst(request, plan.style);
  if (!opened) return opened.error();
  plan.opened = std::move(opened).value();
  const Scene& scene = plan.opened.scene;
  std::vector<std::string> doubts = SuspectScene(scene);
  for (std::string& doubt : doubts) doubt = fmt::format("{}: {}", request.scene, doubt);
  Result<RenderOptions> options = MergeOptions(request, scene.settings);
  if (!options) return options.error();
  plan.options = std::move(options).value();
  Result<std::vector<Frame>> frames = PlanFrames(request, scene, plan.opened.files);
  if (!frames) return frames.error();
  plan.frames = std::move(frames).value();
  const std::string still = StillSequence(request, plan.opened, plan.frames);
  if (!still.empty()) doubts.push_back(still);
  for (const std::string& doubt : doubts) {
    if (!request.quiet) PrintMessage("sheaf: warning: " + doubt);
  }
  return plan;
}

Result<RenderPlan> PlanFollowing(const RenderRequest& given) {
  RenderPlan plan;
  plan.request = given;
  RenderRequest& request = plan.request;
  FillIn(&request);
  // What rank 0 refused to read is not among what it has sent.
  request.options.allow_outside = true;
  request.options.strict = false;
  request.quiet = true;
  Result<OpenedScene> opened = OpenFirst(request, ProgressStyle::kNone);
  if (!opened) return opened.error();
  plan.opened = std::move(opened).value();
  Result<RenderOptions> options = MergeOptions(request, plan.opened.scene.settings);
  if (!options) return options.error();
  plan.options = std::move(options).value();
  return plan;
}

}  // namespace sheaf
