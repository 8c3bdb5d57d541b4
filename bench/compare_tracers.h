// Sheaf, its scalar baseline and Embree on the same rays over the same scene.
#ifndef SHEAF_BENCH_COMPARE_TRACERS_H_
#define SHEAF_BENCH_COMPARE_TRACERS_H_

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "bench/embree_peer.h"
#include "bench/make_rays.h"
#include "bench/make_scenes.h"
#include "src/bvh/geometry_access.h"

namespace sheaf::bench {

// Whether Sheaf gets a coherence hint with its rays. Embree always gets its own.
enum class Hints { kGiven, kNone };

struct CompareOptions {
  int repetitions = 7;
  std::uint32_t picture_size = 1024;
  std::vector<std::string> targets;  // of Sheaf, usable ones
  std::vector<RayKind> kinds;
  Hints hints = Hints::kGiven;
  std::string embree_isa = EmbreeIsa();
};

// Numbers of rays whose answers differ, by reason.
struct Differences {
  std::uint32_t embree_missed = 0;  // only Sheaf hit, or found the point in shadow
  std::uint32_t sheaf_missed = 0;
  std::uint32_t other_t = 0;    // both hit, with t more than 1e-4 of it apart
  std::uint32_t other_tie = 0;  // the same t, another primitive: a shared edge

  std::uint32_t total() const { return embree_missed + sheaf_missed + other_t + other_tie; }
};

struct TargetResult {
  std::string target;
  double mrays;           // million rays a second, the median
  double against_embree;  // its median of ratios within a repetition
  double against_scalar;  // likewise
  Differences differences;
  std::uint32_t scalar_differences;  // rays that differ from the baseline in any bit
};

struct Comparison {
  std::string scene;
  std::uint32_t primitives;
  RayKind kind;
  std::uint32_t rays;
  std::string embree_method;  // the call, flag and build quality that won
  double embree_mrays, scalar_mrays;
  std::vector<TargetResult> targets;
};

// Times all kinds of rays of options.kinds over `scene`, and reports each comparison when it is
// made. All of Embree's calls are tried, then the two fastest take part in the repetitions.
// Embree's time is that of the calls alone, over rays already in its layout. Sheaf's time is one
// call of TraceClosest (t, primitive, u and v) or TraceOccluded. The baseline traces all rays as
// well: on a sample of them it would be up to a tenth slower a ray.
void CompareTracers(const BenchScene& scene, const CompareOptions& options,
                    const std::function<void(const Comparison&)>& report);

}  // namespace sheaf::bench

#endif  // SHEAF_BENCH_COMPARE_TRACERS_H_
