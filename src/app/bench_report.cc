#include "src/app/bench_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>

#include "sheaf/version.h"
#include "src/app/json_text.h"
#include "src/formats/printable.h"
#include "src/lab/rank_statistics.h"

namespace sheaf {
namespace {

using Json = nlohmann::ordered_json;

// Rays a second: the median, and the ends of its interval.
struct Rate {
  double median, low, high;
  bool is_range;  // too few repetitions for an interval: the range of all
};

Rate RateOf(const BenchRow& row) {
  const auto rate = [&](double seconds) { return static_cast<double>(row.rays) / seconds; };
  const Interval interval = MedianInterval(row.seconds);
  return {rate(Median(row.seconds)), rate(interval.high), rate(interval.low),
          row.seconds.size() < kLeastForInterval};
}

// How many times as fast as the scalar baseline.
double OverScalar(const BenchRow& row, const BenchRow& scalar) {
  return 1 / Median(InScalars(row, scalar));
}

std::string RowsText(const BenchReport& report) {
  const bool judged = !report.rows.front().verdict.empty();
  const bool is_range = RateOf(report.rows.front()).is_range;
  std::string text = fmt::format("{:12}{:>8}{:>6}{:>9}  {:17}{:>9}{}\n", "target", "threads",
                                 "lanes", "Mray/s", is_range ? " range of all" : " 95 % interval",
                                 "x scalar", judged ? "  against the baseline" : "");
  const auto out = std::back_inserter(text);
  for (const BenchRow& row : report.rows) {
    const Rate rate = RateOf(row);
    fmt::format_to(out, "{:12}{:>8}{:>6}{:>9.2f}  {:17}", row.target, row.threads, row.lanes,
                   rate.median * 1e-6,
                   fmt::format("{:.2f} to {:.2f}", rate.low * 1e-6, rate.high * 1e-6));
    const BenchRow* scalar = FindRow(report, "scalar", row.threads);
    fmt::format_to(out, "{:>9}", scalar ? fmt::format("{:.2f}", OverScalar(row, *scalar)) : "");
    if (judged) fmt::format_to(out, "  {}", row.verdict);
    text += "\n";
  }
  return text;
}

// Milliseconds of processor time a phase, medians.
std::string PhasesText(const BenchReport& report) {
  std::string text = fmt::format("\n{:12}{:>8}", "ms a phase", "threads");
  const auto out = std::back_inserter(text);
  for (int i = 0; i < kPhases; ++i) {
    fmt::format_to(out, "{:>11}", PhaseName(static_cast<Phase>(i)));
  }
  text += "\n";
  for (const BenchRow& row : report.rows) {
    if (row.target == "scalar") continue;  // it has no phases
    fmt::format_to(out, "{:12}{:>8}", row.target, row.threads);
    for (const std::vector<double>& seconds : row.phases) {
      fmt::format_to(out, "{:>11.2f}", 1e3 * Median(seconds));
    }
    text += "\n";
  }
  return text;
}

Json RowJson(const BenchRow& row, const BenchRow* scalar) {
  const Rate rate = RateOf(row);
  Json json = {{"target", row.target},
               {"threads", row.threads},
               {"lanes", row.lanes},
               {"rays", row.rays},
               {"rays_per_second",
                {{"median", rate.median},
                 {"low", rate.low},
                 {"high", rate.high},
                 {"interval", rate.is_range ? "range" : "95 %"}}},
               {"seconds", row.seconds},
               {"calibration", row.calibration},
               {"page_faults", row.page_faults}};
  if (scalar != nullptr) json["over_scalar"] = OverScalar(row, *scalar);
  if (row.target != "scalar") {
    for (int i = 0; i < kPhases; ++i) {
      json["phases"][PhaseName(static_cast<Phase>(i))] = row.phases[i];
    }
  }
  if (!row.verdict.empty()) json["verdict"] = row.verdict;
  return json;
}

bool HasNumber(const Json& json, const char* key) {
  return json.contains(key) && json[key].is_number_integer();
}

bool HasText(const Json& json, const char* key) {
  return json.contains(key) && json[key].is_string();
}

// Null where the row is sound, else what is wrong.
const char* ParseRow(const Json& json, BenchRow& row) {
  const bool sound = json.is_object() && HasText(json, "target") && HasNumber(json, "threads") &&
                     HasNumber(json, "rays") && json.contains("seconds") &&
                     json["seconds"].is_array() && !json["seconds"].empty();
  if (!sound) return "a row without target, threads, rays or seconds";
  row.target = json["target"].get<std::string>();
  row.threads = json["threads"].get<int>();
  row.rays = json["rays"].get<std::uint64_t>();
  for (const Json& seconds : json["seconds"]) {
    if (!seconds.is_number() || !(seconds.get<double>() > 0)) return "bad seconds";
    row.seconds.push_back(seconds.get<double>());
  }
  const Json calibration = json.value("calibration", Json::array());
  for (const Json& seconds : calibration) {
    if (!seconds.is_number() || !(seconds.get<double>() > 0)) return "bad calibration";
    row.calibration.push_back(seconds.get<double>());
  }
  return nullptr;
}

Machine ParseMachine(const Json& json) {
  const auto text = [&](const char* key) {
    return HasText(json, key) ? json[key].get<std::string>() : std::string();
  };
  return {text("processor"), HasNumber(json, "cores") ? json["cores"].get<int>() : 0,
          text("affinity"),  text("compiler"),
          text("flags"),     text("build_type")};
}

}  // namespace

const BenchRow* FindRow(const BenchReport& report, const std::string& target, int threads) {
  for (const BenchRow& row : report.rows) {
    if (row.target == target && row.threads == threads) return &row;
  }
  return nullptr;
}

std::vector<double> InScalars(const BenchRow& row, const BenchRow& scalar) {
  std::vector<double> ratios;
  for (std::size_t i = 0; i < std::min(row.seconds.size(), scalar.seconds.size()); ++i) {
    ratios.push_back(row.seconds[i] / scalar.seconds[i]);
  }
  return ratios;
}

void AddMachine(const Machine& machine, Json* json) {
  (*json)["processor"] = machine.processor;
  (*json)["cores"] = machine.cores;
  (*json)["affinity"] = machine.affinity;
  (*json)["compiler"] = machine.compiler;
  (*json)["flags"] = machine.flags;
  (*json)["build_type"] = machine.build_type;
  (*json)["load"] = LoadAverage();
}

std::string BenchText(const BenchReport& report) { return RowsText(report) + PhasesText(report); }

std::string BenchJson(const BenchReport& report) {
  Json json = {{"sheaf", kVersion},        {"date", Today()},       {"scene", report.scene},
               {"camera", report.camera},  {"width", report.width}, {"height", report.height},
               {"samples", report.samples}};
  AddMachine(report.machine, &json);
  json["other_cores"] = report.other_cores;
  for (const BenchRow& row : report.rows) {
    json["rows"].push_back(RowJson(row, FindRow(report, "scalar", row.threads)));
  }
  return JsonText(json);
}

Result<BenchReport> ParseBenchJson(const std::string& path, const std::string& text) {
  const Json json = Json::parse(text, nullptr, false);
  const auto malformed = [&](const char* what) {
    return Error{ErrorKind::kInputOutput,
                 fmt::format("{}: not what --json writes: {}", PrintablePath(path), what)};
  };
  if (json.is_discarded() || !json.is_object()) return malformed("no JSON object");
  if (!HasText(json, "scene")) return malformed("no scene");
  if (!HasText(json, "camera")) return malformed("no camera");
  for (const char* key : {"width", "height", "samples"}) {
    if (!HasNumber(json, key)) return malformed("no size or samples");
  }
  if (!json.contains("rows") || !json["rows"].is_array()) return malformed("no rows");
  BenchReport report;
  report.scene = json["scene"].get<std::string>();
  report.camera = json["camera"].get<std::string>();
  report.width = json["width"].get<int>();
  report.height = json["height"].get<int>();
  report.samples = json["samples"].get<int>();
  report.machine = ParseMachine(json);
  const bool tells = json.contains("other_cores") && json["other_cores"].is_number();
  report.other_cores = tells ? json["other_cores"].get<double>() : 0.0;
  for (const Json& row : json["rows"]) {
    if (const char* wrong = ParseRow(row, report.rows.emplace_back())) return malformed(wrong);
  }
  return report;
}

}  // namespace sheaf
