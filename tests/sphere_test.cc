// Rays against spheres: exact roots, near-tangent decisions, and the rules of intervals and
// sources.
#include <doctest/doctest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "exact.h"
#include "random_scene.h"
#include "simd/query.h"
#include "simd/tree.h"
#include "src/scalar/trace.h"

namespace sheaf {
namespace {

using scalar::Ray;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

// One sphere with its view.
struct OneSphere {
  Vec3<float> center{0, 0, 0};
  float radius = 1;
  std::uint32_t id = 0;

  GeometryView<float> geometry() const {
    GeometryView<float> view{};
    view.spheres = {1, &center.x, &center.y, &center.z, &radius, &id};
    return view;
  }
  scalar::Hit<float> Trace(const Ray<float>& ray) const {
    return scalar::TraceClosest(geometry(), ray);
  }
  // Both queries must agree on whether there is a hit.
  bool Hits(const Ray<float>& ray) const {
    const bool closest = Trace(ray).primitive != kNoPrimitive;
    CHECK(scalar::TraceOccluded(geometry(), ray) == closest);
    return closest;
  }
};

// A ray from `distance` radii away that passes the centre at `miss` radii.
Ray<float> RayPast(Random& random, const OneSphere& sphere, double distance, double miss) {
  const Vec3<double> axis = RandomUnit(random);
  const Vec3<double> side = Normalize(Cross(axis, RandomUnit(random)));
  const double r = sphere.radius;
  const Vec3<double> center = sphere.center.To<double>();
  const Vec3<double> origin = center + axis * (r * distance);
  const Vec3<double> direction = center + side * (r * miss) - origin;
  return {origin.To<float>(), (direction * Uniform(random, 0.1, 2)).To<float>()};
}

OneSphere RandomSphere(Random& random) {
  OneSphere sphere;
  sphere.center = ToVec3(UniformPoint(random, -10, 10)).To<float>();
  sphere.radius = static_cast<float>(std::exp2(Uniform(random, -6, 6)));
  return sphere;
}

TEST_CASE("t is within an ULP of the exact root at 1 to 10^6 radii") {
  Random random(20);
  double worst = 0;
  int hits = 0;
  for (double distance = 1; distance <= 1e6; distance *= 10) {
    for (int i = 0; i < 20000; ++i) {
      const OneSphere sphere = RandomSphere(random);
      const Ray<float> ray = RayPast(random, sphere, distance + Uniform(random, 0, 1),
                                     i % 2 ? Uniform(random, 0, 1) : Uniform(random, 0.99, 1));
      const auto roots = ExactLine(ray, sphere.center, sphere.radius).Roots();
      const scalar::Hit<float> hit = sphere.Trace(ray);
      if (!roots || hit.primitive == kNoPrimitive) continue;
      ++hits;
      worst = std::max(worst, UlpsOff(hit.t, hit.u == 0 ? roots->near : roots->far));
      REQUIRE(worst <= 1);
    }
  }
  MESSAGE("largest error: ", worst, " ULP of ", hits, " hits");
  CHECK(hits > 100000);
}

// The wide test errs by a few roundoffs of |f| in the vector l to the closest point, whose length
// at tangency is r: l.l is off by at most 16 roundoffs of r (|f| + r).
TEST_CASE("rays near tangency are judged right outside the derived band") {
  Random random(21);
  int hits = 0, misses = 0, in_band = 0;
  for (double distance = 1; distance <= 1e6; distance *= 10) {
    for (int i = 0; i < 40000; ++i) {
      OneSphere sphere = RandomSphere(random);
      const Ray<float> ray = RayPast(random, sphere, distance + 0.5, 1);
      // A float direction cannot aim this well, so the radius goes where the ray does.
      const double margins[] = {1e-3, 1e-5, 1e-6, 1e-7};
      const double side = i % 2 ? 1 : -1;
      const double passes =
          static_cast<double>(Sqrt(ExactLine(ray, sphere.center, sphere.radius).l2));
      sphere.radius = static_cast<float>(passes * (1 + side * margins[i / 2 % 4]));
      const ExactLine line(ray, sphere.center, sphere.radius);
      const Exact r = sphere.radius, delta = r * r - line.l2;
      const bool is_banded = Abs(delta) <= 16 * 0x1p-53 * r * (line.f_length + r);
      in_band += is_banded;
      const bool hit = sphere.Hits(ray);
      hits += hit, misses += !hit;
      if (i / 2 % 4 == 0) REQUIRE_FALSE(is_banded);  // 0.1 % is never near enough to be in doubt
      if (is_banded) continue;
      // What the line meets, the ray does too: its origin lies outside, its direction forward.
      REQUIRE(hit == (delta >= 0));
    }
  }
  MESSAGE(hits, " hits, ", misses, " misses, ", in_band, " in the band");
  CHECK(hits > 100000);
  CHECK(misses > 100000);
}

TEST_CASE("a ground of radius 10^6 seen from 1 above") {
  Random random(22);
  const OneSphere ground{{0, -1e6f, 0}, 1e6f, 0};
  CHECK(ground.Trace({{0, 1, 0}, {0, -1, 0}}).t == 1.0f);
  double worst = 0;
  int hits = 0;
  for (int i = 0; i < 100000; ++i) {
    const Vec3<float> origin = {static_cast<float>(Uniform(random, -50, 50)), 1.0f,
                                static_cast<float>(Uniform(random, -50, 50))};
    Vec3<double> towards = RandomUnit(random);
    towards.y = -std::abs(towards.y) * (i % 2 ? 1 : 1e-2);
    const Ray<float> ray{origin, towards.To<float>()};
    const auto roots = ExactLine(ray, ground.center, ground.radius).Roots();
    const scalar::Hit<float> hit = ground.Trace(ray);
    REQUIRE((hit.primitive != kNoPrimitive) == roots.has_value());
    if (!roots) continue;
    ++hits;
    worst = std::max(worst, UlpsOff(hit.t, roots->near));
    REQUIRE(worst <= 1);
  }
  MESSAGE("largest error: ", worst, " ULP of ", hits, " hits");
  CHECK(hits > 90000);
}

TEST_CASE("an origin on the sphere: outward misses, inward takes the far root") {
  const OneSphere sphere{{0, 0, 0}, 5, 0};
  const Vec3<float> on_it[] = {{3, 4, 0}, {-4, 0, 3}, {0, -5, 0}, {0, 3, -4}};
  for (const Vec3<float> p : on_it) {
    CHECK_FALSE(sphere.Hits({p, p}));
    CHECK_FALSE(sphere.Hits({p, {p.y, p.z, p.x}, 0}));  // any direction, with the source given
    const scalar::Hit<float> through = sphere.Trace({p, -p});
    CHECK(through.primitive == 0);
    CHECK(through.t == 2);
    CHECK(through.u == 1);
  }
  // Exactly tangent: the only contact is the origin itself, which does not count.
  CHECK_FALSE(sphere.Hits({{3, 4, 0}, {4, -3, 0}}));
}

TEST_CASE("from the centre t is the radius") {
  Random random(23);
  for (int i = 0; i < 1000; ++i) {
    const OneSphere sphere = RandomSphere(random);
    for (const Vec3<float> axis : {Vec3<float>{1, 0, 0}, {0, -1, 0}, {0, 0, 1}}) {
      const scalar::Hit<float> hit = sphere.Trace({sphere.center, axis});
      REQUIRE(hit.t == sphere.radius);
      REQUIRE(hit.u == 1);
    }
    const Ray<float> ray{sphere.center, RandomUnit(random).To<float>()};
    const auto roots = ExactLine(ray, sphere.center, sphere.radius).Roots();
    REQUIRE(UlpsOff(sphere.Trace(ray).t, roots->far) <= 1);
  }
}

TEST_CASE("a sphere of radius 0 is never hit") {
  Random random(24);
  Scene scene;
  scene.materials.push_back({});
  scene.objects.push_back({"", Sphere{{1, 2, 3}, 0.0}, 0});
  const CompiledScene<float> compiled = CompileScene<float>(scene);
  for (int i = 0; i < 1000; ++i) {
    const Vec3<float> origin = ToVec3(UniformPoint(random, -5, 5)).To<float>();
    const Ray<float> ray{origin, Vec3<float>{1, 2, 3} - origin};
    CHECK(scalar::TraceClosest(compiled.geometry(), ray).primitive == kNoPrimitive);
    CHECK_FALSE(scalar::TraceOccluded(compiled.geometry(), ray));
  }
  CHECK_FALSE(OneSphere{{1, 2, 3}, kNan, 0}.Hits({{0, 0, 0}, {1, 2, 3}}));
}

TEST_CASE("t scales bit for bit with powers of two") {
  Random random(25);
  int hits = 0;
  for (int i = 0; i < 2000; ++i) {
    const OneSphere sphere = RandomSphere(random);
    const Ray<float> ray =
        RayPast(random, sphere, std::exp2(Uniform(random, -1, 10)), Uniform(random, 0, 1.1));
    const scalar::Hit<float> hit = sphere.Trace(ray);
    hits += hit.primitive != kNoPrimitive;
    for (int power = -20; power <= 20; ++power) {
      const float s = std::ldexp(1.0f, power);
      const OneSphere scaled{sphere.center * s, sphere.radius * s, 0};
      const scalar::Hit<float> world = scaled.Trace({ray.origin * s, ray.direction});
      const scalar::Hit<float> direction = sphere.Trace({ray.origin, ray.direction * s});
      REQUIRE(world.primitive == hit.primitive);
      REQUIRE(direction.primitive == hit.primitive);
      if (hit.primitive == kNoPrimitive) continue;
      REQUIRE(world.t == hit.t * s);
      REQUIRE(direction.t == hit.t / s);
    }
  }
  CHECK(hits > 1000);
}

TEST_CASE("the interval includes its ends") {
  const OneSphere sphere{{0, 0, 10}, 2, 0};
  const auto trace = [&](float t_min, float t_max) {
    return sphere.Trace({{0, 0, 0}, {0, 0, 1}, kNoPrimitive, t_min, t_max});
  };
  const float after = std::nextafter(8.0f, 9.0f), before = std::nextafter(8.0f, 7.0f);
  CHECK(trace(8, 8).t == 8);
  CHECK(trace(8, 8).u == 0);
  CHECK(trace(12, 12).t == 12);
  CHECK(trace(12, 12).u == 1);
  CHECK(trace(after, kInfinity).t == 12);
  CHECK(trace(0, before).primitive == kNoPrimitive);
  CHECK(trace(0, before).t == before);  // a miss shows the end of its interval
  CHECK(trace(after, std::nextafter(12.0f, 11.0f)).primitive == kNoPrimitive);
  CHECK(trace(std::nextafter(12.0f, 13.0f), kInfinity).primitive == kNoPrimitive);
  CHECK(trace(0, kInfinity).t == 8);
  CHECK(trace(-100, 100).t == 8);
  CHECK(trace(9, 7).primitive == kNoPrimitive);  // empty
  CHECK(trace(kInfinity, kInfinity).primitive == kNoPrimitive);
  // Behind the ray, a negative interval finds it.
  CHECK(sphere.Trace({{0, 0, 20}, {0, 0, 1}, kNoPrimitive, -100, -1}).t == -12);
  CHECK_FALSE(sphere.Hits({{0, 0, 20}, {0, 0, 1}}));
}

TEST_CASE("rays that are not numbers or have no direction miss") {
  const OneSphere sphere{{0, 0, 0}, 2, 0};
  const Ray<float> sound{{0, 0, 0}, {0, 0, 1}};
  CHECK(sphere.Hits(sound));
  for (const float bad : {kNan, kInfinity, -kInfinity}) {
    for (int axis = 0; axis < 3; ++axis) {
      Ray<float> ray = sound;
      (axis == 0 ? ray.origin.x : axis == 1 ? ray.origin.y : ray.origin.z) = bad;
      CHECK_FALSE(sphere.Hits(ray));
      ray = sound;
      (axis == 0 ? ray.direction.x : axis == 1 ? ray.direction.y : ray.direction.z) = bad;
      CHECK_FALSE(sphere.Hits(ray));
    }
  }
  CHECK_FALSE(sphere.Hits({{0, 0, 0}, {0, 0, 0}}));
  CHECK_FALSE(sphere.Hits({{0, 0, 0}, {-0.0f, 0, -0.0f}}));
  CHECK_FALSE(sphere.Hits({{0, 0, 0}, {0, 0, 1}, kNoPrimitive, kNan, 10.0f}));
  CHECK_FALSE(sphere.Hits({{0, 0, 0}, {0, 0, 1}, kNoPrimitive, 0.0f, kNan}));
  for (int axis = 0; axis < 3; ++axis) {
    OneSphere broken = sphere;
    (axis == 0 ? broken.center.x : axis == 1 ? broken.center.y : broken.center.z) = kNan;
    CHECK_FALSE(broken.Hits(sound));
  }
}

TEST_CASE("the source is excluded by its id, whatever rounding says") {
  Random random(26);
  const std::uint32_t id = 7;
  for (int i = 0; i < 20000; ++i) {
    OneSphere sphere = RandomSphere(random);
    sphere.id = id;
    const Vec3<double> out = RandomUnit(random);
    const Vec3<float> point =
        (sphere.center.To<double>() + out * static_cast<double>(sphere.radius)).To<float>();
    Vec3<double> towards = RandomUnit(random);
    if (Dot(towards, out) < 0) towards = -towards;
    if (i % 4 == 0) towards = Cross(out, towards);  // grazing
    const Vec3<float> outward = towards.To<float>();
    REQUIRE_FALSE(sphere.Hits({point, outward, id}));
    // Another primitive's ray sees it whole.
    const Vec3<float> before = point + point - sphere.center;
    CHECK(sphere.Trace({before, sphere.center - before, id + 1}).u == 0);

    // Inside: the far root alone, even where rounding put the origin outside and the near root
    // ahead.
    const Vec3<float> inward = (sphere.center.To<double>() - point.To<double>()).To<float>();
    for (const Vec3<float> origin : {point, before}) {
      const scalar::Hit<float> hit = sphere.Trace({origin, inward, id | kInsideBit});
      REQUIRE(hit.primitive == id);
      REQUIRE(hit.u == 1);
      const auto roots = ExactLine({origin, inward}, sphere.center, sphere.radius).Roots();
      REQUIRE(UlpsOff(hit.t, roots->far) <= 1);
    }
  }
}

TEST_CASE("spheres of 1.0 and 1.00004: both surfaces, in order; equal ones: the lowest id") {
  const float x[] = {0, 0, 0}, y[] = {0, 0, 0}, z[] = {0, 0, 0};
  const float radius[] = {1.0f, 1.00004f, 1.00004f};
  const std::uint32_t id[] = {2, 5, 4};
  GeometryView<float> geometry{};
  geometry.spheres = {3, x, y, z, radius, id};
  Ray<float> ray{{0.1f, 0.2f, -8}, {0, 0, 1}};
  const std::uint32_t want[] = {4, 2, 2, 4};
  for (const std::uint32_t primitive : want) {
    const scalar::Hit<float> hit = scalar::TraceClosest(geometry, ray);
    CHECK(hit.primitive == primitive);
    ray.t_min = std::nextafter(hit.t, kInfinity);
  }
  CHECK(scalar::TraceClosest(geometry, ray).primitive == kNoPrimitive);
}

}  // namespace
}  // namespace sheaf
