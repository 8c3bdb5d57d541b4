#include "src/app/bench_command.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <utility>

#include "sheaf/render.h"
#include "sheaf/target.h"
#include "sheaf/version.h"
#include "src/app/add_options.h"
#include "src/app/interrupt.h"
#include "src/app/json_text.h"
#include "src/app/progress.h"
#include "src/app/standard_output.h"
#include "src/core/atomic_file.h"
#include "src/core/build_info.h"
#include "src/formats/printable.h"
#include "src/lab/rank_statistics.h"

namespace sheaf {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kSignificance = 0.01;    // p below which a difference is one
constexpr double kSmallestChange = 0.01;  // of the median; less is no change, however sure
constexpr double kNoise = 0.1;            // spread of a row above which nothing is said of it
constexpr int kPhases = static_cast<int>(Phase::kCount);

// ---- Measuring ----

struct Row {
  std::string target;
  int threads;
  std::size_t lanes = 1;
  std::uint64_t rays = 0;
  std::vector<double> seconds;          // by repetition
  std::vector<double> phases[kPhases];  // the same; summed over threads
};

Result<RenderStats> RenderOnce(const Scene& scene, const Camera& camera, RenderOptions options,
                               Row& row) {
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
              std::vector<Row>& rows) {
  for (Row& row : rows) {
    const Result<RenderStats> stats = RenderOnce(scene, camera, options, row);
    if (!stats) return stats.error();
    row.rays = stats.value().rays.traced();
  }
  return Done{};
}

// Every repetition takes each row once, beginning with another one: a drift of the clock meets all
// alike.
Status Measure(const Scene& scene, const Camera& camera, const RenderOptions& options,
               int repetitions, std::vector<Row>& rows) {
  for (int repetition = 0; repetition < repetitions; ++repetition) {
    for (std::size_t i = 0; i < rows.size(); ++i) {
      Row& row = rows[(i + static_cast<std::size_t>(repetition + 1)) % rows.size()];
      const Result<RenderStats> stats = RenderOnce(scene, camera, options, row);
      if (!stats) return stats.error();
      row.seconds.push_back(stats.value().wall_seconds);
      for (int k = 0; k < kPhases; ++k) row.phases[k].push_back(stats.value().phase_seconds[k]);
    }
  }
  return Done{};
}

const Row* ScalarRow(const std::vector<Row>& rows, int threads) {
  for (const Row& row : rows) {
    if (row.target == "scalar" && row.threads == threads) return &row;
  }
  return nullptr;
}

// What a row took in each repetition, in times of the scalar baseline next to it.
std::vector<double> InScalars(const std::vector<double>& seconds,
                              const std::vector<double>& scalar) {
  std::vector<double> ratios;
  for (std::size_t i = 0; i < std::min(seconds.size(), scalar.size()); ++i) {
    ratios.push_back(seconds[i] / scalar[i]);
  }
  return ratios;
}

// ---- Reporting ----

Json RowJson(const Row& row, const Row* scalar) {
  const auto rate = [&](double seconds) { return static_cast<double>(row.rays) / seconds; };
  const Interval interval = MedianInterval(row.seconds);
  Json json = {{"target", row.target},
               {"threads", row.threads},
               {"lanes", row.lanes},
               {"rays", row.rays},
               {"rays_per_second",
                {{"median", rate(Median(row.seconds))},
                 {"low", rate(interval.high)},
                 {"high", rate(interval.low)},
                 {"interval", row.seconds.size() < kLeastForInterval ? "range" : "95 %"}}},
               {"seconds", row.seconds}};
  if (scalar != nullptr) {
    json["over_scalar"] = 1 / Median(InScalars(row.seconds, scalar->seconds));
  }
  if (row.target == "scalar") return json;
  for (int i = 0; i < kPhases; ++i) {
    json["phases"][PhaseName(static_cast<Phase>(i))] = row.phases[i];
  }
  return json;
}

std::string RowsText(const Json& report) {
  const bool judged = report["rows"][0].contains("verdict");
  const bool is_range = report["rows"][0]["rays_per_second"]["interval"] == "range";
  std::string text = fmt::format("{:12}{:>8}{:>6}{:>9}  {:17}{:>9}{}\n", "target", "threads",
                                 "lanes", "Mray/s", is_range ? " range of all" : " 95 % interval",
                                 "x scalar", judged ? "  against the baseline" : "");
  const auto out = std::back_inserter(text);
  for (const Json& row : report["rows"]) {
    const Json& rate = row["rays_per_second"];
    const auto mega = [&](const char* key) { return rate[key].get<double>() * 1e-6; };
    fmt::format_to(out, "{:12}{:>8}{:>6}{:>9.2f}  {:17}", row["target"].get<std::string>(),
                   row["threads"].get<int>(), row["lanes"].get<int>(), mega("median"),
                   fmt::format("{:.2f} to {:.2f}", mega("low"), mega("high")));
    if (row.contains("over_scalar")) {
      fmt::format_to(out, "{:>9.2f}", row["over_scalar"].get<double>());
    } else {
      fmt::format_to(out, "{:>9}", "");
    }
    if (judged) fmt::format_to(out, "  {}", row["verdict"].get<std::string>());
    text += "\n";
  }
  return text;
}

// Milliseconds of processor time a phase, medians.
std::string PhasesText(const Json& report) {
  std::string text = fmt::format("\n{:12}{:>8}", "ms a phase", "threads");
  const auto out = std::back_inserter(text);
  for (int i = 0; i < kPhases; ++i) {
    fmt::format_to(out, "{:>11}", PhaseName(static_cast<Phase>(i)));
  }
  text += "\n";
  for (const Json& row : report["rows"]) {
    if (!row.contains("phases")) continue;
    fmt::format_to(out, "{:12}{:>8}", row["target"].get<std::string>(), row["threads"].get<int>());
    for (const Json& seconds : row["phases"]) {
      fmt::format_to(out, "{:>11.2f}", 1e3 * Median(seconds.get<std::vector<double>>()));
    }
    text += "\n";
  }
  return text;
}

// ---- The verdict ----

Result<Json> ReadBaseline(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    return Error{ErrorKind::kInputOutput, fmt::format("{}: cannot be read", PrintablePath(path))};
  }
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  Json json = Json::parse(text, nullptr, false);
  const auto malformed = [&](const char* what) {
    return Error{ErrorKind::kInputOutput,
                 fmt::format("{}: not what --json writes: {}", PrintablePath(path), what)};
  };
  if (json.is_discarded() || !json.is_object()) return malformed("no JSON object");
  for (const char* key : {"camera", "width", "height", "samples"}) {
    if (!json.contains(key)) return malformed("a key is missing");
  }
  if (!json.contains("scene") || !json["scene"].is_string()) return malformed("no scene");
  if (!json.contains("rows") || !json["rows"].is_array()) return malformed("no rows");
  for (const Json& row : json["rows"]) {
    const bool sound = row.is_object() && row.contains("target") && row["target"].is_string() &&
                       row.contains("threads") && row["threads"].is_number_integer() &&
                       row.contains("rays") && row["rays"].is_number_integer() &&
                       row.contains("seconds") && row["seconds"].is_array() &&
                       !row["seconds"].empty();
    if (!sound) return malformed("a row without target, threads, rays or seconds");
    for (const Json& seconds : row["seconds"]) {
      if (!seconds.is_number() || !(seconds.get<double>() > 0)) return malformed("bad seconds");
    }
  }
  return json;
}

Error OtherFrame(const std::string& path, const char* what, const Json& before, const Json& now) {
  return Usage(fmt::format("--baseline {}: its {} is {}, here it is {}", PrintablePath(path), what,
                           before.dump(), now.dump()));
}

// A scene may lie elsewhere by now, but goes by its name.
std::string SceneName(const Json& report) {
  return std::filesystem::path(report["scene"].get<std::string>()).filename().string();
}

Status CheckSameFrame(const std::string& path, const Json& now, const Json& before) {
  if (SceneName(now) != SceneName(before)) {
    return OtherFrame(path, "scene", SceneName(before), SceneName(now));
  }
  for (const char* key : {"camera", "width", "height", "samples"}) {
    if (now[key] != before[key]) return OtherFrame(path, key, before[key], now[key]);
  }
  return Done{};
}

// Another viewpoint or scene of the same name shows in what it traces, which no target changes.
Status CheckSameRays(const std::string& path, std::uint64_t rays, const Json& before) {
  for (const Json& row : before["rows"]) {
    if (row["rays"] != rays) return OtherFrame(path, "number of rays", row["rays"], rays);
  }
  return Done{};
}

const Json* FindRow(const Json& rows, const std::string& target, int threads) {
  for (const Json& row : rows) {
    if (row["target"] == target && row["threads"] == threads) return &row;
  }
  return nullptr;
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

// The scalar baseline is the yardstick of the others, whatever the clock did between two runs.
Verdict JudgeRow(const Json& row, const Json& now, const Json& before, bool absolute) {
  const std::string target = row["target"];
  const int threads = row["threads"];
  const Json* old_row = FindRow(before["rows"], target, threads);
  if (old_row == nullptr) return {"not in the baseline"};
  const auto seconds_of = [](const Json& r) { return r["seconds"].get<std::vector<double>>(); };
  if (absolute) return JudgeSamples(seconds_of(*old_row), seconds_of(row));
  const Json* scalar = FindRow(now["rows"], "scalar", threads);
  const Json* old_scalar = FindRow(before["rows"], "scalar", threads);
  if (scalar == nullptr || old_scalar == nullptr) {
    return JudgeSamples(seconds_of(*old_row), seconds_of(row));
  }
  if (target == "scalar") return {"the yardstick"};
  return JudgeSamples(InScalars(seconds_of(*old_row), seconds_of(*old_scalar)),
                      InScalars(seconds_of(row), seconds_of(*scalar)));
}

}  // namespace

CLI::App* AddBenchCommand(CLI::App& app, BenchRequest& request) {
  CLI::App* bench = app.add_subcommand("bench", "Time a scene on every SIMD target");
  bench->add_option("SCENE", request.scene, "The scene file")->required()->option_text(" ");
  AddSceneOptions(*bench, request.options);
  bench->add_option("--camera", request.camera, "The camera; the scene's first if absent")
      ->option_text("NAME");
  AddSize(*bench, request.size);
  AddInteger(*bench, "--spp", request.samples, 1, kMaxSamples, "Samples a pixel");
  AddTargets(*bench, request.targets, "What renders; all: every usable one and scalar");
  AddThreads(*bench, request.threads);
  AddInteger(*bench, "--repetitions", request.repetitions, 1, 1000,
             "Frames of each row, taken in turn; 9 if absent, from 6 with a 95 % interval");
  AddPath(*bench, "--baseline", request.baseline, "FILE",
          "A file that --json wrote, to judge against");
  bench->add_flag("--absolute", request.absolute,
                  "Judge seconds, not ratios to the scalar baseline of the same run");
  AddJson(*bench, request.json, "The result as JSON to stdout, or into FILE");
  return bench;
}

Result<ExitCode> RunBench(const BenchRequest& request) {
  Result<Json> baseline = Json();
  if (!request.baseline.empty()) baseline = ReadBaseline(request.baseline);
  if (!baseline) return baseline.error();
  const bool has_file = !request.json.empty() && request.json != "-";
  if (has_file) {
    if (const Status writable = CheckWritable(request.json); !writable) return writable.error();
  }
  std::vector<Row> rows;
  const Result<std::vector<std::string>> targets = ExpandTargets(request.targets);
  if (!targets) return targets.error();
  for (const int threads : request.threads) {
    for (const std::string& target : targets.value()) {
      rows.push_back({target, threads, 1, 0, {}, {}});
    }
  }
  const Result<OpenedScene> opened = OpenSceneAndFiles(request.scene, request.options);
  if (!opened) return opened.error();
  const Scene& scene = opened.value().scene;
  std::vector<std::string> inputs = opened.value().files;
  inputs.push_back(request.baseline);
  const Status apart = CheckOutputs({{"--json", request.json}}, inputs);
  if (!apart) return apart.error();
  CameraChoice choice;
  if (!request.camera.empty()) choice.cameras = {request.camera};
  const auto cameras = ChooseCameras(choice, request.options, request.scene, scene);
  if (!cameras) return cameras.error();
  const Camera& camera = *cameras.value().front();
  RenderOptions options = FrameOptions(scene.settings, request.size, request.samples);
  options.timing = Timing::kOn;

  Json report = {{"sheaf", kVersion},          {"scene", request.scene},
                 {"camera", camera.name},      {"width", options.width},
                 {"height", options.height},   {"samples", options.samples},
                 {"compiler", CompilerName()}, {"build_type", BuildTypeName()}};
  if (!request.baseline.empty()) {
    const Status same = CheckSameFrame(request.baseline, report, baseline.value());
    if (!same) return same.error();
  }
  CatchInterrupts();
  const Status warm = WarmUp(scene, camera, options, rows);
  if (!warm) return warm.error();
  if (!request.baseline.empty()) {
    const Status same = CheckSameRays(request.baseline, rows.front().rays, baseline.value());
    if (!same) return same.error();
  }
  const Status measured = Measure(scene, camera, options, request.repetitions.value_or(9), rows);
  if (!measured) return measured.error();
  for (const Row& row : rows) {
    report["rows"].push_back(RowJson(row, ScalarRow(rows, row.threads)));
  }
  ExitCode code = ExitCode::kOk;
  if (!request.baseline.empty()) {
    for (Json& row : report["rows"]) {
      const Verdict verdict = JudgeRow(row, report, baseline.value(), request.absolute);
      row["verdict"] = verdict.text;
      if (verdict.is_slower) code = ExitCode::kDifferent;
    }
  }
  const std::string json = JsonText(report);
  if (has_file) {
    if (const Status written = WriteFileWhole(request.json, json); !written) return written.error();
  }
  const Status written =
      WriteStandardOutput(request.json == "-" ? json : RowsText(report) + PhasesText(report));
  if (!written) return written.error();
  return code;
}

}  // namespace sheaf
