// Rays and hits as structures, in doubles, and primitives that are skipped.
#include <doctest/doctest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "bits.h"
#include "random_rays.h"
#include "sheaf/geometry.h"
#include "src/bvh/geometry_access.h"
#include "src/scalar/trace.h"
#include "targets.h"

namespace sheaf {
namespace {

// As a host may have them, with more than is needed.
template <typename Real>
struct HostRay {
  Real origin[3];
  std::uint32_t source;
  Real direction[3];
  Real t_min, t_max;
  std::uint32_t mask;
};
template <typename Real>
struct HostHit {
  std::uint32_t object;
  Real t;
  Real uv[2];
  std::uint32_t primitive;
};

template <typename Real>
struct HostRays {
  std::vector<HostRay<Real>> rays;

  explicit HostRays(const RayLists<Real>& from) {
    for (std::size_t i = 0; i < from.size(); ++i) {
      HostRay<Real> ray{{from.number[0][i], from.number[1][i], from.number[2][i]},
                        from.source[i],
                        {from.number[3][i], from.number[4][i], from.number[5][i]},
                        from.t_min[i],
                        from.t_max[i],
                        ~0u};
      rays.push_back(ray);
    }
  }
  RayArraysOf<Real> view() const {
    const HostRay<Real>& r = rays[0];
    return {&r.origin[0],    &r.origin[1],    &r.origin[2], &r.direction[0],
            &r.direction[1], &r.direction[2], &r.source,    sizeof(rays[0])};
  }
  TraceIntervalOf<Real> interval() const {
    TraceIntervalOf<Real> interval;
    interval.t_min = &rays[0].t_min;
    interval.t_max = &rays[0].t_max;
    interval.stride = sizeof(rays[0]);
    return interval;
  }
};

template <typename Real>
HitArraysOf<Real> ViewOf(std::vector<HostHit<Real>>& hits) {
  HostHit<Real>& h = hits[0];
  return {&h.t, &h.primitive, &h.object, &h.uv[0], &h.uv[1], sizeof(hits[0])};
}

template <typename Real>
bool SameHit(const HostHit<Real>& a, const HitLists<Real>& b, std::size_t i) {
  const bool same_t = SameBits(a.t, b.t[i]) || (a.t != a.t && b.t[i] != b.t[i]);
  return same_t && SameBits(a.uv[0], b.u[i]) && SameBits(a.uv[1], b.v[i]) &&
         a.primitive == b.primitive[i] && a.object == b.object[i];
}

TEST_CASE_TEMPLATE("rays as structures have the hits of rays as arrays", Real, float, double) {
  Random random(1);
  const RandomObjects<Real> objects(random, 60);
  const auto geometry = std::move(GeometryOf<Real>::Build(objects.Input())).value();
  for (const std::size_t count : {1u, 2u, 15u, 16u, 17u, 255u, 256u, 257u, 700u, 1100u}) {
    CAPTURE(count);
    RayLists<Real> rays;
    for (std::size_t i = 0; i < count; ++i) rays.Add(RandomRay<Real>(random, 240));
    const HostRays<Real> host(rays);
    const auto check = [&](Target target) {
      TraceOptionsOf<Real> by_array, by_structure;
      by_array.target = by_structure.target = target;
      by_array.interval = rays.interval();
      by_structure.interval = host.interval();
      HitLists<Real> want(count), strided_rays(count);
      std::vector<std::uint32_t> want_occluded(count), occluded(count);
      TraceClosest(geometry, rays.view(), count, want.view(), by_array).value();
      TraceOccluded(geometry, rays.view(), count, want_occluded.data(), by_array).value();
      // Structures in and out, structures in, structures out; one more than is written.
      std::vector<HostHit<Real>> both(count + 1), out(count + 1);
      both[count].t = out[count].t = -7;
      TraceClosest(geometry, host.view(), count, ViewOf(both), by_structure).value();
      TraceClosest(geometry, host.view(), count, strided_rays.view(), by_structure).value();
      TraceClosest(geometry, rays.view(), count, ViewOf(out), by_array).value();
      TraceOccluded(geometry, host.view(), count, occluded.data(), by_structure).value();
      std::size_t wrong = 0;
      for (std::size_t i = 0; i < count; ++i) {
        wrong += !SameHit(both[i], want, i) || !SameHit(out[i], want, i);
      }
      CHECK(wrong == 0);
      CHECK(both[count].t == -7);
      CHECK(out[count].t == -7);
      CHECK(strided_rays.primitive == want.primitive);
      CHECK(strided_rays.object == want.object);
      CHECK(occluded == want_occluded);
      // Of structures alone, what is wanted.
      std::vector<HostHit<Real>> some(count);
      for (HostHit<Real>& hit : some) hit.t = -7;
      HitArraysOf<Real> wanted;
      wanted.primitive = &some[0].primitive;
      wanted.stride = sizeof(some[0]);
      TraceClosest(geometry, host.view(), count, wanted, by_structure).value();
      CHECK(some[count - 1].primitive == want.primitive[count - 1]);
      CHECK(some[count - 1].t == -7);
    };
    ForEachTarget(check);
    check(Target::Scalar());
  }
}

TEST_CASE("structures may be packed") {
  const std::vector<float> sphere = {0, 0, 0, 1};
  GeometryInput input;
  input.AddSpheres(sphere);
  const Geometry geometry = std::move(Geometry::Build(input)).value();
  constexpr std::size_t kStride = 27;
  std::vector<std::byte> bytes(kStride * 40 + 1), out(kStride * 40 + 1);
  for (std::size_t i = 0; i < 40; ++i) {
    const float ray[6] = {0, 0, static_cast<float>(i + 2), 0, 0, -1};
    std::memcpy(&bytes[kStride * i + 1], ray, sizeof(ray));
  }
  const auto at = [&](std::size_t k) {
    return reinterpret_cast<const float*>(&bytes[1 + 4 * k]);  // as a packed structure's address
  };
  HitArrays hits;
  hits.t = reinterpret_cast<float*>(&out[1]);
  hits.stride = kStride;
  RayArrays rays = {at(0), at(1), at(2), at(3), at(4), at(5)};
  rays.stride = kStride;
  TraceClosest(geometry, rays, 40, hits).value();
  for (std::size_t i = 0; i < 40; ++i) {
    float t;
    std::memcpy(&t, &out[kStride * i + 1], sizeof(t));
    CHECK(t == static_cast<float>(i + 1));
  }
}

// ---- Doubles ----

TEST_CASE("doubles are traced as the specification traces doubles") {
  Random random(2);
  RandomObjects<double> objects(random, 60);
  // Numbers that floats do not have.
  for (std::vector<double>* list : {&objects.vertices, &objects.bare, &objects.spheres}) {
    for (double& x : *list) x = x * (1 + 1e-12);
  }
  const GeometryInput input = objects.Input();
  const GeometryD geometry = std::move(GeometryD::Build(input)).value();
  const auto flat = std::move(GeometryAccess::FlattenTo<double>(input, {})).value();
  CHECK(GeometryAccess::ScaleOf(geometry) == 1);
  RayLists<double> rays;
  std::vector<scalar::Ray<double>> list;
  for (int i = 0; i < 1000; ++i) {
    list.push_back(RandomRay<double>(random, 240));
    rays.Add(list.back());
  }
  const auto check = [&](Target target) {
    HitLists<double> hits(rays.size());
    std::vector<std::uint32_t> occluded(rays.size());
    TraceOptionsD options;
    options.target = target;
    options.interval = rays.interval();
    TraceClosest(geometry, rays.view(), rays.size(), hits.view(), options).value();
    TraceOccluded(geometry, rays.view(), rays.size(), occluded.data(), options).value();
    int wrong = 0, hit = 0;
    for (std::size_t i = 0; i < list.size(); ++i) {
      const scalar::Hit<double> want = scalar::TraceClosest(flat.arrays.view(), list[i]);
      const bool same_t = SameBits(hits.t[i], want.t) || (want.t != want.t);
      hit += want.primitive != kNoPrimitive;
      wrong += !same_t || !SameBits(hits.u[i], want.u) || !SameBits(hits.v[i], want.v) ||
               hits.primitive[i] != want.primitive ||
               occluded[i] != (scalar::TraceOccluded(flat.arrays.view(), list[i]) ? 1u : 0u);
    }
    CHECK(hit > 200);
    CHECK(wrong == 0);
  };
  ForEachTarget(check);
  check(Target::Scalar());
}

TEST_CASE("floats and doubles may be given to either") {
  const std::vector<float> f = {0, 0, 2, 0.5f};
  const double d[] = {0, 0, 1 + 1e-12, 0.5};
  GeometryInput input;
  CHECK(input.AddSpheres(f) == 0);
  CHECK(input.AddSpheres(d) == 1);
  const Geometry floats = std::move(Geometry::Build(input)).value();
  const GeometryD doubles = std::move(GeometryD::Build(input)).value();
  CHECK(floats.statistics().spheres == 2);
  RayLists<double> ray;
  ray.Add({{0, 0, -1}, {0, 0, 1}});
  HitLists<double> hit(1);
  TraceClosest(doubles, ray.view(), 1, hit.view()).value();
  CHECK(hit.object[0] == 1);
  CHECK(std::abs(hit.t[0] - (1.5 + 1e-12)) < 1e-15);
  // A double that is no float is infinite there.
  const std::vector<double> large = {0, 0, 1e300, 1};
  GeometryInput beyond;
  beyond.AddSpheres(large);
  CHECK(Geometry::Build(beyond).error().message ==
        "object 0, sphere 0: a coordinate is not finite");
  CHECK(GeometryD::Build(beyond).ok());
}

// ---- What is not finite ----

TEST_CASE("primitives that are not finite are refused by name, or skipped and counted") {
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  const std::vector<float> vertices = {-1,        -1, 0, 1, -1, 0,  0, 1, 0,  kNaN, -1, 0, 1, -1,
                                       kInfinity, 0,  1, 0, -1, -1, 5, 1, -1, 5,    0,  1, 5};
  std::vector<std::uint32_t> indices;
  for (std::uint32_t i = 0; i < 9; ++i) indices.push_back(i);
  indices.insert(indices.end(), {0, 1, 3, 6, 7, 6});
  const std::vector<float> spheres = {0, 0, 8, 1, 0, kInfinity, 8, 1, 0, 0, 9, kNaN, 0, 0, 20, 1};
  const std::vector<float> disks = {0, 0, 12, 1, 0, 0, kNaN, 0, 0, 13, 1, 0, 0, 1};
  GeometryInput input;
  input.AddTriangles(vertices, indices);
  input.AddSpheres(spheres);
  input.AddDisks(disks);
  CHECK(Geometry::Build(input).error().message ==
        "object 0, triangle 1: a coordinate is not finite");
  for (const int threads : {1, 2}) {
    const Geometry geometry =
        std::move(Geometry::Build(input, {.threads = threads, .not_finite = NotFinite::kSkipped}))
            .value();
    const GeometryStatistics statistics = geometry.statistics();
    CHECK(statistics.triangles == 2);
    CHECK(statistics.spheres == 2);
    CHECK(statistics.primitives == 5);
    CHECK(statistics.skipped == 5);
    CHECK(statistics.never_hit == 1);
    CHECK(std::isfinite(geometry.lower()[1]));
    CHECK(std::isfinite(geometry.upper()[1]));
    // Ids stay what they are without skipping.
    RayLists<float> rays;
    for (const float z : {-1.0f, 1.0f, 6.0f, 10.0f, 14.0f}) rays.Add({{0, 0, z}, {0, 0, 1}});
    HitLists<float> hits(rays.size());
    TraceClosest(geometry, rays.view(), rays.size(), hits.view()).value();
    CHECK(hits.primitive == std::vector<std::uint32_t>{0, 2, 5, 10, 8});
    CHECK(hits.object == std::vector<std::uint32_t>{0, 0, 1, 2, 1});
  }
  // What is wrong otherwise stays an error.
  GeometryInput negative;
  const std::vector<float> inside_out = {0, 0, 0, -1};
  negative.AddSpheres(inside_out);
  CHECK_FALSE(Geometry::Build(negative, {.not_finite = NotFinite::kSkipped}).ok());
}

}  // namespace
}  // namespace sheaf
