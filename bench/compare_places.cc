#include "bench/compare_places.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "bench/embree_peer.h"
#include "bench/make_rays.h"
#include "simd/query.h"
#include "simd/tree.h"
#include "src/bvh/geometry_access.h"

namespace sheaf::bench {
namespace {

constexpr double kSameT = 1e-4;  // relative

// Along no axis, as a step along one would leave two coordinates their bits; a unit long.
constexpr double kWay[3] = {0.63372378, -0.63372378, 0.44360665};

struct Place {
  double moved, scaled;

  float Coordinate(float x, std::size_t axis) const {
    return static_cast<float>(static_cast<double>(x) * scaled + kWay[axis] * moved);
  }
};

BenchScene Placed(const BenchScene& scene, const Place& place) {
  BenchScene placed = scene;
  for (std::size_t i = 0; i < placed.vertices.size(); ++i) {
    placed.vertices[i] = place.Coordinate(scene.vertices[i], i % 3);
  }
  for (std::size_t i = 0; i < placed.spheres.size(); ++i) {
    const float given = scene.spheres[i];
    placed.spheres[i] = i % 4 < 3 ? place.Coordinate(given, i % 4)
                                  : static_cast<float>(static_cast<double>(given) * place.scaled);
  }
  return placed;
}

// Distances as the scene where it was made has them; infinite where a ray misses.
using Distances = std::vector<double>;

Distances TraceDouble(const BenchScene& scene, const RayBatch& batch) {
  GeometryInput input;
  if (scene.triangle_count() > 0) input.AddTriangles(scene.vertices, scene.indices);
  if (scene.sphere_count() > 0) input.AddSpheres(scene.spheres);
  const GeometryD geometry = std::move(GeometryD::Build(input)).value();
  const RayView<float> rays = batch.view();
  const float* const from[6] = {rays.origin_x,    rays.origin_y,    rays.origin_z,
                                rays.direction_x, rays.direction_y, rays.direction_z};
  std::vector<double> wide[6];
  for (int k = 0; k < 6; ++k) wide[k].assign(from[k], from[k] + batch.count);
  Distances t(batch.count);
  std::vector<std::uint32_t> primitive(batch.count);
  TraceClosest(geometry,
               {wide[0].data(), wide[1].data(), wide[2].data(), wide[3].data(), wide[4].data(),
                wide[5].data()},
               batch.count, {.t = t.data(), .primitive = primitive.data()})
      .value();
  for (std::uint32_t i = 0; i < batch.count; ++i) {
    if (primitive[i] == GeometryD::kNoPrimitive) t[i] = HUGE_VAL;
  }
  return t;
}

Distances TraceSheaf(const BenchScene& scene, const RayBatch& batch) {
  GeometryInput input;
  if (scene.triangle_count() > 0) input.AddTriangles(scene.vertices, scene.indices);
  if (scene.sphere_count() > 0) input.AddSpheres(scene.spheres);
  const Geometry geometry = std::move(Geometry::Build(input)).value();
  std::vector<float> t(batch.count);
  std::vector<std::uint32_t> primitive(batch.count);
  TraceClosest(geometry, ArraysOf(batch.view()), batch.count,
               {.t = t.data(), .primitive = primitive.data()})
      .value();
  Distances distances(t.begin(), t.end());
  for (std::uint32_t i = 0; i < batch.count; ++i) {
    if (primitive[i] == kNoPrimitive) distances[i] = HUGE_VAL;
  }
  return distances;
}

Distances TraceEmbree(const BenchScene& scene, const RayBatch& batch, RTCSceneFlags flags) {
  const EmbreeDevice device(1);
  EmbreeScene embree(device, scene, RTC_BUILD_QUALITY_MEDIUM, flags);
  embree.Commit();
  EmbreeRays rays(batch, Query::kClosest, WidthOf(EmbreeCall::k1));
  rays.Reset();
  const FlushDenormals flush;
  rays.Trace(embree.get(), EmbreeCall::k1, RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT);
  Distances distances(batch.count, HUGE_VAL);
  for (std::uint32_t i = 0; i < batch.count; ++i) {
    if (rays.Primitive(i, scene) != kNoPrimitive) distances[i] = static_cast<double>(rays.t(i));
  }
  return distances;
}

PlaceErrors ErrorsOf(const Place& place, const char* tracer, const Distances& exact,
                     const Distances& found) {
  PlaceErrors errors{place.moved, place.scaled, tracer, static_cast<std::uint32_t>(exact.size())};
  std::vector<double> relative;
  for (std::size_t i = 0; i < exact.size(); ++i) {
    if (std::isinf(exact[i]) || std::isinf(found[i])) {
      errors.hit_or_miss += std::isinf(exact[i]) != std::isinf(found[i]);
      continue;
    }
    relative.push_back(std::abs(found[i] / place.scaled / exact[i] - 1));
    // Not less for NaN either.
    errors.other_t += !(relative.back() <= kSameT);
  }
  if (relative.empty()) return errors;
  const auto middle = relative.begin() + static_cast<std::ptrdiff_t>(relative.size() / 2);
  std::nth_element(relative.begin(), middle, relative.end());
  errors.median = *middle;
  errors.most = *std::max_element(relative.begin(), relative.end());
  return errors;
}

}  // namespace

void ComparePlaces(const BenchScene& scene, const PlaceOptions& options,
                   const std::function<void(const PlaceErrors&)>& report) {
  std::vector<Place> places = {{0, 1}};
  for (const double moved : options.moved) places.push_back({moved, 1});
  for (const double scaled : options.scaled) places.push_back({0, scaled});
  const RayBatch made = PrimaryRays(scene, options.picture_size);
  const Distances exact = TraceDouble(scene, made);
  for (const Place& place : places) {
    const BenchScene placed = Placed(scene, place);
    // The same directions, and the eye as a float there.
    RayBatch rays = PrimaryRays(scene, options.picture_size);
    const RayOutput<float> to = rays.stream.output();
    float* const origin[3] = {to.origin_x, to.origin_y, to.origin_z};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      std::fill_n(origin[axis], rays.count, place.Coordinate(scene.eye[axis], axis));
    }
    report(ErrorsOf(place, "Sheaf", exact, TraceSheaf(placed, rays)));
    report(ErrorsOf(place, "Embree", exact, TraceEmbree(placed, rays, RTC_SCENE_FLAG_NONE)));
    report(
        ErrorsOf(place, "Embree robust", exact, TraceEmbree(placed, rays, RTC_SCENE_FLAG_ROBUST)));
  }
}

}  // namespace sheaf::bench
