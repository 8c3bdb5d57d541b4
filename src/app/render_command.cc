#include "src/app/render_command.h"

#include <fmt/format.h>

#include <optional>
#include <utility>

#include "sheaf/scene.h"
#include "src/app/area_journal.h"
#include "src/app/choose.h"
#include "src/app/follow_render.h"
#include "src/app/frame_writer.h"
#include "src/app/interrupt.h"
#include "src/app/join_ranks.h"
#include "src/app/meter_sequence.h"
#include "src/app/output_path.h"
#include "src/app/plan_frames.h"
#include "src/app/plan_render.h"
#include "src/app/print_message.h"
#include "src/app/progress.h"
#include "src/app/render_picture.h"
#include "src/app/render_request.h"
#include "src/app/run_identity.h"
#include "src/app/sequence_journal.h"
#include "src/app/standard_output.h"
#include "src/app/statistics_json.h"
#include "src/cluster/leader.h"
#include "src/cluster/share_files.h"
#include "src/core/atomic_file.h"
#include "src/formats/held_files.h"
#include "src/formats/printable.h"

namespace sheaf {
namespace {

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
                                              std::vector<Frame> frames, OpenedScene* opened,
                                              Leader* leader) {
  Result<Earlier> found = FindEarlier(request, options, opened->files, frames.size());
  if (!found) return found.error();
  std::optional<SequenceJournal>& journal = found.value().sequence;
  SequencePace pace(frames.size());
  std::vector<FrameRecord> records;
  std::optional<int> posed = frames.front().number;
  Renderer renderer(opened->scene);
  const auto pose_at = [&](int frame) -> Status {
    const Status moved = PoseScene(request.scene, OptionsAt(request, frame), opened);
    posed = frame;
    renderer = Renderer(opened->scene);
    return moved;
  };
  if (IsMeteredOnce(request, opened->scene, frames)) {
    if (posed != kMeteredFrame) {
      if (const Status moved = pose_at(kMeteredFrame); !moved) return moved.error();
    }
    const Status metered = MeterSequence(request, options, renderer, &frames);
    if (!metered) return metered.error();
  }
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
      if (const Status moved = pose_at(*frame.number); !moved) return moved.error();
    }
    frame.camera = &opened->scene.cameras[frame.camera_index];
    Result<FrameRecord> record =
        RenderPicture(request, renderer, frame, options, style, LabelOf(frame, pace),
                      found.value().identity, leader);
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

// Lets the other ranks read what this one has read.
void ShareScene(const RenderRequest& request, Ranks& ranks) {
  ShareWork({request.work, HeldFiles()}, ranks, [] { return PendingSignal() != 0; });
}

// Renders every camera at every frame; the statistics are written at the end.
Status RunLeading(const RenderRequest& given, Ranks* ranks) {
  // Whatever fails from here on, the others are told.
  std::optional<Leader> leader;
  if (ranks != nullptr) {
    leader.emplace(*ranks);
    HoldFiles();
  }
  if (ranks != nullptr && given.budget) {
    return Usage("--budget: of one process alone; --error goes for many");
  }
  Result<RenderPlan> planned = PlanRender(given);
  if (!planned) return planned.error();
  RenderPlan& plan = planned.value();
  CatchInterrupts();
  if (ranks != nullptr) ShareScene(plan.request, *ranks);
  const auto records = RenderFrames(plan.request, plan.options, plan.style, plan.frames,
                                    &plan.opened, leader ? &*leader : nullptr);
  if (!records) return records.error();
  return WriteStatistics(plan.request.statistics,
                         StatisticsJson(plan.request.scene, records.value()));
}

Result<ExitCode> RunRender(const RenderRequest& request) {
  const Result<Ranks*> ranks = FindRanks();
  if (!ranks) return ranks.error();
  if (ranks.value() != nullptr && ranks.value()->rank() > 0) {
    return FollowRender(request, *ranks.value());
  }
  const Status rendered = RunLeading(request, ranks.value());
  if (!rendered) return rendered.error();
  return ExitCode::kOk;
}

}  // namespace

Command RenderCommand() { return MakeCommand(&AddRenderOptions, &RunRender); }

}  // namespace sheaf
