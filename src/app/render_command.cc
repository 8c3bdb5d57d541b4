#include "src/app/render_command.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <utility>

#include "sheaf/scene.h"
#include "src/app/choose.h"
#include "src/app/dark_picture.h"
#include "src/app/frame_writer.h"
#include "src/app/heat_picture.h"
#include "src/app/interrupt.h"
#include "src/app/layer_picture.h"
#include "src/app/print_message.h"
#include "src/app/progress.h"
#include "src/app/render_request.h"
#include "src/app/standard_output.h"
#include "src/app/statistics_json.h"
#include "src/app/suspect_scene.h"
#include "src/core/atomic_file.h"
#include "src/formats/picture.h"
#include "src/formats/printable.h"

namespace sheaf {
namespace {

// Whether the picture's format is known and can hold what is asked for.
Status CheckFormat(const RenderRequest& request) {
  const std::string named = FormatPath(request.output, request.format);
  const bool is_stdout = request.output == kStandardOutputPath;
  if (const Status known = CheckPicturePath(named); !known) {
    if (!is_stdout) return known;
    return Usage(fmt::format("-o {}: needs --format, because its name does not tell the format",
                             request.output));
  }
  if (is_stdout && request.statistics == "-") {
    return Usage("-o, --json: both to standard output; --json=FILE writes a file");
  }
  if (is_stdout && isatty(STDOUT_FILENO) != 0) {
    return Usage(fmt::format("-o {}: a terminal shows no pictures", request.output));
  }
  if (!request.layers.empty() && !request.format.empty() && !HoldsLayers(named)) {
    return Usage(
        fmt::format("--aov, --format {}: has no layers in it, and no path for files beside it",
                    request.format));
  }
  if (const Status shown = CheckLook(request.look, named); !shown) return shown;
  return request.bits ? CheckPictureBits(named, *request.bits) : Status(Done{});
}

// Finds what is wrong before the scene is read: first the command line, then where to write.
Status CheckCommandLine(const RenderRequest& request) {
  if (request.choice.cameras.size() > 1 && request.output.find(kCameraField) == std::string::npos) {
    return Usage(
        fmt::format("-o {}: several cameras need {} in the path", request.output, kCameraField));
  }
  if (const Status sound = CheckFormat(request); !sound) return sound;
  if (request.crop && request.part) {
    return Usage("--tile, --crop: a part of the picture is one or the other");
  }
  if (const auto chosen = ChooseTarget(request.target); !chosen) return chosen.error();

  // Where {camera} is part of the folder's name, PlanFrames checks each folder.
  const std::string folder = request.output.substr(0, request.output.rfind('/') + 1);
  if (folder.find(kCameraField) == std::string::npos) {
    if (const Status writable = CheckWritable(request.output); !writable) return writable;
  }
  if (!request.statistics.empty() && request.statistics != "-") {
    return CheckWritable(request.statistics);
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

Result<std::vector<Frame>> PlanFrames(const RenderRequest& request, const Scene& scene) {
  const Result<std::vector<const Camera*>> cameras =
      ChooseCameras(request.choice, request.options, request.scene, scene);
  if (!cameras) return cameras.error();
  if (cameras.value().size() > 1 && request.output.find(kCameraField) == std::string::npos) {
    return Usage(fmt::format("-o {}: the view \"{}\" has {} cameras, which need {} in the path",
                             request.output, request.choice.view, cameras.value().size(),
                             kCameraField));
  }
  std::vector<Frame> frames;
  for (const Camera* camera : cameras.value()) {
    const Result<std::string> path = ExpandPath(request.output, camera->name);
    if (!path) return path.error();
    if (const Status writable = CheckWritable(path.value()); !writable) return writable.error();
    Frame frame{camera, path.value(), request.format, {}};
    const bool holds_layers = HoldsLayers(FormatPath(frame.path, frame.format));
    for (int i = 0; i < kLayerCount && !holds_layers; ++i) {
      const Layer layer = static_cast<Layer>(i);
      if (!request.layers.has(layer)) continue;
      frame.beside.emplace_back(layer, LayerPath(path.value(), layer));
      const Status writable = CheckWritable(frame.beside.back().second);
      if (!writable) return writable.error();
    }
    frames.push_back(std::move(frame));
  }
  return frames;
}

Result<RenderOptions> MergeOptions(const RenderRequest& request, const Settings& settings) {
  RenderOptions options = FrameOptions(settings, request.size, request.samples);
  options.max_depth = request.max_depth.value_or(settings.max_depth);
  options.contrast = request.contrast;
  if (!request.samples && !request.contrast) options.contrast = settings.contrast;
  options.min_throughput = request.min_throughput.value_or(0);
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

PixelSize PictureSize(const RenderOptions& options) {
  if (options.crop) return {options.crop->width(), options.crop->height()};
  return {options.width, options.height};
}

std::uint64_t PixelCount(const PixelSize& size) {
  return static_cast<std::uint64_t>(size.width) * static_cast<std::uint64_t>(size.height);
}

Result<FrameRecord> RenderFrame(const RenderRequest& request, const Scene& scene, Frame frame,
                                const RenderOptions& options, ProgressStyle style,
                                std::string label) {
  const PixelSize size = PictureSize(options);
  FrameRecord record{frame.camera->name, frame.path, options, {}};
  if (!HoldsFloats(FormatPath(frame.path, frame.format))) {
    const Result<Look> look = ChooseLook(request.look, scene, *frame.camera, options);
    if (!look) return look.error();
    frame.look = look.value();
  }
  // Before the first ray: what cannot be written costs no rendering.
  Result<FrameWriter> writer =
      FrameWriter::Create(scene, frame, options, request.bits, request.scene);
  if (!writer) return writer.error();
  FrameWatch watch(style, std::move(label), options, PixelCount(size));
  HeatPicture heat(options);
  DarkPicture dark(scene.settings.transfer, frame.look.ev);
  const RowSink write = [&](const Film& rows) {
    dark.AddRows(rows);
    if (options.layers.has(Layer::kHeat)) heat.AddRows(rows);
    return writer.value().WriteRows(rows);
  };
  const Status rendered =
      RenderRows(scene, *frame.camera, options, write, &record.stats, watch.progress());
  // A signal in the last tenth of a second may find the frame finished. The command stops even so.
  if (PendingSignal() != 0 || (!rendered && rendered.error().kind == ErrorKind::kInterrupted)) {
    return Error{ErrorKind::kInterrupted,
                 fmt::format("interrupted; {} was not written", frame.path)};
  }
  if (!rendered) return rendered.error();
  watch.Finish(record.stats);
  if (const Status written = writer.value().Finish(); !written) return written.error();
  // A part of a picture may well be empty.
  if (!options.crop && !request.quiet) {
    const Result<std::string> reason = dark.Explain(scene, *frame.camera, options);
    if (reason && !reason.value().empty()) PrintMessage("sheaf: warning: " + reason.value());
  }
  for (const auto& [layer, path] : frame.beside) {
    if (layer != Layer::kHeat) continue;
    if (const Status written = heat.Write(path); !written) return written.error();
  }
  return record;
}

Status WriteStatistics(const std::string& destination, const std::string& json) {
  if (destination.empty()) return Done{};
  return destination == "-" ? WriteStandardOutput(json) : WriteFileWhole(destination, json);
}

// Renders every camera. Each picture is written when it is ready, the statistics at the end.
Status RunRender(const RenderRequest& given) {
  RenderRequest request = given;
  if (request.output == "-") request.output = kStandardOutputPath;
  // Whatever can be refused is refused before the work.
  if (const Status sound = CheckCommandLine(request); !sound) return sound;
  if (!request.no_floor) request.options.floor = Floor::kUnderLoneModels;
  if (request.size) {
    request.options.aspect = static_cast<double>(request.size->width) / request.size->height;
  }
  const ProgressStyle style = ChooseProgressStyle(request);
  const Result<OpenedScene> opened = [&] {
    const ReadingNotice notice(style, request.scene);
    return OpenSceneAndFiles(request.scene, request.options,
                             request.quiet ? Verbosity::kErrorsOnly : Verbosity::kWarnings);
  }();
  if (!opened) return opened.error();
  const Scene& scene = opened.value().scene;
  for (const std::string& line : SuspectScene(scene)) {
    if (!request.quiet) {
      PrintMessage(fmt::format("sheaf: warning: {}: {}", request.scene, line));
    }
  }
  const Result<RenderOptions> options = MergeOptions(request, scene.settings);
  if (!options) return options.error();
  const Result<std::vector<Frame>> frames = PlanFrames(request, scene);
  if (!frames) return frames.error();
  const Status apart = CheckOutputs(OutputsOf(request, frames.value()), opened.value().files);
  if (!apart) return apart;

  CatchInterrupts();
  const std::size_t count = frames.value().size();
  std::vector<FrameRecord> records;
  for (const Frame& frame : frames.value()) {
    std::string label = Printable(frame.camera->name);
    if (count > 1) label += fmt::format(" {}/{}", records.size() + 1, count);
    Result<FrameRecord> record = RenderFrame(request, scene, frame, options.value(), style, label);
    if (!record) return record.error();
    std::vector<std::string> paths = {frame.path};
    for (const auto& [layer, path] : frame.beside) paths.push_back(path);
    for (const std::string& path : paths) {
      if (!request.quiet) PrintMessage("wrote " + path);
    }
    records.push_back(std::move(record).value());
  }
  return WriteStatistics(request.statistics, StatisticsJson(request.scene, records));
}

}  // namespace

Command RenderCommand() { return MakeCommand(&AddRenderOptions, &RunRender); }

}  // namespace sheaf
