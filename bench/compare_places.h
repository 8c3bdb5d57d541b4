// How far from double the hits of Sheaf and of Embree are, by where a scene lies and how large it
// is.
#ifndef SHEAF_BENCH_COMPARE_PLACES_H_
#define SHEAF_BENCH_COMPARE_PLACES_H_

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "bench/make_scenes.h"

namespace sheaf::bench {

struct PlaceOptions {
  std::vector<double> moved, scaled;  // one place each, beside that where the scene was made
  std::uint32_t picture_size = 1024;
};

// Primary rays of one tracer at one place against double: the scene where it was made, in doubles.
struct PlaceErrors {
  double moved, scaled;
  std::string tracer;
  std::uint32_t rays;
  std::uint32_t hit_or_miss = 0;  // one hits, the other misses
  std::uint32_t other_t = 0;      // both hit, with t more than 1e-4 of it apart
  double median = 0, most = 0;    // of |t / t of double - 1|, where both hit
};

// Both get the same floats: those of the scene where it is placed, rounded once. Sheaf is the
// library's geometry, which traces where it is told to; its renderer brings scenes near the origin.
// Embree traces with its usual settings and with RTC_SCENE_FLAG_ROBUST.
void ComparePlaces(const BenchScene& scene, const PlaceOptions& options,
                   const std::function<void(const PlaceErrors&)>& report);

}  // namespace sheaf::bench

#endif  // SHEAF_BENCH_COMPARE_PLACES_H_
