// Triangles of any size that floats have are hit, or counted as what is never hit.
#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "random_rays.h"
#include "sheaf/geometry.h"
#include "targets.h"

namespace sheaf {
namespace {

const std::vector<std::uint32_t> kOne = {0, 1, 2};

template <typename Real>
GeometryOf<Real> BuildOne(const std::vector<Real>& vertices) {
  GeometryInput input;
  input.AddTriangles(vertices, kOne);
  return std::move(GeometryOf<Real>::Build(input)).value();
}

template <typename Real, typename Body>
void OnEachTarget(Body body) {
  ForEachTarget(body);
  body(Target::Scalar());
}

// A triangle of half size s and a ray at its inside that has a way of its own.
template <typename Real>
struct Aim {
  std::vector<Real> vertices;
  scalar::Ray<Real> ray;
  Real t;
};

template <typename Real>
std::vector<Aim<Real>> AimsAt(Real s) {
  const std::vector<Real> flat = {-s, -s, 0, s, -s, 0, 0, s, 0};
  const std::vector<Real> tilted = {-s, -s, s / 2, s, -s, -s / 4, 0, s, 0};
  const Real x = Real(0.125) * s, y = Real(-0.25) * s, one = 1;
  std::vector<Aim<Real>> aims = {{flat, {{x, y, -s}, {0, 0, s}}, one},
                                 {tilted, {{x, y, -s}, {0, 0, s}}, 0},
                                 {flat, {{x, y, -s}, {s / 128, s / 64, s}}, one}};
  // Directions of length 1, where t is a normal number, and rays from a distance of 1.
  if (s >= std::numeric_limits<Real>::min()) {
    aims.push_back({flat, {{x, y, -s}, {0, 0, 1}}, s});
    aims.push_back({tilted, {{x, y, -s}, {Real(0.01), Real(0.02), 1}}, 0});
  }
  if (s <= 1) aims.push_back({flat, {{x, y, -1}, {0, 0, 1}}, one});
  return aims;
}

template <typename Real>
void CheckAim(const Aim<Real>& aim) {
  const GeometryOf<Real> geometry = BuildOne(aim.vertices);
  REQUIRE(geometry.statistics().triangles == 1);
  RayLists<Real> rays;
  for (int i = 0; i < 20; ++i) rays.Add(aim.ray);
  OnEachTarget<Real>([&](Target target) {
    HitLists<Real> hits(rays.size());
    TraceOptionsOf<Real> options;
    options.target = target;
    TraceClosest(geometry, rays.view(), rays.size(), hits.view(), options).value();
    std::vector<std::uint32_t> occluded(rays.size());
    TraceOccluded(geometry, rays.view(), rays.size(), occluded.data(), options).value();
    std::size_t right = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      right += hits.primitive[i] == 0 && hits.object[i] == 0 && occluded[i] == 1 &&
               (aim.t == 0 ? hits.t[i] > 0 : hits.t[i] == aim.t);
    }
    CHECK(right == rays.size());
    const HitPointOf<Real> point = FindHitPoint(geometry, rays.view(), hits.view(), 0).value();
    CHECK(std::abs(point.position[0] - (aim.ray.origin.x + hits.t[0] * aim.ray.direction.x)) <=
          std::abs(aim.vertices[0]) / 1000);
  });
}

TEST_CASE("a float triangle of any size is hit, or counted") {
  for (int power = -149; power <= 126; ++power) {
    CAPTURE(power);
    const float s = std::ldexp(1.0f, power);
    for (const Aim<float>& aim : AimsAt(s)) {
      const GeometryStatistics statistics = BuildOne(aim.vertices).statistics();
      CHECK(statistics.triangles + statistics.never_hit == 1);
      if (power >= -126) CHECK(statistics.triangles == 1);
      if (statistics.triangles == 1) CheckAim(aim);
    }
  }
}

TEST_CASE("a double triangle of any size is hit, or counted") {
  for (int power = -1000; power <= 1000; power += 25) {
    CAPTURE(power);
    const double s = std::ldexp(1.0, power);
    for (const Aim<double>& aim : AimsAt(s)) {
      const GeometryStatistics statistics = BuildOne(aim.vertices).statistics();
      CHECK(statistics.triangles + statistics.never_hit == 1);
      if (std::abs(power) <= 450) CHECK(statistics.triangles == 1);
      if (statistics.triangles == 1) CheckAim(aim);
    }
  }
}

// What is of everyday size is not scaled, so that nothing is copied.
TEST_CASE("the box is the user's, at any scale") {
  for (const int power : {-120, -60, -20, 0, 30, 60, 100, 126}) {
    CAPTURE(power);
    const float s = std::ldexp(1.0f, power);
    const Geometry geometry = BuildOne<float>({-s, -s, 0, s, -s, 0, 0, s, s});
    for (std::size_t axis = 0; axis < 3; ++axis) {
      CHECK(geometry.lower()[axis] <= (axis == 2 ? 0 : -s));
      CHECK(geometry.lower()[axis] >= (axis == 2 ? -s * 1e-5f : -s * 1.00001f));
      CHECK(geometry.upper()[axis] >= s);
      CHECK(geometry.upper()[axis] <= s * 1.00001f);
    }
  }
}

struct Mixed {
  float large, small;
  std::uint32_t triangles;
};

TEST_CASE("a triangle too small beside another is counted as never hit") {
  for (const Mixed& mixed : {Mixed{0x1p80f, 1, 2},
                             {0x1p100f, 1, 2},
                             {0x1p120f, 1, 1},
                             {0x1p60f, 0x1p-20f, 2},
                             {0x1p30f, 0x1p-40f, 2},
                             {0x1p-60f, 0x1p-110f, 2}}) {
    CAPTURE(mixed.large);
    std::vector<float> vertices;
    for (const float s : {mixed.large, mixed.small}) {
      const float z = s == mixed.large ? 0.0f : -s;
      vertices.insert(vertices.end(), {-s, -s, z, s, -s, z, 0, s, z});
    }
    GeometryInput input;
    const std::vector<std::uint32_t> indices = {0, 1, 2, 3, 4, 5};
    input.AddTriangles(vertices, indices);
    const Geometry geometry = std::move(Geometry::Build(input)).value();
    CHECK(geometry.statistics().triangles == mixed.triangles);
    CHECK(geometry.statistics().never_hit == 2 - mixed.triangles);
    RayLists<float> rays;
    rays.Add({{0, 0, -mixed.small * 4}, {0, 0, mixed.small}});
    OnEachTarget<float>([&](Target target) {
      HitLists<float> hits(1);
      TraceClosest(geometry, rays.view(), 1, hits.view(), {.target = target}).value();
      CHECK(hits.primitive[0] == (mixed.triangles == 2 ? 1 : 0));
      CHECK(hits.t[0] == (mixed.triangles == 2 ? 3 : 4));
    });
  }
}

// Scaling rounds nothing: a crowd of everything at any scale has the same hits.
TEST_CASE("a large or small geometry has the hits that it has at scale 1") {
  Random random(5);
  RandomObjects<float> objects(random, 60);
  RayLists<float> rays;
  for (int i = 0; i < 400; ++i) {
    const Vec3d from = UniformPoint(random, -6, 6), to = UniformPoint(random, -3, 3);
    const Vec3d way = to - from;
    rays.Add({ToVec3(from).To<float>(), ToVec3(way).To<float>()});
  }
  const Geometry unit = std::move(Geometry::Build(objects.Input())).value();
  HitLists<float> want(rays.size());
  TraceClosest(unit, rays.view(), rays.size(), want.view()).value();
  for (const int power : {-90, -70, 70, 90, 110}) {
    CAPTURE(power);
    RandomObjects<float> moved = objects;
    RayLists<float> moved_rays = rays;
    const auto scale = [&](std::vector<float>& numbers) {
      for (float& x : numbers) x = std::ldexp(x, power);
    };
    scale(moved.vertices), scale(moved.bare), scale(moved.spheres);
    for (std::size_t i = 0; i < moved.disks.size(); ++i) {
      if (i % 7 < 4) moved.disks[i] = std::ldexp(moved.disks[i], power);
    }
    for (auto& numbers : moved_rays.number) scale(numbers);
    const Geometry geometry = std::move(Geometry::Build(moved.Input())).value();
    CHECK(geometry.statistics().never_hit == 0);
    OnEachTarget<float>([&](Target target) {
      HitLists<float> hits(rays.size());
      TraceClosest(geometry, moved_rays.view(), rays.size(), hits.view(), {.target = target})
          .value();
      CHECK(hits.primitive == want.primitive);
      CHECK(hits.object == want.object);
      CHECK(hits.t == want.t);
      CHECK(hits.u == want.u);
      CHECK(hits.v == want.v);
    });
  }
}

}  // namespace
}  // namespace sheaf
