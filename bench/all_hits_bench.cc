// All hits of rays in order, beside Embree with a filter that collects them and lets none end the
// ray: its way to list all hits. One thread, in turn, medians.
#include <embree3/rtcore.h>
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include "bench/embree_peer.h"
#include "bench/interleave.h"
#include "bench/make_rays.h"
#include "bench/make_scenes.h"
#include "sheaf/queries.h"
#include "src/bvh/geometry_access.h"

namespace sheaf::bench {
namespace {

constexpr std::uint32_t kRoom = 64;  // hits a ray
constexpr std::uint32_t kWidth = 16;

struct Found {
  float t;
  std::uint32_t primitive;
  bool operator<(const Found& other) const {
    return t != other.t ? t < other.t : primitive < other.primitive;
  }
};

// Lists of hits; what Embree hands to its filter.
struct Lists {
  RTCIntersectContext context;  // first, as Embree asks
  std::vector<Found> hits;
  std::vector<std::uint32_t> count;

  explicit Lists(std::size_t rays) : hits(rays * kRoom), count(rays) {}
};

void Collect(const RTCFilterFunctionNArguments* args) {
  auto& lists = *reinterpret_cast<Lists*>(args->context);
  for (unsigned i = 0; i < args->N; ++i) {
    if (args->valid[i] != -1) continue;
    args->valid[i] = 0;
    const unsigned ray = RTCRayN_id(args->ray, args->N, i);
    std::uint32_t& count = lists.count[ray];
    if (count == kRoom) continue;
    lists.hits[std::size_t{ray} * kRoom + count++] = {RTCRayN_tfar(args->ray, args->N, i),
                                                      RTCHitN_primID(args->hit, args->N, i)};
  }
}

// Embree's rays, one by one or 16 at a time.
class CollectingRays {
 public:
  CollectingRays(const RayBatch& batch, std::uint32_t width)
      : view_(batch.view()), intervals_(batch.intervals), count_(batch.count), width_(width) {}

  void Trace(RTCScene scene, RTCIntersectContextFlags flags, Lists& lists) const {
    rtcInitIntersectContext(&lists.context);
    lists.context.flags = flags;
    std::fill(lists.count.begin(), lists.count.end(), 0u);
    for (std::uint32_t i = 0; i < count_; i += width_) {
      width_ == 1 ? TraceOne(scene, lists, i) : TracePacket(scene, lists, i);
    }
    // In order, as TraceAll has them.
    for (std::uint32_t i = 0; i < count_; ++i) {
      Found* const first = &lists.hits[std::size_t{i} * kRoom];
      std::sort(first, first + lists.count[i]);
    }
  }

 private:
  void TraceOne(RTCScene scene, Lists& lists, std::uint32_t i) const {
    RTCRayHit ray;
    ray.ray = {view_.origin_x[i],
               view_.origin_y[i],
               view_.origin_z[i],
               intervals_.all_t_min,
               view_.direction_x[i],
               view_.direction_y[i],
               view_.direction_z[i],
               0,
               intervals_.all_t_max,
               0xffffffffu,
               i,
               0};
    ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene, &lists.context, &ray);
  }
  void TracePacket(RTCScene scene, Lists& lists, std::uint32_t first) const {
    RTCRayHit16 packet;
    alignas(64) int valid[kWidth];
    for (std::uint32_t k = 0; k < kWidth; ++k) {
      const std::uint32_t i = std::min(first + k, count_ - 1);
      valid[k] = first + k < count_ ? -1 : 0;
      packet.ray.org_x[k] = view_.origin_x[i];
      packet.ray.org_y[k] = view_.origin_y[i];
      packet.ray.org_z[k] = view_.origin_z[i];
      packet.ray.dir_x[k] = view_.direction_x[i];
      packet.ray.dir_y[k] = view_.direction_y[i];
      packet.ray.dir_z[k] = view_.direction_z[i];
      packet.ray.tnear[k] = intervals_.all_t_min;
      packet.ray.tfar[k] = intervals_.all_t_max;
      packet.ray.time[k] = 0;
      packet.ray.mask[k] = 0xffffffffu;
      packet.ray.id[k] = i;
      packet.ray.flags[k] = 0;
      packet.hit.geomID[k] = RTC_INVALID_GEOMETRY_ID;
    }
    rtcIntersect16(valid, scene, &lists.context, &packet);
  }

  RayView<float> view_;
  RayIntervals<float> intervals_;
  std::uint32_t count_, width_;
};

struct Request {
  std::string scene = "scan-100k";
  std::uint32_t size = 256;
  int repetitions = 7;
};

void Compare(const Request& request, const BenchScene& scene, const Geometry& geometry,
             RTCScene embree, RayKind kind, const RayBatch& batch) {
  const std::uint32_t count = batch.count;
  std::vector<float> t(std::size_t{count} * kRoom);
  std::vector<std::uint32_t> primitive(t.size()), listed(count);
  const AllHits into = {kRoom, {.t = t.data(), .primitive = primitive.data()}, listed.data()};
  const RuledTraceOptions options = {.interval = IntervalOf(batch.intervals)};
  const auto trace = [&] {
    TraceAll(geometry, ArraysOf(batch.view()), count, into, options).value();
  };
  Lists lists(count);
  std::vector<Contestant> contestants = {{[] {}, trace}};
  std::vector<CollectingRays> peers = {CollectingRays(batch, 1), CollectingRays(batch, kWidth)};
  for (const CollectingRays& peer : peers) {
    for (const auto flags :
         {RTC_INTERSECT_CONTEXT_FLAG_COHERENT, RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT}) {
      contestants.push_back({[] {},
                             [&, flags] {
                               const FlushDenormals flush;
                               peer.Trace(embree, flags, lists);
                             }});
    }
  }
  const auto seconds = Interleave(contestants, request.repetitions);
  std::size_t best = 1;
  const auto median = [&](std::size_t k) {
    std::vector<double> sorted = seconds[k];
    std::nth_element(sorted.begin(), sorted.begin() + sorted.size() / 2, sorted.end());
    return sorted[sorted.size() / 2];
  };
  for (std::size_t k = 1; k < seconds.size(); ++k) best = median(k) < median(best) ? k : best;
  std::uint64_t hits = 0, differ = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    hits += listed[i];
    differ += listed[i] != lists.count[i];
  }
  fmt::print("{:<16}{:<10}{:>8.2f}{:>10.2f}{:>10.2f}{:>8.2f}{:>10}\n", scene.name, NameOf(kind),
             static_cast<double>(hits) / count, count / median(0) / 1e6, count / median(best) / 1e6,
             MedianRatio(seconds[best], seconds[0]), differ);
  std::fflush(stdout);
}

void Run(const Request& request) {
  fmt::print("{:<16}{:<10}{:>8}{:>10}{:>10}{:>8}{:>10}\n", "scene", "rays", "hits", "Sheaf",
             "Embree", "ratio", "differ");
  const EmbreeDevice device(1);
  for (const SceneMaker& maker : SceneCatalogue()) {
    if (std::string(maker.name).find(request.scene) == std::string::npos) continue;
    BenchScene scene = maker.make();
    scene.name = maker.name;
    if (scene.sphere_count() > 0) continue;  // Embree's filter is told one of a sphere's two hits
    GeometryInput input;
    input.AddTriangles(scene.vertices, scene.indices);
    const Geometry geometry = Geometry::Build(input).value();
    EmbreeScene embree(device, scene, RTC_BUILD_QUALITY_MEDIUM,
                       RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION);
    RTCGeometry triangles = rtcGetGeometry(embree.get(), 0);
    rtcSetGeometryIntersectFilterFunction(triangles, Collect);
    rtcCommitGeometry(triangles);
    embree.Commit();
    const RayBatch primary = PrimaryRays(scene, request.size);
    std::vector<float> t(primary.count);
    std::vector<std::uint32_t> hit(primary.count);
    TraceClosest(geometry, ArraysOf(primary.view()), primary.count,
                 {.t = t.data(), .primitive = hit.data()})
        .value();
    for (const RayKind kind : {RayKind::kPrimary, RayKind::kDiffuse}) {
      const RayBatch batch = kind == RayKind::kPrimary
                                 ? PrimaryRays(scene, request.size)
                                 : SecondaryRays(scene, kind, primary, t, hit);
      Compare(request, scene, geometry, embree.get(), kind, batch);
    }
  }
}

int Main(int argc, char** argv) {
  CLI::App app("All hits, beside Embree with a filter", "all_hits_bench");
  Request request;
  app.add_option("--scene", request.scene, "part of the scene's name (scan-100k)");
  app.add_option("--size", request.size, "primary rays along a side, a power of two (256)");
  app.add_option("--repetitions", request.repetitions, "of each contestant (7)");
  CLI11_PARSE(app, argc, argv);
  Run(request);
  return EXIT_SUCCESS;
}

}  // namespace
}  // namespace sheaf::bench

int main(int argc, char** argv) { return sheaf::bench::Main(argc, argv); }
