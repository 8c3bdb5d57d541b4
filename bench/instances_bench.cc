// One mesh in many places, beside Embree in one process and in turn: rays, builds and memory.
// docs/benchmarking.md says how to read the table.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "bench/embree_peer.h"
#include "bench/interleave.h"
#include "bench/make_rays.h"
#include "bench/make_scenes.h"
#include "sheaf/instances.h"
#include "sheaf/target.h"
#include "src/bvh/geometry_access.h"

namespace sheaf::bench {
namespace {

constexpr float kSameT = 1e-4f;  // relative, and of the unit that instances are apart

struct Request {
  std::uint32_t side = 1000;     // instances along each side of a square
  std::uint32_t frequency = 59;  // of the mesh: 20 times its square triangles
  std::uint32_t picture = 512;
  float height = 0;  // of the eye; 0: what shows a good part of them
  int repetitions = 5;
  std::string target = "auto", isa = EmbreeIsa();
};

// Balls of random size and turn, a little apart, on a plane that a camera looks along.
std::vector<Place> Forest(std::uint32_t side) {
  std::vector<Place> places;
  places.reserve(std::size_t{side} * side);
  std::uint64_t key = 1;
  const auto number = [&](double low, double high) { return low + (high - low) * HashUnit(key++); };
  for (std::uint32_t j = 0; j < side; ++j) {
    for (std::uint32_t i = 0; i < side; ++i) {
      const double a = number(0, 6.28), b = number(-0.3, 0.3), s = number(0.25, 0.6);
      const double h = s * number(1, 2);
      const double ca = std::cos(a), sa = std::sin(a), cb = std::cos(b), sb = std::sin(b);
      // Scaled by s across and h up, tilted by b, turned by a.
      places.push_back({0,
                        {s * ca, h * sa * sb, s * sa * cb, i - 0.5 * side + number(-0.3, 0.3),  //
                         0, h * cb, -s * sb, number(0, 1),                                      //
                         -s * sa, h * ca * sb, s * ca * cb, -1.0 * j + number(-0.3, 0.3)}});
    }
  }
  return places;
}

// The mesh with the forest's camera.
BenchScene MeshSeen(const Request& request) {
  BenchScene scene = GeodesicSphere(request.frequency);
  const float above = 0.05f * static_cast<float>(request.side) + 2;
  const float eye[3] = {0, request.height > 0 ? request.height : above, 3};
  const float look_at[3] = {0, 0, -0.25f * static_cast<float>(request.side)};
  std::copy_n(eye, 3, scene.eye);
  std::copy_n(look_at, 3, scene.look_at);
  scene.fov = 60;
  return scene;
}

class EmbreeForest {
 public:
  EmbreeForest(const EmbreeDevice& device, const BenchScene& mesh, const std::vector<Place>& places,
               RTCBuildQuality quality)
      : mesh_(device, mesh, quality), scene_(rtcNewScene(device.get())) {
    mesh_.Commit();
    rtcSetSceneBuildQuality(scene_, quality);
    for (const Place& place : places) {
      RTCGeometry instance = rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_INSTANCE);
      rtcSetGeometryInstancedScene(instance, mesh_.get());
      float rows[12];
      for (std::size_t k = 0; k < 12; ++k) rows[k] = static_cast<float>(place.to_world[k]);
      rtcSetGeometryTransform(instance, 0, RTC_FORMAT_FLOAT3X4_ROW_MAJOR, rows);
      rtcCommitGeometry(instance);
      rtcAttachGeometry(scene_, instance);
      rtcReleaseGeometry(instance);
    }
    rtcCommitScene(scene_);
  }
  ~EmbreeForest() { rtcReleaseScene(scene_); }
  EmbreeForest(const EmbreeForest&) = delete;
  EmbreeForest& operator=(const EmbreeForest&) = delete;
  RTCScene get() const { return scene_; }

 private:
  EmbreeScene mesh_;
  RTCScene scene_;
};

struct Answers {
  std::vector<float> t, u, v;
  std::vector<std::uint32_t> primitive, instance;
  explicit Answers(std::uint32_t n) : t(n), u(n), v(n), primitive(n), instance(n) {}
};

void TraceSheaf(const Instances& instances, const RayBatch& batch, Target target, Query query,
                Answers& answers) {
  TraceOptions options;
  options.interval.all_t_min = batch.intervals.all_t_min;
  options.interval.all_t_max = batch.intervals.all_t_max;
  options.target = target;
  if (query == Query::kOccluded) {
    TraceOccluded(instances, ArraysOf(batch.view()), batch.count, answers.primitive.data(), options)
        .value();
    return;
  }
  TraceClosest(
      instances, ArraysOf(batch.view()), batch.count,
      {answers.t.data(), answers.primitive.data(), nullptr, answers.u.data(), answers.v.data()},
      answers.instance.data(), options)
      .value();
}

// From each hit upwards at random, a little off.
RayBatch RaysFrom(const RayBatch& primary, const Answers& hits) {
  RayBatch batch;
  batch.stream.Reserve(primary.count);
  const RayView<float> from = primary.view();
  const auto to = batch.stream.output();
  for (std::uint32_t i = 0; i < primary.count; ++i) {
    if (hits.primitive[i] == kNoPrimitive) continue;
    const double z = HashUnit(2 * i), a = 6.28 * HashUnit(2 * i + 1), r = std::sqrt(1 - z * z);
    const std::uint32_t k = batch.count++;
    const float t = hits.t[i] * 0.9999f;
    to.origin_x[k] = from.origin_x[i] + t * from.direction_x[i];
    to.origin_y[k] = from.origin_y[i] + t * from.direction_y[i];
    to.origin_z[k] = from.origin_z[i] + t * from.direction_z[i];
    to.direction_x[k] = static_cast<float>(r * std::cos(a));
    to.direction_y[k] = static_cast<float>(z);
    to.direction_z[k] = static_cast<float>(r * std::sin(a));
  }
  return batch;
}

struct Way {
  EmbreeCall call;
  RTCIntersectContextFlags flags;
  RTCScene scene;
};

// Embree's fastest way to trace these rays, each tried twice.
Way FindBest(std::map<std::uint32_t, std::unique_ptr<EmbreeRays>>& rays,
             const std::vector<RTCScene>& scenes, Query query) {
  double best = HUGE_VAL;
  Way way{};
  for (const RTCScene scene : scenes) {
    for (const EmbreeCall call : kEmbreeCalls) {
      for (const auto flags :
           {RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT, RTC_INTERSECT_CONTEXT_FLAG_COHERENT}) {
        // Embree 3.13.5 never comes back from occlusion of coherent packets through instances.
        const bool is_coherent = flags == RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
        if (query == Query::kOccluded && is_coherent) continue;
        for (int attempt = 0; attempt < 2; ++attempt) {
          EmbreeRays& these = *rays.at(WidthOf(call));
          these.Reset();
          const double seconds = SecondsOf([&] { these.Trace(scene, call, flags); });
          if (seconds < best) best = seconds, way = {call, flags, scene};
        }
      }
    }
  }
  return way;
}

void Compare(const char* name, const Request& request, const Instances& instances,
             const std::vector<RTCScene>& scenes, const RayBatch& batch, Query query) {
  const Target target = Target::Named(request.target).value();
  std::map<std::uint32_t, std::unique_ptr<EmbreeRays>> rays;
  for (const EmbreeCall call : kEmbreeCalls) {
    auto& these = rays[WidthOf(call)];
    if (!these) these = std::make_unique<EmbreeRays>(batch, query, WidthOf(call));
  }
  const FlushDenormals flush;
  const Way way = FindBest(rays, scenes, query);
  Answers answers(batch.count), scalar(batch.count);
  EmbreeRays& best = *rays.at(WidthOf(way.call));
  const auto seconds =
      Interleave({{[&] { best.Reset(); }, [&] { best.Trace(way.scene, way.call, way.flags); }},
                  {[] {}, [&] { TraceSheaf(instances, batch, target, query, answers); }}},
                 request.repetitions);
  TraceSheaf(instances, batch, Target::Scalar(), query, scalar);
  std::uint32_t differing = 0, other = 0;
  for (std::uint32_t i = 0; i < batch.count; ++i) {
    differing += answers.primitive[i] != scalar.primitive[i] ||
                 (query == Query::kClosest &&
                  (answers.t[i] != scalar.t[i] || answers.instance[i] != scalar.instance[i]));
    const bool is_hit =
        query == Query::kClosest ? answers.primitive[i] != kNoPrimitive : answers.primitive[i] != 0;
    const bool embree_hit =
        query == Query::kClosest ? best.t(i) < batch.intervals.all_t_max : best.IsOccluded(i);
    other +=
        is_hit != embree_hit || (is_hit && query == Query::kClosest &&
                                 std::abs(best.t(i) - answers.t[i]) > kSameT * (1 + answers.t[i]));
  }
  const auto mrays = [&](const std::vector<double>& times) {
    std::vector<double> sorted = times;
    std::nth_element(sorted.begin(), sorted.begin() + sorted.size() / 2, sorted.end());
    return batch.count / sorted[sorted.size() / 2] * 1e-6;
  };
  fmt::print("{:<9}{:>9}  {:>8.2f} {:<4}{:>8.2f}{:>9.2f}  {} other ({} scalar)\n", name,
             batch.count, mrays(seconds[0]), NameOf(way.call), mrays(seconds[1]),
             MedianRatio(seconds[0], seconds[1]), other, differing);
  std::fflush(stdout);
}

int Run(const Request& request) {
  const BenchScene mesh = MeshSeen(request);
  const std::vector<Place> places = Forest(request.side);
  GeometryInput input;
  input.AddTriangles(mesh.vertices, mesh.indices);
  const std::vector<std::shared_ptr<const Geometry>> geometries = {
      std::make_shared<const Geometry>(Geometry::Build(input, 1).value())};
  Instances instances;
  const double ours =
      SecondsOf([&] { instances = Instances::Build(geometries, places, 1).value(); });
  const EmbreeDevice device(1, request.isa);
  std::unique_ptr<EmbreeForest> medium, high;
  const double theirs = SecondsOf([&] {
    medium = std::make_unique<EmbreeForest>(device, mesh, places, RTC_BUILD_QUALITY_MEDIUM);
  });
  const auto held = static_cast<double>(device.bytes_held());
  high = std::make_unique<EmbreeForest>(device, mesh, places, RTC_BUILD_QUALITY_HIGH);
  const auto count = static_cast<double>(places.size());
  fmt::print("# Embree {} isa={}; Sheaf on {}; one thread; {} instances of {} triangles\n",
             RTC_VERSION_STRING, request.isa, Target::Named(request.target)->name(), places.size(),
             mesh.triangle_count());
  fmt::print("# build: Embree {:.2f} s, Sheaf {:.2f} s; bytes an instance: {:.0f}, {:.0f}\n",
             theirs, ours, held / count, static_cast<double>(instances.statistics().bytes) / count);
  fmt::print("{:<9}{:>9}  {:>8} {:<4}{:>8}{:>9}  {}\n", "rays", "count", "Embree", "call", "Sheaf",
             "/Embree", "answers that differ");
  const std::vector<RTCScene> scenes = {medium->get(), high->get()};
  const RayBatch primary = PrimaryRays(mesh, request.picture);
  Answers hits(primary.count);
  Compare("primary", request, instances, scenes, primary, Query::kClosest);
  TraceSheaf(instances, primary, Target(), Query::kClosest, hits);
  const RayBatch from = RaysFrom(primary, hits);
  Compare("random", request, instances, scenes, from, Query::kClosest);
  Compare("occluded", request, instances, scenes, from, Query::kOccluded);
  return EXIT_SUCCESS;
}

int Main(int argc, char** argv) {
  CLI::App app("One mesh in many places beside Embree: million rays a second", "instances_bench");
  Request request;
  app.add_option("--side", request.side, "instances: this squared (1000)")
      ->check(CLI::Range(1, 4000));
  app.add_option("--frequency", request.frequency, "triangles: 20 times this squared (59)")
      ->check(CLI::Range(1, 500));
  app.add_option("--picture", request.picture, "primary rays a side, a power of two (512)");
  app.add_option("--height", request.height, "of the eye: low ones see few instances, large ones");
  app.add_option("--repetitions", request.repetitions, "medians of this many runs (5)")
      ->check(CLI::Range(1, 1000));
  app.add_option("--target", request.target, "Sheaf's target (auto)")
      ->check([](const std::string& name) {
        return Target::Named(name) ? std::string() : "unknown target " + name;
      });
  app.add_option("--embree-isa", request.isa, "what Embree may use; the widest");
  CLI11_PARSE(app, argc, argv);
  return Run(request);
}

}  // namespace
}  // namespace sheaf::bench

int main(int argc, char** argv) { return sheaf::bench::Main(argc, argv); }
