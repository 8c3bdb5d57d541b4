#include "src/app/render_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "sheaf/scene.h"
#include "src/app/band_journal.h"
#include "src/app/choose.h"
#include "src/app/frame_writer.h"
#include "src/app/interrupt.h"
#include "src/app/output_path.h"
#include "src/app/plan_frames.h"
#include "src/app/print_message.h"
#include "src/app/progress.h"
#include "src/app/render_picture.h"
#include "src/app/render_request.h"
#include "src/app/run_identity.h"
#include "src/app/sequence_journal.h"
#include "src/app/standard_output.h"
#include "src/app/statistics_json.h"
#include "src/app/suspect_scene.h"
#include "src/core/atomic_file.h"
#include "src/formats/printable.h"

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
  if (!request.samples && !request.contrast && !request.error) {
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

std::vector<std::string> FilesOf(const Frame& frame) {
  std::vector<std::string> files = {frame.path};
  for (const auto& [layer, path] : frame.beside) files.push_back(path);
  return files;
}

// What an earlier run has left of the same work; nothing of it where --resume is not given.
struct Earlier {
  std::optional<std::uint64_t> identity;
  std::optional<SequenceJournal> sequence;  // where there are several pictures
};

Result<Earlier> FindEarlier(const RenderRequest& request, const RenderOptions& options,
                            const std::vector<std::string>& files, std::size_t pictures) {
  Earlier earlier;
  if (!request.resume) return earlier;
  // Fast arithmetic has other bits on every target.
  const std::string target =
      options.precision == Precision::kFast ? options.target.name() : std::string();
  earlier.identity = RunIdentity(request.identity + target, files);
  if (pictures == 1) return earlier;
  const std::string path = SequenceJournalPath(request.output);
  Result<SequenceJournal> sequence = SequenceJournal::Open(path, *earlier.identity);
  if (!sequence) return sequence.error();
  if (sequence.value().was_other()) WarnOfOtherWork(request, path);
  earlier.sequence = std::move(sequence).value();
  return earlier;
}

// Renders the frames in turn. Each picture is written when it is ready.
Result<std::vector<FrameRecord>> RenderFrames(const RenderRequest& request,
                                              const RenderOptions& options, ProgressStyle style,
                                              std::vector<Frame> frames, OpenedScene* opened) {
  Result<Earlier> found = FindEarlier(request, options, opened->files, frames.size());
  if (!found) return found.error();
  std::optional<SequenceJournal>& journal = found.value().sequence;
  SequencePace pace(frames.size());
  std::vector<FrameRecord> records;
  std::optional<int> posed = frames.front().number;
  for (Frame& frame : frames) {
    const std::vector<std::string> files = FilesOf(frame);
    if (journal && journal->Has(files)) {
      const std::string& camera = opened->cameras[frame.camera_index].name;
      records.push_back({camera, frame.number, frame.path, options, {}, 0, true});
      if (!request.quiet) PrintMessage("kept " + frame.path);
      RemoveJournal(JournalPath(frame.path));
      pace.Skip();
      continue;
    }
    if (frame.number != posed) {
      const Status moved = PoseScene(request.scene, OptionsAt(request, *frame.number), opened);
      if (!moved) return moved.error();
      posed = frame.number;
    }
    frame.camera = &opened->scene.cameras[frame.camera_index];
    Result<FrameRecord> record = RenderPicture(request, opened->scene, frame, options, style,
                                               LabelOf(frame, pace), found.value().identity);
    if (!record) return record.error();
    if (journal) {
      if (const Status added = journal->Add(files); !added) return added.error();
    }
    if (request.resume) RemoveJournal(JournalPath(frame.path));
    for (const std::string& file : files) {
      if (!request.quiet) PrintMessage("wrote " + file);
    }
    records.push_back(std::move(record).value());
    pace.Advance();
  }
  if (journal) RemoveJournal(SequenceJournalPath(request.output));
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
