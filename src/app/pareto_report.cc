#include "src/app/pareto_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>

#include "sheaf/version.h"
#include "src/app/draw_chart.h"
#include "src/app/json_text.h"
#include "src/core/atomic_file.h"
#include "src/lab/has_program.h"

namespace sheaf {
namespace {

using Json = nlohmann::ordered_json;

// Without a value the field of a table is empty, and null in JSON.
std::string Field(const std::optional<double>& value) {
  return value ? fmt::format("{}", *value) : "";
}

Json JsonValue(const std::optional<double>& value) { return value ? Json(*value) : Json(); }

std::string CsvText(const std::vector<ParetoPoint>& points) {
  std::string text = "renderer,precision,setting,seconds,error,numeric,sampling,front\n";
  const auto out = std::back_inserter(text);
  for (const ParetoPoint& point : points) {
    fmt::format_to(out, "{},{},\"{}\",{},{},{},{},{}\n", point.renderer, point.precision,
                   point.setting, Field(point.seconds), point.error, Field(point.numeric),
                   point.sampling, point.is_on_front ? 1 : 0);
  }
  return text;
}

std::string ReportJson(const ParetoTitle& title, const std::vector<ParetoPoint>& points) {
  Json json = {{"sheaf", kVersion},        {"scene", title.scene},
               {"camera", title.camera},   {"width", title.width},
               {"height", title.height},   {"reference_samples", title.reference_samples},
               {"threads", title.threads}, {"repetitions", title.repetitions},
               {"points", Json::array()}};
  for (const ParetoPoint& point : points) {
    json["points"].push_back({{"renderer", point.renderer},
                              {"precision", point.precision},
                              {"setting", point.setting},
                              {"seconds", JsonValue(point.seconds)},
                              {"error", point.error},
                              {"numeric", JsonValue(point.numeric)},
                              {"sampling", point.sampling},
                              {"front", point.is_on_front}});
  }
  return JsonText(json);
}

// What has a mark of its own on the chart.
std::string Series(const ParetoPoint& point) {
  return point.precision.empty() ? point.renderer : point.renderer + ", " + point.precision;
}

// One mark a setting, a colour a series, and the front as a line of steps.
Status DrawFront(const ParetoTitle& title, const std::vector<ParetoPoint>& points,
                 const std::string& stem) {
  std::set<std::string> series;
  for (const ParetoPoint& point : points) {
    if (point.seconds) series.insert(Series(point));
  }
  std::string text;
  const auto out = std::back_inserter(text);
  const auto block = [&](const std::string& name, auto keep) {
    fmt::format_to(out, "${} << END\n", name);
    std::vector<std::pair<double, double>> rows;
    for (const ParetoPoint& point : points) {
      if (point.seconds && keep(point)) rows.emplace_back(1e3 * *point.seconds, point.error);
    }
    std::sort(rows.begin(), rows.end());
    for (const auto& [milliseconds, error] : rows) {
      fmt::format_to(out, "{} {}\n", milliseconds, error);
    }
    text += "END\n";
  };
  int index = 0;
  std::string plots;
  for (const std::string& name : series) {
    block(fmt::format("r{}", index), [&](const ParetoPoint& p) { return Series(p) == name; });
    plots += fmt::format(", $r{} with points pt {} ps 0.8 title {}", index, 5 + 2 * (index % 5),
                         GnuplotString(name));
    ++index;
  }
  block("front", [](const ParetoPoint& p) { return p.is_on_front; });
  fmt::format_to(
      out,
      "set title {} noenhanced\n"
      "set xlabel \"milliseconds a frame\"\nset ylabel \"error (RMSE)\"\n"
      "set logscale xy\nset grid\nset key outside noenhanced\n",
      GnuplotString(fmt::format(
          "{}, {}, {}x{}, {} thread{}", std::filesystem::path(title.scene).filename().string(),
          title.camera, title.width, title.height, title.threads, title.threads == 1 ? "" : "s")));
  return DrawChart(
      text, fmt::format("plot $front with steps lw 2 lc rgb \"black\" title \"front\"{}\n", plots),
      stem);
}

}  // namespace

void MarkFront(std::vector<ParetoPoint>& points) {
  for (ParetoPoint& point : points) {
    point.is_on_front = std::none_of(points.begin(), points.end(), [&](const ParetoPoint& other) {
      const bool as_good =
          other.seconds && other.seconds <= point.seconds && other.error <= point.error;
      return as_good && (other.seconds < point.seconds || other.error < point.error);
    });
    point.is_on_front = point.is_on_front && point.seconds;
  }
}

const ParetoPoint* CheapestFor(const std::vector<ParetoPoint>& points, double error) {
  const ParetoPoint* best = nullptr;
  for (const ParetoPoint& point : points) {
    if (!point.seconds || point.error > error) continue;
    if (!best || point.seconds < best->seconds) best = &point;
  }
  return best;
}

const ParetoPoint* BestFor(const std::vector<ParetoPoint>& points, double seconds) {
  const ParetoPoint* best = nullptr;
  for (const ParetoPoint& point : points) {
    if (!point.seconds || *point.seconds > seconds) continue;
    if (!best || point.error < best->error) best = &point;
  }
  return best;
}

std::string PointText(const ParetoPoint& point) {
  return fmt::format("{:10} {:48} {:>9.2f} ms  error {:.3g}, numeric {}, sampling {:.3g}\n",
                     point.renderer, point.setting, 1e3 * point.seconds.value_or(0), point.error,
                     point.numeric ? fmt::format("{:.2g}", *point.numeric) : "-", point.sampling);
}

Result<std::vector<std::string>> WriteParetoReport(const ParetoTitle& title,
                                                   const std::vector<ParetoPoint>& points,
                                                   const std::string& stem) {
  std::vector<std::string> paths = {stem + ".csv", stem + ".json"};
  const Status table = WriteFileWhole(paths[0], CsvText(points));
  if (!table) return table.error();
  const Status json = WriteFileWhole(paths[1], ReportJson(title, points));
  if (!json) return json.error();
  if (!HasProgram("gnuplot")) return paths;
  const Status drawn = DrawFront(title, points, stem);
  if (!drawn) return drawn.error();
  paths.insert(paths.end(), {stem + ".svg", stem + ".png"});
  return paths;
}

}  // namespace sheaf
