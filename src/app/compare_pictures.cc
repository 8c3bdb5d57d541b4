#include "src/app/compare_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "src/app/display_picture.h"
#include "src/app/json_text.h"
#include "src/app/progress.h"
#include "src/app/standard_output.h"
#include "src/formats/picture.h"
#include "src/formats/printable.h"
#include "src/lab/picture_metrics.h"

namespace sheaf {
namespace {

using Json = nlohmann::ordered_json;

struct Metric {
  const char* name;
  double (*value)(const PictureMetrics& metrics);
  bool more_is_better;
};

constexpr Metric kMetrics[] = {
    {"rmse", [](const PictureMetrics& m) { return m.rmse; }, false},
    {"psnr", [](const PictureMetrics& m) { return m.psnr; }, true},
    {"largest", [](const PictureMetrics& m) { return m.largest; }, false},
    {"over", [](const PictureMetrics& m) { return static_cast<double>(m.over); }, false},
    {"flip", [](const PictureMetrics& m) { return m.mean_flip; }, false},
};

const Metric* FindMetric(const std::string& name) {
  for (const Metric& metric : kMetrics) {
    if (name == metric.name) return &metric;
  }
  return nullptr;
}

bool IsFinite(const Film& film) {
  return std::all_of(film.rgb.begin(), film.rgb.end(), [](float v) { return std::isfinite(v); });
}

struct Comparison {
  PictureMetrics metrics;
  bool is_finite;  // whether both pictures are
};

// Every limit that is broken. NaN or infinity in either picture breaks all of them.
std::vector<std::string> BrokenLimits(const Comparison& comparison,
                                      const std::vector<std::pair<std::string, double>>& limits) {
  std::vector<std::string> broken;
  if (!comparison.is_finite && !limits.empty()) {
    broken.push_back("NaN or infinity breaks every limit");
  }
  for (const auto& [name, limit] : limits) {
    const Metric* metric = FindMetric(name);
    const double value = metric->value(comparison.metrics);
    if (metric->more_is_better ? !(value >= limit) : !(value <= limit)) {
      broken.push_back(fmt::format("{} {:.6g} breaks the limit of {:g}", name, value, limit));
    }
  }
  return broken;
}

// To two digits; never -0.
double Decibels(double psnr) { return std::round(100 * psnr) / 100 + 0.0; }

// Over the pictures so far.
class RunningMeans {
 public:
  void Add(const PictureMetrics& metrics) {
    ++count_;
    rmse_ += metrics.rmse;
    flip_ += metrics.mean_flip;
  }
  // From the second picture on.
  std::string Text() const {
    if (count_ < 2) return "";
    return fmt::format(" (mean so far: rmse {:.6g}, flip {:.6g})", rmse_ / count_, flip_ / count_);
  }
  Json ToJson() const { return {{"rmse", rmse_ / count_}, {"flip", flip_ / count_}}; }

 private:
  int count_ = 0;
  double rmse_ = 0, flip_ = 0;
};

}  // namespace

bool IsMetric(const std::string& name) { return FindMetric(name) != nullptr; }

Result<ExitCode> ComparePictures(const CompareRequest& request) {
  if (request.inputs.size() < 2) {
    return Usage(
        fmt::format("{}: a second picture is missing", PrintablePath(request.inputs.front())));
  }
  const Transfer transfer = request.transfer == "srgb" ? Transfer::kSrgb : Transfer::kLinear;
  const Result<Film> reference = ReadDisplayValues(request.inputs.front(), transfer);
  if (!reference) return reference.error();
  const bool is_reference_finite = IsFinite(reference.value());
  std::optional<Film> shown_reference;  // clamped, where a picture asks for that
  Json json = {{"reference", request.inputs.front()}, {"pictures", Json::array()}};
  ExitCode code = ExitCode::kOk;
  RunningMeans means;
  StepWatch watch(ProgressStyleNamed(request.progress), "compare", request.inputs.size() - 1);
  for (std::size_t i = 1; i < request.inputs.size(); ++i) {
    const std::string& path = request.inputs[i];
    Result<Film> test = ReadDisplayValues(path, transfer);
    if (!test) return test.error();
    const bool finite = is_reference_finite && IsFinite(test.value());
    const bool is_mixed = HoldsFloats(path) != HoldsFloats(request.inputs.front());
    if (is_mixed && !shown_reference) {
      shown_reference = reference.value();
      ClampToDisplay(*shown_reference);
    }
    if (is_mixed) ClampToDisplay(test.value());
    const Film& a = is_mixed ? *shown_reference : reference.value();
    const Film& b = test.value();
    const Status same = CheckSameSize(path, b, request.inputs.front(), a);
    if (!same) return same.error();
    const PictureMetrics metrics = MeasurePictures(a, b, transfer);
    const std::vector<std::string> broken = BrokenLimits({metrics, finite}, request.limits);
    Json entry = {{"path", path}, {"identical", metrics.largest == 0}, {"finite", finite}};
    // JSON has no infinity: a metric that is not finite becomes null.
    for (const Metric& metric : kMetrics) entry[metric.name] = metric.value(metrics);
    entry["over"] = metrics.over;
    if (!broken.empty()) {
      entry["broken"] = broken;
      code = ExitCode::kDifferent;
    }
    json["pictures"].push_back(entry);
    means.Add(metrics);
    watch.Advance();
    if (request.json) continue;
    watch.Clear();
    const Status written = WriteStandardOutput(fmt::format(
        "{}: rmse {:.6g}, psnr {:.2f} dB, largest error {:.6g}, {} pixels over 1/255, flip "
        "{:.6g}{}{}{}\n",
        PrintablePath(path), metrics.rmse, Decibels(metrics.psnr), metrics.largest, metrics.over,
        metrics.mean_flip, means.Text(), broken.empty() ? "" : "; ", fmt::join(broken, ", ")));
    if (!written) return written.error();
  }
  if (!request.json) return code;
  json["mean"] = means.ToJson();
  const Status written = WriteStandardOutput(JsonText(json));
  if (!written) return written.error();
  return code;
}

}  // namespace sheaf
