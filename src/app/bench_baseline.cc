#include "src/app/bench_baseline.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <utility>
#include <vector>

#include "src/app/choose.h"
#include "src/formats/printable.h"
#include "src/lab/rank_statistics.h"

namespace sheaf {
namespace {

constexpr double kSignificance = 0.01;    // p below which a difference is one
constexpr double kSmallestChange = 0.01;  // of the median; less is no change, however sure
constexpr double kNoise = 0.1;            // spread of a row above which nothing is said of it

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

struct Verdict {
  std::string text;
  bool is_slower = false;
};

Verdict JudgeSamples(const std::vector<double>& before, const std::vector<double>& now) {
  const int m = static_cast<int>(before.size()), n = static_cast<int>(now.size());
  if (SmallestP(m, n) > kSignificance) {
    return {fmt::format("too few repetitions for a verdict ({} and {})", m, n)};
  }
  const double spread = std::max(RelativeSpread(before), RelativeSpread(now));
  if (spread > kNoise) {
    return {fmt::format("too noisy for a verdict (quartiles {:.0f} % apart)", 100 * spread)};
  }
  const double p = MannWhitneyP(before, now);
  const double ratio = Median(now) / Median(before);
  const bool differs = p < kSignificance && std::abs(ratio - 1) >= kSmallestChange;
  const char* word = !differs ? "no change" : ratio > 1 ? "slower" : "faster";
  return {fmt::format("{}, {:+.1f} % time, p = {:.2g}", word, 100 * (ratio - 1), p),
          differs && ratio > 1};
}

Verdict JudgeRow(const BenchRow& row, const BenchReport& now, const BenchReport& before,
                 Yardstick yardstick) {
  const BenchRow* old_row = FindRow(before, row.target, row.threads);
  if (old_row == nullptr) return {"not in the baseline"};
  const BenchRow* scalar = FindRow(now, "scalar", row.threads);
  const BenchRow* old_scalar = FindRow(before, "scalar", row.threads);
  if (yardstick == Yardstick::kSeconds || scalar == nullptr || old_scalar == nullptr) {
    return JudgeSamples(old_row->seconds, row.seconds);
  }
  if (row.target == "scalar") return {"the yardstick"};
  return JudgeSamples(InScalars(*old_row, *old_scalar), InScalars(row, *scalar));
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

ExitCode JudgeRows(const BenchReport& before, Yardstick yardstick, BenchReport& now) {
  ExitCode code = ExitCode::kOk;
  for (BenchRow& row : now.rows) {
    Verdict verdict = JudgeRow(row, now, before, yardstick);
    row.verdict = std::move(verdict.text);
    if (verdict.is_slower) code = ExitCode::kDifferent;
  }
  return code;
}

}  // namespace sheaf
