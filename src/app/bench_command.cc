#include "src/app/bench_command.h"

#include <fmt/format.h>

#include <utility>
#include <vector>

#include "sheaf/render.h"
#include "sheaf/target.h"
#include "src/app/add_options.h"
#include "src/app/bench_baseline.h"
#include "src/app/bench_report.h"
#include "src/app/bench_request.h"
#include "src/app/interrupt.h"
#include "src/app/kernels_report.h"
#include "src/app/machine.h"
#include "src/app/measure_bench.h"
#include "src/app/print_message.h"
#include "src/app/progress.h"
#include "src/app/standard_output.h"
#include "src/core/atomic_file.h"
#include "src/lab/measure_kernels.h"

namespace sheaf {
namespace {

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

// Tells of rows that make a bad baseline, before anyone judges by them.
void WarnOfNoise(const BenchReport& report) {
  for (const std::string& line : DescribeNoise(report)) {
    PrintMessage(fmt::format("sheaf: warning: a bad baseline: {}", line));
  }
}

// What is wrong with the command line and its files, before a scene is read.
Result<BenchReport> ReadInputs(const BenchRequest& request) {
  BenchReport baseline;
  if (!request.baseline.empty()) {
    Result<BenchReport> read = ReadBaseline(request.baseline);
    if (!read) return read;
    baseline = std::move(read).value();
    if (!request.force) {
      const Status same = CheckSameMachine(request.baseline, ThisMachine(), baseline.machine);
      if (!same) return same.error();
    }
  }
  if (!request.json.empty() && request.json != "-") {
    if (const Status writable = CheckWritable(request.json); !writable) return writable.error();
  }
  return baseline;
}

// The kernels are what they are, whatever scene and picture.
Status CheckKernelOptions(const BenchRequest& request) {
  for (const std::string& name : GivenOptions(*request.command)) {
    const bool is_known = name == "--kernels" || name == "--targets" || name == "--repetitions" ||
                          name == "--progress" || name == "--json";
    if (!is_known) return Usage(fmt::format("{}: not with --kernels", name));
  }
  if (!request.json.empty() && request.json != "-") return CheckWritable(request.json);
  return Done{};
}

Status RunKernels(const BenchRequest& request) {
  if (const Status heard = CheckKernelOptions(request); !heard) return heard;
  const Result<std::vector<std::string>> targets = ExpandTargets(request.targets);
  if (!targets) return targets.error();
  CatchInterrupts();
  const int repetitions = request.repetitions.value_or(9);
  StepWatch watch(ProgressStyleNamed(request.progress), "bench",
                  KernelSteps(targets.value().size(), repetitions));
  const Result<std::vector<KernelRow>> rows =
      MeasureKernels(targets.value(), repetitions, [&watch] {
        watch.Advance();
        return CheckInterrupted();
      });
  if (!rows) return rows.error();
  const std::string json = KernelsJson(rows.value(), ThisMachine());
  if (request.json == "-") return WriteStandardOutput(json);
  if (!request.json.empty()) {
    if (const Status written = WriteFileWhole(request.json, json); !written) return written;
  }
  return WriteStandardOutput(KernelsText(rows.value()));
}

// kDifferent where a row became slower than in the baseline, kUndecided where one has no verdict.
Result<ExitCode> RunBench(const BenchRequest& request) {
  if (request.kernels) {
    const Status ran = RunKernels(request);
    return ran ? Result<ExitCode>(ExitCode::kOk) : ran.error();
  }
  if (request.scene.empty()) return Usage("SCENE is required, or --kernels");
  const bool has_baseline = !request.baseline.empty();
  const Result<BenchReport> baseline = ReadInputs(request);
  if (!baseline) return baseline.error();
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
  BenchReport report{request.scene,   camera.name,
                     options.width,   options.height,
                     options.samples, std::move(rows).value(),
                     ThisMachine(),   0};
  if (has_baseline) {
    const Status same = CheckSameFrame(request.baseline, report, baseline.value());
    if (!same) return same.error();
  }

  CatchInterrupts();
  const Status warm = WarmUp(scene, camera, options, report);
  if (!warm) return warm.error();
  if (has_baseline) {
    const Status same = CheckSameRays(request.baseline, report.rows.front().rays, baseline.value());
    if (!same) return same.error();
  }
  const Status measured = Measure(scene, camera, options, request.repetitions.value_or(9),
                                  ProgressStyleNamed(request.progress), report);
  if (!measured) return measured.error();
  ExitCode code = ExitCode::kOk;
  if (has_baseline) {
    const Yardstick yardstick = request.absolute ? Yardstick::kSeconds : Yardstick::kCalibrated;
    code = JudgeRows(baseline.value(), yardstick, report);
  }
  if (const Status written = WriteReport(request.json, report); !written) return written.error();
  if (!request.json.empty()) WarnOfNoise(report);
  return code;
}

}  // namespace

Command BenchCommand() { return MakeCommand(&AddBenchOptions, &RunBench); }

}  // namespace sheaf
