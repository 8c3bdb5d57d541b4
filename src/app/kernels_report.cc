#include "src/app/kernels_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>
#include <optional>

#include "sheaf/version.h"
#include "src/app/bench_report.h"
#include "src/app/json_text.h"
#include "src/lab/rank_statistics.h"

namespace sheaf {
namespace {

using Json = nlohmann::ordered_json;

// How many times as fast as the baseline, measured beside it; nothing without one.
std::optional<double> OverScalar(const KernelRow& row, const KernelTime& time) {
  for (const KernelTime& scalar : row.times) {
    if (scalar.target != "scalar") continue;
    std::vector<double> ratios;
    for (std::size_t i = 0; i < time.nanoseconds.size(); ++i) {
      ratios.push_back(scalar.nanoseconds[i] / time.nanoseconds[i]);
    }
    return Median(ratios);
  }
  return std::nullopt;
}

double LanesInUse(const KernelRow& row, const KernelTime& time) {
  return time.lanes == 1 ? 1 : row.live * time.lanes;
}

}  // namespace

std::string KernelsText(const std::vector<KernelRow>& rows) {
  const bool is_range = rows.front().times.front().nanoseconds.size() < kLeastForInterval;
  std::string text = fmt::format("{:19}{:12}{:>9}  {:18}{:>9}{:>14}  {}\n", "kernel", "target",
                                 "ns", is_range ? " range of all" : " 95 % interval", "x scalar",
                                 "lanes in use", "an element is a");
  const auto out = std::back_inserter(text);
  for (const KernelRow& row : rows) {
    bool is_first = true;
    for (const KernelTime& time : row.times) {
      const Interval interval = MedianInterval(time.nanoseconds);
      const std::optional<double> over = OverScalar(row, time);
      fmt::format_to(out, "{:19}{:12}{:>9.2f}  {:18}{:>9}{:>14}{}\n", is_first ? row.kernel : "",
                     time.target, Median(time.nanoseconds),
                     fmt::format("{:.2f} to {:.2f}", interval.low, interval.high),
                     over ? fmt::format("{:.2f}", *over) : "",
                     fmt::format("{:.1f} of {}", LanesInUse(row, time), time.lanes),
                     is_first ? "  " + row.element : "");
      is_first = false;
    }
  }
  return text;
}

std::string KernelsJson(const std::vector<KernelRow>& rows, const Machine& machine) {
  Json json = {{"sheaf", kVersion}, {"date", Today()}};
  AddMachine(machine, &json);
  json["kernels"] = Json::array();
  for (const KernelRow& row : rows) {
    Json kernel = {{"kernel", row.kernel}, {"element", row.element}, {"targets", Json::array()}};
    for (const KernelTime& time : row.times) {
      const Interval interval = MedianInterval(time.nanoseconds);
      Json target = {{"target", time.target},
                     {"lanes", time.lanes},
                     {"lanes_in_use", LanesInUse(row, time)},
                     {"nanoseconds",
                      {{"median", Median(time.nanoseconds)},
                       {"low", interval.low},
                       {"high", interval.high},
                       {"repetitions", time.nanoseconds}}}};
      if (const auto over = OverScalar(row, time)) target["over_scalar"] = *over;
      kernel["targets"].push_back(target);
    }
    json["kernels"].push_back(kernel);
  }
  return JsonText(json);
}

}  // namespace sheaf
