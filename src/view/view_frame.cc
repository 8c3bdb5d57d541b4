#include "src/view/view_frame.h"

namespace sheaf {

const char* ShownName(Shown shown) {
  static constexpr const char* kNames[] = {"colour", "depth", "normal", "albedo",
                                           "id",     "heat",  "lanes"};
  return kNames[static_cast<int>(shown)];
}

std::optional<Layer> LayerOf(Shown shown) {
  switch (shown) {
    case Shown::kDepth:
      return Layer::kDepth;
    case Shown::kNormal:
      return Layer::kNormal;
    case Shown::kAlbedo:
      return Layer::kAlbedo;
    case Shown::kId:
      return Layer::kId;
    case Shown::kHeat:
    case Shown::kLanes:
      return Layer::kHeat;
    default:
      return std::nullopt;
  }
}

RenderOptions OptionsOf(const ViewRequest& request, const FrameJob& job) {
  RenderOptions options;
  options.width = job.width;
  options.height = job.height;
  options.samples = job.samples;
  options.max_depth = request.max_depth;
  options.integrator = request.integrator;
  options.contrast = request.contrast;
  options.min_throughput = request.min_throughput;
  options.precision = request.precision;
  options.target = request.target;
  options.threads = request.threads;
  if (const std::optional<Layer> layer = LayerOf(request.shown)) options.layers.Add(*layer);
  return options;
}

}  // namespace sheaf
