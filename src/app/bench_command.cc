#include "src/app/bench_command.h"

#include <utility>
#include <vector>

#include "sheaf/render.h"
#include "sheaf/target.h"
#include "src/app/bench_baseline.h"
#include "src/app/bench_report.h"
#include "src/app/bench_request.h"
#include "src/app/interrupt.h"
#include "src/app/progress.h"
#include "src/app/standard_output.h"
#include "src/core/atomic_file.h"

namespace sheaf {
namespace {

Result<RenderStats> RenderOnce(const Scene& scene, const Camera& camera, RenderOptions options,
                               BenchRow& row) {
  if (const Status chosen = ChooseTarget(row.target, options); !chosen) return chosen.error();
  options.threads = row.threads;
  row.lanes = static_cast<std::size_t>(options.target.lanes());
  FrameWatch watch(ProgressStyle::kNone, camera.name, options, 1);
  const RowSink drop = [](const Film&) { return Status(Done{}); };
  RenderStats stats;
  const Status rendered = RenderRows(scene, camera, options, drop, &stats, watch.progress());
  if (!rendered) return rendered.error();
  // The watch wakes ten times a second; a frame may be shorter.
  if (const Status going = CheckInterrupted(); !going) return going.error();
  return stats;
}

// One frame of each row, which also tells its rays.
Status WarmUp(const Scene& scene, const Camera& camera, const RenderOptions& options,
              std::vector<BenchRow>& rows) {
  for (BenchRow& row : rows) {
    const Result<RenderStats> stats = RenderOnce(scene, camera, options, row);
    if (!stats) return stats.error();
    row.rays = stats.value().rays.traced();
  }
  return Done{};
}

// Every repetition takes each row once, beginning with another one: a drift of the clock meets all
// alike.
Status Measure(const Scene& scene, const Camera& camera, const RenderOptions& options,
               int repetitions, std::vector<BenchRow>& rows) {
  for (int repetition = 0; repetition < repetitions; ++repetition) {
    for (std::size_t i = 0; i < rows.size(); ++i) {
      BenchRow& row = rows[(i + static_cast<std::size_t>(repetition + 1)) % rows.size()];
      const Result<RenderStats> stats = RenderOnce(scene, camera, options, row);
      if (!stats) return stats.error();
      row.seconds.push_back(stats.value().wall_seconds);
      for (int k = 0; k < kPhases; ++k) row.phases[k].push_back(stats.value().phase_seconds[k]);
    }
  }
  return Done{};
}

// What to measure, in the order of the report: every target on every number of threads.
Result<std::vector<BenchRow>> ListRows(const BenchRequest& request) {
  const Result<std::vector<std::string>> targets = ExpandTargets(request.targets);
  if (!targets) return targets.error();
  std::vector<BenchRow> rows;
  for (const int threads : request.threads) {
    for (const std::string& target : targets.value()) {
      BenchRow& row = rows.emplace_back();
      row.target = target;
      row.threads = threads;
    }
  }
  return rows;
}

Result<const Camera*> ChooseCamera(const BenchRequest& request, const Scene& scene) {
  CameraChoice choice;
  if (!request.camera.empty()) choice.cameras = {request.camera};
  const auto cameras = ChooseCameras(choice, request.options, request.scene, scene);
  if (!cameras) return cameras.error();
  return cameras.value().front();
}

// To stdout, or into a file with the tables on stdout.
Status WriteReport(const std::string& destination, const BenchReport& report) {
  if (destination == "-") return WriteStandardOutput(BenchJson(report));
  if (!destination.empty()) {
    const Status written = WriteFileWhole(destination, BenchJson(report));
    if (!written) return written;
  }
  return WriteStandardOutput(BenchText(report));
}

// kDifferent where a row became slower than in the baseline.
Result<ExitCode> RunBench(const BenchRequest& request) {
  const bool has_baseline = !request.baseline.empty();
  const Result<BenchReport> baseline =
      has_baseline ? ReadBaseline(request.baseline) : Result<BenchReport>(BenchReport());
  if (!baseline) return baseline.error();
  if (!request.json.empty() && request.json != "-") {
    if (const Status writable = CheckWritable(request.json); !writable) return writable.error();
  }
  Result<std::vector<BenchRow>> rows = ListRows(request);
  if (!rows) return rows.error();
  const Result<OpenedScene> opened = OpenSceneAndFiles(request.scene, request.options);
  if (!opened) return opened.error();
  const Scene& scene = opened.value().scene;
  std::vector<std::string> inputs = opened.value().files;
  inputs.push_back(request.baseline);
  const Status apart = CheckOutputs({{"--json", request.json}}, inputs);
  if (!apart) return apart.error();
  const Result<const Camera*> chosen = ChooseCamera(request, scene);
  if (!chosen) return chosen.error();
  const Camera& camera = *chosen.value();
  RenderOptions options = FrameOptions(scene.settings, request.size, request.samples);
  options.timing = Timing::kOn;
  BenchReport report{request.scene,  camera.name,     options.width,
                     options.height, options.samples, std::move(rows).value()};
  if (has_baseline) {
    const Status same = CheckSameFrame(request.baseline, report, baseline.value());
    if (!same) return same.error();
  }

  CatchInterrupts();
  const Status warm = WarmUp(scene, camera, options, report.rows);
  if (!warm) return warm.error();
  if (has_baseline) {
    const Status same = CheckSameRays(request.baseline, report.rows.front().rays, baseline.value());
    if (!same) return same.error();
  }
  const Status measured =
      Measure(scene, camera, options, request.repetitions.value_or(9), report.rows);
  if (!measured) return measured.error();
  ExitCode code = ExitCode::kOk;
  if (has_baseline) {
    const Yardstick yardstick = request.absolute ? Yardstick::kSeconds : Yardstick::kScalar;
    code = JudgeRows(baseline.value(), yardstick, report);
  }
  if (const Status written = WriteReport(request.json, report); !written) return written.error();
  return code;
}

}  // namespace

Command BenchCommand() { return MakeCommand(&AddBenchOptions, &RunBench); }

}  // namespace sheaf
