#include "src/app/bench_baseline.h"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <utility>
#include <vector>

#include "src/app/choose.h"
#include "src/formats/printable.h"

namespace sheaf {
namespace {

// kUsage where the two differ.
template <typename T>
Status CheckSame(const std::string& path, const char* what, const T& before, const T& now) {
  if (before == now) return Done{};
  return Usage(fmt::format("--baseline {}: its {} is {}, here it is {}", PrintablePath(path), what,
                           before, now));
}

std::string InQuotes(const std::string& name) { return fmt::format("\"{}\"", Printable(name)); }

// A scene may lie elsewhere by now, but goes by its name.
std::string SceneName(const BenchReport& report) {
  return InQuotes(std::filesystem::path(report.scene).filename().string());
}

TimedRun RunOf(const BenchRow& row, const BenchReport& report) {
  return {row.seconds, row.calibration, row.threads, report.other_cores};
}

}  // namespace

Result<BenchReport> ReadBaseline(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    return Error{ErrorKind::kInputOutput, fmt::format("{}: cannot be read", PrintablePath(path))};
  }
  return ParseBenchJson(path, {std::istreambuf_iterator<char>(file), {}});
}

Status CheckSameFrame(const std::string& path, const BenchReport& now, const BenchReport& before) {
  Status same = CheckSame(path, "scene", SceneName(before), SceneName(now));
  if (same) same = CheckSame(path, "camera", InQuotes(before.camera), InQuotes(now.camera));
  if (same) same = CheckSame(path, "width", before.width, now.width);
  if (same) same = CheckSame(path, "height", before.height, now.height);
  if (same) same = CheckSame(path, "samples", before.samples, now.samples);
  return same;
}

Status CheckSameRays(const std::string& path, std::uint64_t rays, const BenchReport& before) {
  for (const BenchRow& row : before.rows) {
    const Status same = CheckSame(path, "number of rays", row.rays, rays);
    if (!same) return same;
  }
  return Done{};
}

Status CheckSameMachine(const std::string& path, const Machine& now, const Machine& before) {
  Status same = CheckSame(path, "processor", InQuotes(before.processor), InQuotes(now.processor));
  if (same) same = CheckSame(path, "number of cores", before.cores, now.cores);
  if (same) same = CheckSame(path, "affinity", InQuotes(before.affinity), InQuotes(now.affinity));
  if (same) same = CheckSame(path, "compiler", InQuotes(before.compiler), InQuotes(now.compiler));
  if (same) same = CheckSame(path, "flags", InQuotes(before.flags), InQuotes(now.flags));
  if (same) {
    same = CheckSame(path, "build type", InQuotes(before.build_type), InQuotes(now.build_type));
  }
  if (same) return same;
  return Usage(same.error().message + " (--force judges all the same)");
}

ExitCode JudgeRows(const BenchReport& before, Yardstick yardstick, BenchReport& now) {
  const int cores = UsableCores();
  ExitCode code = ExitCode::kOk;
  for (BenchRow& row : now.rows) {
    const BenchRow* old_row = FindRow(before, row.target, row.threads);
    if (old_row == nullptr) {
      row.verdict = "not in the baseline";
      continue;
    }
    Judgement judgement = JudgeTimes(RunOf(*old_row, before), RunOf(row, now), cores, yardstick);
    row.verdict = std::move(judgement.text);
    const bool is_open =
        judgement.finding == Finding::kTooNoisy || judgement.finding == Finding::kTooFew;
    if (judgement.finding == Finding::kSlower) code = ExitCode::kDifferent;
    if (is_open && code == ExitCode::kOk) code = ExitCode::kUndecided;
  }
  return code;
}

std::vector<std::string> DescribeNoise(const BenchReport& report) {
  std::vector<std::string> lines;
  for (const BenchRow& row : report.rows) {
    const std::string noise = DescribeNoise(RunOf(row, report), UsableCores());
    if (!noise.empty()) {
      lines.push_back(fmt::format("{}, {} thread{}: {}", row.target, row.threads,
                                  row.threads == 1 ? "" : "s", noise));
    }
  }
  return lines;
}

}  // namespace sheaf
