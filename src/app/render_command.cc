#include "src/app/render_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "sheaf/scene.h"
#include "src/app/choose.h"
#include "src/app/dark_picture.h"
#include "src/app/frame_writer.h"
#include "src/app/heat_picture.h"
#include "src/app/interrupt.h"
#include "src/app/output_path.h"
#include "src/app/plan_frames.h"
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
  FrameRecord record{frame.camera->name, frame.number, frame.path, options, {}};
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

// "front", or of a sequence "front, frame 12, 3/24, 1:20 left".
std::string LabelOf(const Frame& frame, const SequencePace& pace) {
  std::string label = Printable(frame.camera->name);
  if (frame.number) label += fmt::format(", frame {}", *frame.number);
  const std::string text = pace.Text();
  if (!text.empty()) label += (frame.number ? ", " : " ") + text;
  return label;
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

// Renders the frames in turn. Each picture is written when it is ready.
Result<std::vector<FrameRecord>> RenderFrames(const RenderRequest& request,
                                              const RenderOptions& options, ProgressStyle style,
                                              std::vector<Frame> frames, OpenedScene* opened) {
  SequencePace pace(frames.size());
  std::vector<FrameRecord> records;
  std::optional<int> posed = frames.front().number;
  for (Frame& frame : frames) {
    if (frame.number != posed) {
      const Status moved = PoseScene(request.scene, OptionsAt(request, *frame.number), opened);
      if (!moved) return moved.error();
      posed = frame.number;
    }
    frame.camera = &opened->scene.cameras[frame.camera_index];
    Result<FrameRecord> record =
        RenderFrame(request, opened->scene, frame, options, style, LabelOf(frame, pace));
    if (!record) return record.error();
    std::vector<std::string> paths = {frame.path};
    for (const auto& [layer, path] : frame.beside) paths.push_back(path);
    for (const std::string& path : paths) {
      if (!request.quiet) PrintMessage("wrote " + path);
    }
    records.push_back(std::move(record).value());
    pace.Advance();
  }
  return records;
}

// Renders every camera at every frame; the statistics are written at the end.
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
  Result<OpenedScene> opened = OpenFirst(request, style);
  if (!opened) return opened.error();
  std::vector<std::string> doubts = SuspectScene(opened.value().scene);
  for (std::string& doubt : doubts) doubt = fmt::format("{}: {}", request.scene, doubt);
  const Result<RenderOptions> options = MergeOptions(request, opened.value().scene.settings);
  if (!options) return options.error();
  const Result<std::vector<Frame>> frames =
      PlanFrames(request, opened.value().scene, opened.value().files);
  if (!frames) return frames.error();
  const std::string still = StillSequence(request, opened.value(), frames.value());
  if (!still.empty()) doubts.push_back(still);
  for (const std::string& doubt : doubts) {
    if (!request.quiet) PrintMessage("sheaf: warning: " + doubt);
  }

  CatchInterrupts();
  const auto records =
      RenderFrames(request, options.value(), style, frames.value(), &opened.value());
  if (!records) return records.error();
  return WriteStatistics(request.statistics, StatisticsJson(request.scene, records.value()));
}

}  // namespace

Command RenderCommand() { return MakeCommand(&AddRenderOptions, &RunRender); }

}  // namespace sheaf
