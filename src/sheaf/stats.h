// What a frame took: rays, time by phase, use of vector lanes. Plain values; nothing here throws.
#ifndef SHEAF_SHEAF_STATS_H_
#define SHEAF_SHEAF_STATS_H_

#include <cstdint>
#include <string>

#include "sheaf/version.h"

namespace sheaf {

// Rays by what they are for.
struct RayCounts {
  std::uint64_t primary = 0, shadow = 0;
  // Counted where they are spawned; diffuse ones by path tracing alone.
  std::uint64_t reflected = 0, refracted = 0, diffuse = 0;
  std::uint64_t beyond_depth = 0;  // of the last three: deeper than the limit, black, not traced

  // How many rays went through the tree.
  std::uint64_t traced() const {
    return primary + shadow + reflected + refracted + diffuse - beyond_depth;
  }
  RayCounts& operator+=(const RayCounts& other) {
    primary += other.primary;
    shadow += other.shadow;
    reflected += other.reflected;
    refracted += other.refracted;
    diffuse += other.diffuse;
    beyond_depth += other.beyond_depth;
    return *this;
  }
};

// The steps of a tile (docs/data-path.md), some of them together.
enum class Phase {
  kGenerate,    // primary rays
  kTrace,       // nearest hits
  kBin,         // hits by material
  kSurface,     // points, normals, textures
  kShade,       // ambient light and what the lights add
  kShadow,      // shadow rays, made and traced
  kSpawn,       // reflected and refracted rays
  kAccumulate,  // colours into samples, pixels and film
  kCount
};

// Lower case: "generate", "trace", "bin", "surface", "shade", "shadow", "spawn", "accumulate".
SHEAF_API const char* PhaseName(Phase phase);

// How full the vectors of a phase's kernels were: of `lanes` that ran, `live` had something to do.
struct LaneUse {
  std::uint64_t batches = 0;  // kernel calls
  std::uint64_t live = 0, lanes = 0;

  LaneUse& operator+=(const LaneUse& other) {
    batches += other.batches;
    live += other.live;
    lanes += other.lanes;
    return *this;
  }
};

// What a frame with RenderOptions::budget has reached.
struct Reached {
  int rounds = 0;             // that were whole; 0: the frame had no budget
  double error = 0;           // as RenderOptions::error
  std::uint64_t samples = 0;  // of all pixels
};

// What Render and RenderRows tell of a frame.
struct RenderStats {
  RayCounts rays;
  double wall_seconds = 0.0;     // of the frame, without compilation and without waits for a sink
  double compile_seconds = 0.0;  // from the scene to flat arrays and a tree
  // By Phase, summed over threads; not of the baseline. Seconds are measured where
  // RenderOptions::timing asks for it.
  double phase_seconds[static_cast<int>(Phase::kCount)] = {};
  LaneUse lane_use[static_cast<int>(Phase::kCount)] = {};
  // Of all threads, for the tiles that they worked on: they follow the scene
  // (docs/memory-layout.md). Not of the baseline, nor the film.
  std::uint64_t buffer_bytes = 0;
  int threads = 0;     // that took part
  std::string target;  // what ran: "scalar" or a SIMD target's name
  Reached reached;
  // A quad is two triangles.
  std::uint32_t primitives = 0, spheres = 0, triangles = 0, disks = 0;
};

}  // namespace sheaf

#endif  // SHEAF_SHEAF_STATS_H_
