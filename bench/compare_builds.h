// How long Sheaf and Embree take to build a tree, and how much memory it holds.
#ifndef SHEAF_BENCH_COMPARE_BUILDS_H_
#define SHEAF_BENCH_COMPARE_BUILDS_H_

#include <cstdint>
#include <string>

#include "bench/make_scenes.h"

namespace sheaf::bench {

struct BuildTimes {
  int threads;
  // Milliseconds, medians. Embree: rtcCommitScene, medium quality. Sheaf: Geometry::Build, which
  // also checks and copies its input, and BuildTree within it.
  double embree, sheaf, sheaf_tree;
  double against_embree;  // of Geometry::Build, the median of ratios within a repetition
};

struct BuildComparison {
  std::string scene;
  std::uint32_t primitives;
  BuildTimes times[2];  // one thread and two
  // Held after the build. Embree needs the caller's arrays besides; they are not counted.
  double embree_bytes_a_primitive, sheaf_bytes_a_primitive;
};

BuildComparison CompareBuilds(const BenchScene& scene, int repetitions);

}  // namespace sheaf::bench

#endif  // SHEAF_BENCH_COMPARE_BUILDS_H_
