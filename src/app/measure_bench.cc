#include "src/app/measure_bench.h"

#include <cstddef>

#include "src/app/choose.h"
#include "src/app/interrupt.h"
#include "src/app/machine.h"
#include "src/lab/calibrate.h"

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

}  // namespace

Status WarmUp(const Scene& scene, const Camera& camera, const RenderOptions& options,
              BenchReport& report) {
  KeepFreedMemory();
  for (int frame = 0; frame < 2; ++frame) {
    for (BenchRow& row : report.rows) {
      const Result<RenderStats> stats = RenderOnce(scene, camera, options, row);
      if (!stats) return stats.error();
      row.rays = stats.value().rays.traced();
      CalibrationSeconds(row.threads);
    }
  }
  return Done{};
}

Status Measure(const Scene& scene, const Camera& camera, const RenderOptions& options,
               int repetitions, ProgressStyle style, BenchReport& report) {
  std::vector<BenchRow>& rows = report.rows;
  StepWatch watch(style, "bench", static_cast<std::uint64_t>(repetitions) * rows.size());
  const OtherProcesses others;
  for (int repetition = 0; repetition < repetitions; ++repetition) {
    for (std::size_t i = 0; i < rows.size(); ++i) {
      BenchRow& row = rows[(i + static_cast<std::size_t>(repetition + 1)) % rows.size()];
      const double before = CalibrationSeconds(row.threads);
      const long faults = PageFaults();
      const Result<RenderStats> stats = RenderOnce(scene, camera, options, row);
      if (!stats) return stats.error();
      row.page_faults += PageFaults() - faults;
      row.calibration.push_back((before + CalibrationSeconds(row.threads)) / 2);
      row.seconds.push_back(stats.value().wall_seconds);
      for (int k = 0; k < kPhases; ++k) row.phases[k].push_back(stats.value().phase_seconds[k]);
      watch.Advance();
    }
  }
  report.other_cores = others.cores();
  return Done{};
}

}  // namespace sheaf
