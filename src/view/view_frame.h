// What the window shows: what is asked for, and the picture that comes of it.
#ifndef SHEAF_VIEW_VIEW_FRAME_H_
#define SHEAF_VIEW_VIEW_FRAME_H_

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sheaf/film.h"
#include "sheaf/render.h"
#include "sheaf/scene.h"
#include "src/view/frame_plan.h"

namespace sheaf {

// What of a frame is shown.
enum class Shown { kColour, kDepth, kNormal, kAlbedo, kId, kHeat, kLanes, kCount };
inline constexpr int kShownCount = static_cast<int>(Shown::kCount);
const char* ShownName(Shown shown);  // "colour", "depth", ..., "lanes"

// The layer that it needs; none for the colours.
std::optional<Layer> LayerOf(Shown shown);

// How light becomes bytes, as in Settings.
struct Development {
  double ev = 0;
  Tone tone = Tone::kLinear;
  bool operator==(const Development&) const = default;
};

// Everything that a picture in the window depends on.
struct ViewRequest {
  std::shared_ptr<const Scene> scene;  // null: nothing is rendered
  Camera camera;
  FrameGoal goal;
  int max_depth = 5;
  Integrator integrator = Integrator::kDistributed;
  std::optional<double> contrast;
  double min_throughput = 0;
  Precision precision = Precision::kStrict;
  Target target;
  std::optional<Target> beside;  // of the right half
  Shown shown = Shown::kColour;
  int threads = 0;
  Development development;
};

// The options for one frame of it, without a crop.
RenderOptions OptionsOf(const ViewRequest& request, const FrameJob& job);

// What a half of the picture, or all of it, took.
struct SideStats {
  std::string target;
  double seconds = 0, compile_seconds = 0;
  std::uint64_t rays = 0;
};

// A picture as the window gets it.
struct ViewPicture {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;  // rows from the top
  FrameJob job;
  bool is_whole = false;     // all rows are of `job`, none of an older frame
  bool is_finished = false;  // nothing finer will come
  double seconds = 0;        // from the frame's start to here
  std::vector<SideStats> sides;
  std::uint64_t number = 0;  // counts pictures
};

}  // namespace sheaf

#endif  // SHEAF_VIEW_VIEW_FRAME_H_
