// What a frame took: rays, time by phase, use of vector lanes.
#ifndef SHEAF_SHEAF_STATS_H_
#define SHEAF_SHEAF_STATS_H_

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "sheaf/film.h"

namespace sheaf {

// Reflected and refracted rays are counted where they are spawned. Of these, `beyond_depth` are
// deeper than the limit: black, and not traced.
struct RayCounts {
  std::uint64_t primary = 0, shadow = 0, reflected = 0, refracted = 0;
  std::uint64_t beyond_depth = 0;
  std::uint64_t traced() const { return primary + shadow + reflected + refracted - beyond_depth; }
  RayCounts& operator+=(const RayCounts& other) {
    primary += other.primary;
    shadow += other.shadow;
    reflected += other.reflected;
    refracted += other.refracted;
    beyond_depth += other.beyond_depth;
    return *this;
  }
};

enum class Phase {
  kGenerate,
  kTrace,
  kBin,
  kSurface,
  kShade,
  kShadow,
  kSpawn,
  kAccumulate,
  kCount
};
const char* PhaseName(Phase phase);  // lower case, e.g. "trace"

// How full the vectors of a phase's kernels were: of `lanes` that ran, `live` had something to do.
struct LaneUse {
  std::uint64_t batches = 0, live = 0, lanes = 0;
  LaneUse& operator+=(const LaneUse& other) {
    batches += other.batches;
    live += other.live;
    lanes += other.lanes;
    return *this;
  }
};

// What one tile took.
struct TileCost {
  PixelRect tile;  // in picture coordinates
  std::uint64_t rays = 0;
  LaneUse lane_use;  // of all phases; not of the baseline
  double seconds = 0;
};

// Microseconds a pixel, the share of live lanes, rays a pixel: Layer::kHeat of its pixels.
std::array<float, 3> HeatOf(const TileCost& cost);

struct RenderStats {
  RayCounts rays;
  double wall_seconds = 0.0;     // of the frame, without compilation and without waits for a sink
  double compile_seconds = 0.0;  // Scene to flat arrays
  double phase_seconds[static_cast<int>(Phase::kCount)] =
      {};  // summed over threads; not of the baseline
  LaneUse lane_use[static_cast<int>(Phase::kCount)] =
      {};                       // summed over threads; not of the baseline
  std::vector<TileCost> tiles;  // thread by thread
  int threads = 0;              // that took part
  std::string target;           // what ran: "scalar" or a SIMD target's name
  std::uint32_t primitives = 0, spheres = 0, triangles = 0;
};

}  // namespace sheaf

#endif  // SHEAF_SHEAF_STATS_H_
