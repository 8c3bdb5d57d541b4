// Rays aimed at the edges and vertices of a closed surface, from outside and from inside: none may
// slip between two triangles. Exits 1 where one does.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "bench/make_rays.h"
#include "bench/make_scenes.h"
#include "sheaf/target.h"
#include "simd/query.h"
#include "simd/streams.h"
#include "src/bvh/geometry_access.h"
#include "src/core/parallel.h"
#include "src/core/running_target.h"
#include "src/core/vec3.h"

#ifdef SHEAF_BENCH_EMBREE
#include "bench/embree_peer.h"
#endif

namespace sheaf::bench {
namespace {
using Vec = Vec3<double>;

constexpr std::uint32_t kFrequency = 32;  // 20,480 triangles
constexpr std::uint32_t kBatch = 1 << 14;
// A ray reaches its target at t = 1, and no ray grazes the surface: a hit further off than this is
// on the far side.
constexpr float kSlack = 1e-3f;
constexpr double kLeastCosine = 0.1;

// Batches of rays at a surface around the origin; each follows from its number alone.
class LeakRays {
 public:
  explicit LeakRays(const BenchScene& scene) : scene_(scene) {}

  RayBatch Make(std::uint64_t number) const {
    RayBatch batch;
    batch.count = kBatch;
    batch.stream.Allocate(kBatch);
    // In turn: each ray from anywhere; runs of 16 from one origin, mostly at one triangle; the
    // whole batch from one origin.
    constexpr std::uint32_t kRuns[] = {1, 16, kBatch};
    const std::uint32_t run = kRuns[number % 3];
    std::uint64_t key = number << 32;  // a ray takes a few dozen numbers at most
    auto unit = [&] { return HashUnit(key++); };
    Vec origin{};
    std::uint32_t triangle = 0;
    for (std::uint32_t i = 0; i < kBatch; ++i) {
      if (i % run == 0) origin = Origin(unit);
      if (i % std::min(run, 16u) == 0) triangle = Triangle(unit);
      Vec target = Target(triangle, unit);
      while (!Shows(target, origin)) {
        triangle = Triangle(unit);
        target = Target(triangle, unit);
      }
      const RayOutput<float> ray = batch.stream.output(i);
      const Vec direction = target - origin;
      *ray.origin_x = static_cast<float>(origin.x);
      *ray.origin_y = static_cast<float>(origin.y);
      *ray.origin_z = static_cast<float>(origin.z);
      *ray.direction_x = static_cast<float>(direction.x);
      *ray.direction_y = static_cast<float>(direction.y);
      *ray.direction_z = static_cast<float>(direction.z);
    }
    return batch;
  }

 private:
  // Of floats, half of them within the surface.
  template <typename Unit>
  static Vec Origin(Unit unit) {
    const Vec direction{unit() - 0.5, unit() - 0.5, unit() - 0.5};
    const double distance = unit() < 0.5 ? 0.6 * unit() : 1.5 + 3 * unit();
    return (Normalize(direction) * distance).To<float>().template To<double>();
  }

  template <typename Unit>
  std::uint32_t Triangle(Unit unit) const {
    return static_cast<std::uint32_t>(unit() * scene_.triangle_count());
  }

  // A vertex of the triangle, or a point of an edge.
  template <typename Unit>
  Vec Target(std::uint32_t triangle, Unit unit) const {
    const auto corner = static_cast<std::uint32_t>(unit() * 3);
    const Vec a = Vertex(triangle, corner);
    if (unit() < 0.25) return a;
    return a + (Vertex(triangle, (corner + 1) % 3) - a) * unit();
  }

  Vec Vertex(std::uint32_t triangle, std::uint32_t corner) const {
    const float* p = &scene_.vertices[std::size_t{3} * scene_.indices[3 * triangle + corner]];
    return {p[0], p[1], p[2]};
  }

  // Whether a ray to the target meets the surface there first, and at no small angle.
  static bool Shows(Vec target, Vec origin) {
    const double cosine = Dot(Normalize(target), Normalize(origin - target));
    return Dot(origin, origin) < 1 || cosine > kLeastCosine;
  }

  const BenchScene& scene_;
};

struct Leaks {
  std::atomic<std::uint64_t> closest = 0, occluded = 0;
};

// Calls count(batch, number, leaks) for every batch, on `threads` threads.
template <typename Count>
void CountLeaks(const LeakRays& rays, std::uint64_t batches, int threads, Count count,
                Leaks& leaks) {
  ParallelFor(threads, batches, [&](int, std::uint64_t number) {
    RayBatch batch = rays.Make(number);
    count(batch, number, leaks);
  });
}

void Print(const std::string& who, const Leaks& leaks, std::uint64_t rays) {
  fmt::print("{:<16}{:>14}{:>18}{:>18}\n", who, rays, leaks.closest.load(), leaks.occluded.load());
  std::fflush(stdout);
}

RayIntervals<float> AroundTarget() { return {.all_t_min = 1 - kSlack, .all_t_max = 1 + kSlack}; }

bool IsLeak(std::uint32_t primitive, float t) {
  return primitive == kNoPrimitive || !(std::abs(t - 1) <= kSlack);
}

void CountSheaf(const Geometry& geometry, Target target, const RayBatch& batch,
                std::uint64_t number, Leaks& leaks) {
  constexpr RayCoherence kCoherences[] = {RayCoherence::kUnknown, RayCoherence::kCommonOrigin,
                                          RayCoherence::kCoherent, RayCoherence::kIncoherent};
  TraceOptions options;
  options.target = target;
  options.coherence = kCoherences[number / 3 % 4];
  std::vector<float> t(batch.count);
  std::vector<std::uint32_t> primitive(batch.count), occluded(batch.count);
  TraceClosest(geometry, ArraysOf(batch.view()), batch.count,
               {.t = t.data(), .primitive = primitive.data()}, options)
      .value();
  options.interval = IntervalOf(AroundTarget());
  TraceOccluded(geometry, ArraysOf(batch.view()), batch.count, occluded.data(), options).value();
  for (std::uint32_t i = 0; i < batch.count; ++i) {
    leaks.closest += IsLeak(primitive[i], t[i]);
    leaks.occluded += occluded[i] == 0;
  }
}

#ifdef SHEAF_BENCH_EMBREE

void CountEmbree(const BenchScene& scene, const EmbreeScene& embree, RayBatch& batch,
                 std::uint64_t number, Leaks& leaks) {
  const EmbreeCall call = kEmbreeCalls[number / 3 % std::size(kEmbreeCalls)];
  const auto flags = number / 3 % 2 == 0 ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT
                                         : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
  EmbreeRays closest(batch, Query::kClosest, WidthOf(call));
  closest.Reset();
  closest.Trace(embree.get(), call, flags);
  batch.intervals = AroundTarget();
  EmbreeRays occluded(batch, Query::kOccluded, WidthOf(call));
  occluded.Reset();
  occluded.Trace(embree.get(), call, flags);
  for (std::uint32_t i = 0; i < batch.count; ++i) {
    leaks.closest += IsLeak(closest.Primitive(i, scene), closest.t(i));
    leaks.occluded += !occluded.IsOccluded(i);
  }
}

void RunEmbree(const BenchScene& scene, const LeakRays& rays, std::uint64_t batches, int threads) {
  const EmbreeDevice device(threads);
  for (const auto& [name, flags] : {std::pair("Embree", RTC_SCENE_FLAG_NONE),
                                    std::pair("Embree, robust", RTC_SCENE_FLAG_ROBUST)}) {
    EmbreeScene embree(device, scene, RTC_BUILD_QUALITY_MEDIUM, flags);
    embree.Commit();
    Leaks leaks;
    CountLeaks(
        rays, batches, threads,
        [&](RayBatch& batch, std::uint64_t number, Leaks& found) {
          CountEmbree(scene, embree, batch, number, found);
        },
        leaks);
    Print(name, leaks, batches * kBatch);
  }
}

#else

void RunEmbree(const BenchScene&, const LeakRays&, std::uint64_t, int) {}

#endif

int Main(int argc, char** argv) {
  CLI::App app("Leaks of rays aimed at the edges and vertices of a closed surface", "leak_bench");
  double ray_count = 1e7;  // a double, so that 1e9 may be written
  int threads = 0;
  app.add_option("--rays", ray_count, "rays for every tracer (1e7)")->check(CLI::Range(1.0, 1e13));
  app.add_option("--threads", threads, "0: one a core (0)")->check(CLI::Range(0, 1024));
  CLI11_PARSE(app, argc, argv);
  threads = ThreadCount(threads);
  const auto batches = static_cast<std::uint64_t>(std::ceil(ray_count / kBatch));

  const BenchScene scene = GeodesicSphere(kFrequency);
  const LeakRays rays(scene);
  GeometryInput input;
  input.AddTriangles(scene.vertices, scene.indices);
  const Result<Geometry> geometry = Geometry::Build(input);
  if (!geometry) {
    fmt::print(stderr, "leak_bench: {}\n", geometry.error().message);
    return EXIT_FAILURE;
  }
  fmt::print("{:<16}{:>14}{:>18}{:>18}\n", "tracer", "rays", "nearest-hit leaks",
             "occlusion leaks");
  std::uint64_t sheaf_leaks = 0;
  for (const std::string& target : UsableTargets()) {
    const std::optional<Target> chosen = Target::Named(target);
    if (!chosen || RunningTarget(*chosen) != target) {
      fmt::print(stderr, "leak_bench: another target ran than {}\n", target);
      return EXIT_FAILURE;
    }
    Leaks leaks;
    CountLeaks(
        rays, batches, threads,
        [&](const RayBatch& batch, std::uint64_t number, Leaks& found) {
          CountSheaf(geometry.value(), *chosen, batch, number, found);
        },
        leaks);
    Print(target, leaks, batches * kBatch);
    sheaf_leaks += leaks.closest + leaks.occluded;
  }
  RunEmbree(scene, rays, batches, threads);
  return sheaf_leaks == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}

}  // namespace
}  // namespace sheaf::bench

int main(int argc, char** argv) { return sheaf::bench::Main(argc, argv); }
