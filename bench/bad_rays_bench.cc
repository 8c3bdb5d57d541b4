// Invalid rays (no direction, NaN, infinity) and batches that hold some, beside valid ones: they
// may not cost much more. Rows are TraceClosest/WHAT/TARGET and TraceOccluded/WHAT/TARGET.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bench/make_rays.h"
#include "bench/make_scenes.h"
#include "sheaf/target.h"
#include "simd/query.h"
#include "simd/streams.h"
#include "src/bvh/geometry_access.h"
#include "src/core/running_target.h"

namespace sheaf::bench {
namespace {

constexpr std::uint32_t kSide = 256;

enum class Damage {
  kNone,
  kNoDirection,
  kNanDirection,
  kInfiniteDirection,
  kNanOrigin,
  kEveryThird
};
constexpr std::pair<Damage, const char*> kDamages[] = {
    {Damage::kNone, "sound"},
    {Damage::kNoDirection, "zero-direction"},
    {Damage::kNanDirection, "nan-direction"},
    {Damage::kInfiniteDirection, "infinite-direction"},
    {Damage::kNanOrigin, "nan-origin"},
    {Damage::kEveryThird, "every-third-nan"}};

RayBatch DamagedRays(const BenchScene& scene, Damage damage) {
  RayBatch batch = PrimaryRays(scene, kSide);
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  for (std::uint32_t i = 0; i < batch.count; ++i) {
    const RayOutput<float> ray = batch.stream.output(i);
    if (damage == Damage::kNoDirection) *ray.direction_x = *ray.direction_y = *ray.direction_z = 0;
    if (damage == Damage::kNanDirection) *ray.direction_y = kNan;
    if (damage == Damage::kInfiniteDirection) {
      *ray.direction_y = std::numeric_limits<float>::infinity();
    }
    if (damage == Damage::kNanOrigin) *ray.origin_x = kNan;
    if (damage == Damage::kEveryThird && i % 3 == 0) *ray.direction_z = kNan;
  }
  return batch;
}

void TraceRays(benchmark::State& state, const Geometry& geometry, const RayBatch& batch,
               Query query, const std::string& target) {
  const std::optional<Target> chosen = Target::Named(target);
  if (!chosen || RunningTarget(*chosen) != target) {
    state.SkipWithError("another target runs");
    return;
  }
  TraceOptions options;
  options.target = *chosen;
  std::vector<float> t(batch.count);
  std::vector<std::uint32_t> primitive(batch.count);
  for (auto _ : state) {
    if (query == Query::kClosest) {
      TraceClosest(geometry, ArraysOf(batch.view()), batch.count,
                   {.t = t.data(), .primitive = primitive.data()}, options)
          .value();
    } else {
      TraceOccluded(geometry, ArraysOf(batch.view()), batch.count, primitive.data(), options)
          .value();
    }
    benchmark::DoNotOptimize(primitive.data());
  }
  state.counters["rays/s"] =
      benchmark::Counter(batch.count, benchmark::Counter::kIsIterationInvariantRate);
}

int Main(int argc, char** argv) {
  const auto scenes = SceneCatalogue();
  const auto maker = std::find_if(scenes.begin(), scenes.end(), [](const SceneMaker& m) {
    return std::string_view(m.name) == "scan-10k";
  });
  if (maker == scenes.end()) return 1;
  const BenchScene scene = maker->make();
  GeometryInput input;
  input.AddTriangles(scene.vertices, scene.indices);
  const Result<Geometry> geometry = Geometry::Build(input);
  if (!geometry) return 1;
  std::vector<RayBatch> batches;
  for (const auto& [damage, name] : kDamages) batches.push_back(DamagedRays(scene, damage));
  for (const std::string& target : UsableTargets()) {
    for (const auto& [query, verb] : {std::pair(Query::kClosest, "TraceClosest/"),
                                      std::pair(Query::kOccluded, "TraceOccluded/")}) {
      for (std::size_t i = 0; i < batches.size(); ++i) {
        benchmark::RegisterBenchmark(
            (verb + std::string(kDamages[i].second) + "/" + target).c_str(),
            [&, query = query, target, i](benchmark::State& state) {
              TraceRays(state, geometry.value(), batches[i], query, target);
            })
            ->Unit(benchmark::kMillisecond);
      }
    }
  }
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}

}  // namespace
}  // namespace sheaf::bench

int main(int argc, char** argv) { return sheaf::bench::Main(argc, argv); }
