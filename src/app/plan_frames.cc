#include "src/app/plan_frames.h"

#include <fmt/format.h>

#include <filesystem>
#include <utility>

#include "src/app/choose.h"
#include "src/app/choose_look.h"
#include "src/app/layer_picture.h"
#include "src/app/output_path.h"
#include "src/core/atomic_file.h"
#include "src/formats/picture.h"
#include "src/formats/printable.h"

namespace sheaf {
namespace {

// Whether the picture's format is known and can hold what is asked for.
Status CheckFormat(const RenderRequest& request) {
  const std::string named = FormatPath(request.output, request.format);
  const bool is_stdout = request.output == kStandardOutputPath;
  const Status known = CheckPictureOutput(request.output, request.format);
  if (!known) return known;
  if (is_stdout && request.statistics == "-") {
    return Usage("-o, --json: both to standard output; --json=FILE writes a file");
  }
  if (!request.layers.empty() && !request.format.empty() && !HoldsLayers(named)) {
    return Usage(
        fmt::format("--aov, --format {}: has no layers in it, and no path for files beside it",
                    request.format));
  }
  if (const Status shown = CheckLook(request.look, named); !shown) return shown;
  return request.bits ? CheckPictureBits(named, *request.bits) : Status(Done{});
}

// Whether it leads to a file, there already or not: no pipe, and no name of an open descriptor.
bool IsFilePath(const std::string& path) {
  std::error_code ignored;
  if (path.starts_with("/dev/") || path.starts_with("/proc/")) return false;
  return !std::filesystem::exists(path, ignored) || std::filesystem::is_regular_file(path, ignored);
}

// Whether the options for animations fit each other and the path.
Status CheckSequence(const RenderRequest& request) {
  const std::string& output = request.output;
  if (request.frames && request.options.time) {
    return Usage("--frames, --time: a moment is one or the other");
  }
  if (request.turntable && request.options.time) {
    return Usage("--turntable, --time: a turntable goes by frames");
  }
  const std::optional<FrameRange> range = SequenceOf(request);
  if (!range && HasFrameField(output)) {
    return Usage(
        fmt::format("-o {}: {} needs --frames or --turntable", Printable(output), kFrameField));
  }
  if (range && range->first != range->last && !HasFrameField(output)) {
    return Usage(fmt::format("-o {}: {} frames need {} in the path", Printable(output),
                             range->count(), kFrameField));
  }
  // A width that is none shows in any of the frames.
  const Result<std::string> path = ExpandPath(output, "camera", range ? range->first : 0);
  return path ? Status(Done{}) : path.error();
}

// Whether the time for a picture fits what else is asked for.
Status CheckBudget(const RenderRequest& request) {
  if (!request.budget) return Done{};
  if (request.contrast) return Usage("--budget: not together with --adaptive");
  if (request.resume)
    return Usage("--budget, --resume: no part of a picture is done before all is");
  if (SequenceOf(request)) {
    return Usage(
        "--budget: for stills, as the frames of a sequence would differ in their error; --error "
        "gives all the same");
  }
  return Done{};
}

std::vector<Output> OutputsOf(const RenderRequest& request, const std::vector<Frame>& frames) {
  std::vector<Output> outputs = {{"--json", request.statistics}};
  for (const Frame& frame : frames) {
    outputs.push_back({"-o", frame.path});
    for (const auto& [layer, path] : frame.beside) outputs.push_back({"--aov", path});
  }
  return outputs;
}

Result<Frame> PlanFrame(const RenderRequest& request, const Scene& scene, const Camera& camera,
                        std::optional<int> number) {
  const Result<std::string> path = ExpandPath(request.output, camera.name, number);
  if (!path) return path.error();
  if (const Status writable = CheckWritable(path.value()); !writable) return writable.error();
  Frame frame{&camera,        static_cast<std::size_t>(&camera - scene.cameras.data()),
              number,         path.value(),
              request.format, {}};
  const bool holds_layers = HoldsLayers(FormatPath(frame.path, frame.format));
  for (int i = 0; i < kLayerCount && !holds_layers; ++i) {
    const Layer layer = static_cast<Layer>(i);
    if (!request.layers.has(layer)) continue;
    frame.beside.emplace_back(layer, LayerPath(path.value(), layer));
    const Status writable = CheckWritable(frame.beside.back().second);
    if (!writable) return writable.error();
  }
  return frame;
}

}  // namespace

std::optional<FrameRange> SequenceOf(const RenderRequest& request) {
  if (request.frames) return request.frames;
  if (request.turntable) return FrameRange{0, *request.turntable - 1};
  return std::nullopt;
}

SceneOptions OptionsAt(const RenderRequest& request, int frame) {
  SceneOptions options = request.options;
  options.frame = frame;
  if (request.turntable) {
    // Whole turns leave no trace, so that frame N is frame 0 to the bit.
    const int step = frame % *request.turntable;
    options.turn = 360.0 * step / *request.turntable;
  }
  return options;
}

Status CheckCommandLine(const RenderRequest& request) {
  if (const Status sound = CheckBudget(request); !sound) return sound;
  if (const Status sound = CheckSequence(request); !sound) return sound;
  if (request.resume && !IsFilePath(request.output)) {
    return Usage(fmt::format("--resume: {} is no file that could be gone on with",
                             Printable(request.output)));
  }
  if (request.choice.cameras.size() > 1 && !HasCameraField(request.output)) {
    return Usage(
        fmt::format("-o {}: several cameras need {} in the path", request.output, kCameraField));
  }
  if (const Status sound = CheckFormat(request); !sound) return sound;
  if (request.crop && request.part) {
    return Usage("--tile, --crop: a part of the picture is one or the other");
  }
  if (const auto chosen = ChooseTarget(request.target); !chosen) return chosen.error();
  if (const auto chosen = ChooseDenoiseFilter(request.denoise); !chosen) return chosen.error();

  // Where a field is part of the folder's name, PlanFrames checks each folder.
  const std::string folder = request.output.substr(0, request.output.rfind('/') + 1);
  if (folder == FixedFolder(folder)) {
    if (const Status writable = CheckWritable(request.output); !writable) return writable;
  }
  if (!request.statistics.empty() && request.statistics != "-") {
    return CheckWritable(request.statistics);
  }
  return Done{};
}

Result<std::vector<Frame>> PlanFrames(const RenderRequest& request, const Scene& scene,
                                      const std::vector<std::string>& files) {
  const Result<std::vector<const Camera*>> cameras =
      ChooseCameras(request.choice, request.options, request.scene, scene);
  if (!cameras) return cameras.error();
  if (cameras.value().size() > 1 && !HasCameraField(request.output)) {
    return Usage(fmt::format("-o {}: the view \"{}\" has {} cameras, which need {} in the path",
                             request.output, request.choice.view, cameras.value().size(),
                             kCameraField));
  }
  const std::optional<FrameRange> sequence = SequenceOf(request);
  const FrameRange range = sequence.value_or(FrameRange{0, 0});
  std::vector<Frame> frames;
  for (int number = range.first; number <= range.last; ++number) {
    for (const Camera* camera : cameras.value()) {
      Result<Frame> frame =
          PlanFrame(request, scene, *camera, sequence ? std::optional(number) : std::nullopt);
      if (!frame) return frame.error();
      frames.push_back(std::move(frame).value());
    }
  }
  const Status apart = CheckOutputs(OutputsOf(request, frames), files);
  if (!apart) return apart.error();
  return frames;
}

}  // namespace sheaf
