#include "src/render/check_options.h"

#include <fmt/format.h>

#include <cmath>
#include <string>

#include "src/render/render_rounds.h"

namespace sheaf {
namespace {

// What is wrong with the options, or nothing.
std::string Complaint(const RenderOptions& options) {
  const struct {
    const char* name;
    int value, low, high;
  } kNumbers[] = {
      {"width", options.width, 1, kMaxImageSide},
      {"height", options.height, 1, kMaxImageSide},
      {"samples", options.samples, 1, kMaxSamples},
      {"tile size", options.tile_size, 1, kMaxTileSize},
      {"band rows", options.band_rows, 0, kMaxImageSide},
      {"threads", options.threads, 0, kMaxThreads},
      {"max depth", options.max_depth, 0, kMaxDepth},
  };
  for (const auto& number : kNumbers) {
    if (number.value < number.low || number.value > number.high) {
      return fmt::format("{} must lie in [{}, {}]", number.name, number.low, number.high);
    }
  }
  if (!(options.min_throughput >= 0 && options.min_throughput <= 1)) {
    return "min throughput must lie in [0, 1]";
  }
  if (options.contrast && !(*options.contrast >= 0 && *options.contrast <= 1)) {
    return "contrast must lie in [0, 1]";
  }
  if (options.error && !(*options.error > 0 && *options.error <= 1)) {
    return "error must lie in (0, 1]";
  }
  if (options.budget && !(*options.budget > 0 && std::isfinite(*options.budget))) {
    return "budget must be a number of seconds above 0";
  }
  const char* const goal = options.budget ? "budget" : options.error ? "error" : nullptr;
  if (goal && options.samples < kLeastErrorSamples) {
    return fmt::format("{} needs {} samples or more",
                       options.budget ? "a budget" : "an error to reach", kLeastErrorSamples);
  }
  if (goal && options.contrast) return fmt::format("contrast and {} exclude each other", goal);
  if (options.precision == Precision::kFast && options.target.is_scalar()) {
    return "fast precision needs a SIMD target";
  }
  if (options.crop) {
    const PixelRect& crop = *options.crop;
    if (crop.x0 < 0 || crop.y0 < 0 || crop.x1 > options.width || crop.y1 > options.height ||
        crop.width() <= 0 || crop.height() <= 0) {
      return "crop must be a non-empty rectangle inside the picture";
    }
  }
  return {};
}

}  // namespace

Result<RenderOptions> CheckOptions(const RenderOptions& options, const Settings& settings) {
  RenderOptions checked = options;
  const auto settle = [](int& option, int setting) {
    if (option == kFromScene) option = setting;
  };
  // Sampling is the scene's or the caller's as a whole.
  const bool has_goal = options.contrast || options.error || options.budget;
  if (options.samples == kFromScene && !has_goal) {
    checked.contrast = settings.contrast;
    checked.error = settings.error;
  }
  settle(checked.width, settings.width);
  settle(checked.height, settings.height);
  settle(checked.samples, options.budget ? kMaxSamples : settings.samples);
  settle(checked.max_depth, settings.max_depth);
  if (std::string complaint = Complaint(checked); !complaint.empty()) {
    return Error{ErrorKind::kUsage, std::move(complaint)};
  }
  if (checked.budget && !checked.error) checked.error = kLeastGoal;
  return checked;
}

}  // namespace sheaf
