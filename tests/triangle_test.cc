// One ray and one triangle: degenerate triangles, planes, intervals, and the error of t.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>

#include "exact.h"
#include "random_scene.h"
#include "simd/query.h"
#include "src/scalar/trace.h"
#include "triangle_mesh.h"

namespace sheaf {
namespace {

using scalar::Ray;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

// IntersectTriangle itself, without what scene compilation leaves out.
std::optional<scalar::TriangleHit<float>> Intersect(const Ray<float>& ray, Vec3<float> a,
                                                    Vec3<float> b, Vec3<float> c) {
  return scalar::IntersectTriangle(ray.origin, ray.direction, ray.t_min,
                                   scalar::ShearOf(ray.direction), {a, b, c});
}

TEST_CASE("collinear vertices are missed") {
  const Vec3<float> a{-1113.45459f, -79.049614f, -56.2431908f};
  const Vec3<float> b{-1113.45459f, -87.0922699f, -56.2431908f};
  const Vec3<float> c{-1113.45459f, -79.2090149f, -56.2431908f};
  Ray<float> ray{{-1081.47925f, 99.9999542f, 87.7701111f},
                 {-32.1072998f, -183.355865f, -144.607635f}};
  ray.t_max = .9999f;
  const TriangleMesh mesh{{a, b, c}, {{0, 1, 2}}};
  const CompiledScene<float> scene = mesh.Compile();
  CHECK(scalar::TraceClosest(scene.geometry(), ray).primitive == kNoPrimitive);
  CHECK_FALSE(scalar::TraceOccluded(scene.geometry(), ray));
}

TEST_CASE("triangles without area are missed and make no NaN") {
  Random random(31);
  const auto point = [&] { return ToVec3(UniformPoint(random, -2, 2)).To<float>(); };
  for (int i = 0; i < 20000; ++i) {
    const Vec3<float> a = point(), b = point();
    const TriangleMesh meshes[] = {{{a, a, a}, {{0, 1, 2}}},
                                   {{a, a, b}, {{0, 1, 2}}},
                                   {{a, b, a}, {{0, 1, 2}}},
                                   {{b, a, a}, {{0, 1, 2}}},
                                   {{a, a * 2.0f, a * 4.0f}, {{0, 1, 2}}}};
    const Vec3<float> origin = point();
    const Ray<float> ray{origin, a - origin};
    for (const TriangleMesh& mesh : meshes) {
      const CompiledScene<float> scene = mesh.Compile();
      const scalar::Hit<float> hit = scalar::TraceClosest(scene.geometry(), ray);
      REQUIRE(hit.primitive == kNoPrimitive);
      REQUIRE(hit.t == kDefaultTMax<float>);
      // Two vertices alike make two edge functions opposite and one zero, so det is 0 too.
      const auto& v = mesh.vertices;
      if (&mesh != &meshes[4]) REQUIRE_FALSE(Intersect(ray, v[0], v[1], v[2]).has_value());
    }
  }
}

TEST_CASE("of coplanar duplicates the lowest id is hit") {
  Random random(32);
  const Vec3<float> v[3] = {{-1, -1, 0.3f}, {1, -1, -0.2f}, {0, 1.5f, 0.1f}};
  // The same triangle with its vertices turned and mirrored: another order of the same products.
  const std::array<std::uint32_t, 3> orders[] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1},
                                                 {0, 2, 1}, {2, 1, 0}, {0, 1, 2}};
  const TriangleMesh mesh{{v[0], v[1], v[2]}, {std::begin(orders), std::end(orders)}};
  CompiledScene<float> scene = mesh.Compile();
  // The lowest id anywhere in the array.
  const std::uint32_t ids[] = {5, 3, 1, 4, 2, 0};
  for (std::uint32_t i = 0; i < 6; ++i)
    scene.objects.data.arrays.ids(PrimitiveKind::kTriangle)[i] = ids[i];
  int exact = 0;
  for (int i = 0; i < 2000; ++i) {
    const Ray<float> ray{
        {0, 0, 3}, ToVec3(UniformPoint(random, -0.2, 0.2)).To<float>() - Vec3<float>{0, 0, 3}};
    const scalar::Hit<float> hit = scalar::TraceClosest(scene.geometry(), ray);
    REQUIRE(hit.primitive != kNoPrimitive);
    std::uint32_t lowest = kNoPrimitive;
    for (std::uint32_t k = 0; k < 6; ++k) {
      const auto one =
          scalar::HitTriangle(ray, scalar::ShearOf(ray.direction), scene.geometry().triangles, k);
      REQUIRE(one.has_value());
      REQUIRE(one->t >= hit.t);
      if (one->t == hit.t) lowest = std::min(lowest, ids[k]);
    }
    REQUIRE(hit.primitive == lowest);
    exact += lowest == 0;
  }
  CHECK(exact > 500);
}

TEST_CASE("a ray in the triangle's plane is stable") {
  Random random(33);
  int hits = 0;
  for (int i = 0; i < 50000; ++i) {
    const auto flat = [&] {
      const Vec3d p = UniformPoint(random, -2, 2);
      return Vec3<float>{static_cast<float>(p.x), static_cast<float>(p.y), 0.25f};
    };
    Vec3<float> v[3] = {flat(), flat(), flat()};
    Ray<float> ray{flat(), flat() - flat()};
    ray.direction.z = 0;
    if (i % 3 == 1)
      ray = {{ray.origin.z, ray.origin.x, ray.origin.y}, {0, ray.direction.x, ray.direction.y}};
    if (i % 3 == 1) {
      for (auto& p : v) p = {p.z, p.x, p.y};
    }
    if (i % 3 == 2) {  // a slanted plane, which rounding leaves on either side
      const auto slant = [](Vec3<float> p) {
        return Vec3<float>{p.x, p.y, 0.3f * p.x - 0.7f * p.y + 0.1f};
      };
      for (auto& p : v) p = slant(p);
      const Vec3<float> from = slant(ray.origin);
      ray = {from, slant(ray.origin + ray.direction) - from};
    }
    if (i % 6 == 0) ray.direction = v[1] - ray.origin;  // at a vertex
    const auto hit = Intersect(ray, v[0], v[1], v[2]);
    if (!hit) continue;
    ++hits;
    REQUIRE(std::isfinite(hit->t));
    REQUIRE((hit->u >= 0 && hit->u <= 1));
    REQUIRE((hit->v >= 0 && hit->v <= 1));
  }
  CHECK(hits > 100);  // by rounding; each is finite
}

TEST_CASE("-0 traces as +0") {
  const auto signs = [](Vec3<float> v, unsigned mask) {
    if (v.x == 0 && mask & 1) v.x = -0.0f;
    if (v.y == 0 && mask & 2) v.y = -0.0f;
    if (v.z == 0 && mask & 4) v.z = -0.0f;
    return v;
  };
  const Vec3<float> corner[] = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}};
  const Vec3<float> targets[] = {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {2, 2, 0}, {1, 1, 0}, {4, 0, 0}};
  for (const Vec3<float> target : targets) {
    for (const Vec3<float> direction : {Vec3<float>{0, 0, -2}, {1, 0, -2}, {0, 1, -2}}) {
      const Ray<float> ray{target - direction, direction};
      const auto want = Intersect(ray, corner[0], corner[1], corner[2]);
      REQUIRE(want.has_value());
      for (unsigned mask = 0; mask < 512; ++mask) {
        const Ray<float> other{signs(ray.origin, mask), signs(ray.direction, mask >> 3)};
        const auto got = Intersect(other, signs(corner[0], mask >> 6), signs(corner[1], mask >> 6),
                                   signs(corner[2], mask >> 6));
        REQUIRE(got.has_value());
        REQUIRE(got->t == want->t);
        REQUIRE(got->u == want->u);
        REQUIRE(got->v == want->v);
      }
    }
  }
}

// What is rounded are vertices seen from the origin: their reach over the length of the path is the
// problem's own condition, 1 to 2 from a distance and large right before a large triangle. Needles
// lose the ratio of their sides besides.
TEST_CASE("t is within 8 ULP times reach over path, of no needle and away from grazing") {
  Random random(37);
  double worst_t = 0, worst_point = 0;
  int hits = 0;
  while (hits < 300000) {
    const double size = std::exp2(Uniform(random, -8, 4)), away = std::exp2(Uniform(random, -2, 8));
    const Vec3<double> centre = ToVec3(UniformPoint(random, -1, 1));
    Vec3<float> v[3];
    for (auto& p : v) p = (centre + ToVec3(UniformPoint(random, -size, size))).To<float>();
    const Vec3<float> origin =
        (centre + Normalize(ToVec3(UniformPoint(random, -1, 1))) * (size * away)).To<float>();
    double w[3] = {Uniform(random, 0, 1), Uniform(random, 0, 1), Uniform(random, 0, 1)};
    const double sum = w[0] + w[1] + w[2];
    const Vec3<double> target = v[0].To<double>() * (w[0] / sum) +
                                v[1].To<double>() * (w[1] / sum) + v[2].To<double>() * (w[2] / sum);
    const Ray<float> ray{origin, (target - origin.To<double>()).To<float>()};
    const auto hit = Intersect(ray, v[0], v[1], v[2]);
    const ExactPlaneHit exact = IntersectExactly(ray, v);
    if (!hit || exact.cosine < 0.5) continue;
    const auto length = [](Vec3<double> a) { return std::sqrt(Dot(a, a)); };
    const Vec3<double> ab = (v[1] - v[0]).To<double>(), ac = (v[2] - v[0]).To<double>();
    const double longest = std::max({length(ab), length(ac), length(ac - ab)});
    if (length(Cross(ab, ac)) < 0.1 * longest * longest) continue;
    ++hits;
    const double path = length(exact.point.To<double>() - origin.To<double>());
    double reach = path;
    for (const Vec3<float> p : v) reach = std::max(reach, length((p - origin).To<double>()));
    worst_t = std::max(worst_t, UlpsOff(hit->t, exact.t) * path / reach);
    // The barycentrics have to give the point back.
    const Exact u = hit->u, s = hit->v;
    const Vec3<Exact> point =
        v[0].To<Exact>() * (1 - u - s) + v[1].To<Exact>() * u + v[2].To<Exact>() * s - exact.point;
    worst_point = std::max(worst_point, length(point.To<double>()) / (reach * 0x1p-24));
    REQUIRE((hit->u >= 0 && hit->v >= 0));
    REQUIRE(hit->u + hit->v <= 1 + 0x1p-22f);
  }
  MESSAGE("largest error of t: ", worst_t,
          " ULP times reach over path; of the point: ", worst_point, " roundoffs of the reach");
  CHECK(worst_t <= 8);
  CHECK(worst_point <= 16);
}

TEST_CASE("t scales bit for bit with powers of two") {
  Random random(38);
  const auto point = [&] { return ToVec3(UniformPoint(random, -3, 3)).To<float>(); };
  int hits = 0;
  for (int i = 0; i < 10000; ++i) {
    const Vec3<float> v[3] = {point(), point(), point()};
    const Vec3<float> origin = point();
    const Ray<float> ray{origin, point() - origin};
    const auto want = Intersect(ray, v[0], v[1], v[2]);
    hits += want.has_value();
    for (int power = -20; power <= 20; power += 5) {
      const float s = std::ldexp(1.0f, power);
      const auto world = Intersect({ray.origin * s, ray.direction}, v[0] * s, v[1] * s, v[2] * s);
      const auto direction = Intersect({ray.origin, ray.direction * s}, v[0], v[1], v[2]);
      REQUIRE(world.has_value() == want.has_value());
      REQUIRE(direction.has_value() == want.has_value());
      if (!want) continue;
      REQUIRE(world->t == want->t * s);
      REQUIRE(direction->t == want->t / s);
      REQUIRE((world->u == want->u && world->v == want->v));
    }
  }
  CHECK(hits > 500);
}

TEST_CASE("intervals include their ends, and what is no number misses") {
  const TriangleMesh mesh{{{-1, -1, 4}, {1, -1, 4}, {0, 1, 4}}, {{0, 1, 2}}};
  const CompiledScene<float> scene = mesh.Compile();
  const auto hits = [&](const Ray<float>& ray) {
    const bool closest = scalar::TraceClosest(scene.geometry(), ray).primitive == 0;
    CHECK(scalar::TraceOccluded(scene.geometry(), ray) == closest);
    return closest;
  };
  const auto between = [&](float t_min, float t_max) {
    return hits({{0, 0, 0}, {0, 0, 1}, kNoPrimitive, t_min, t_max});
  };
  const float after = std::nextafter(4.0f, 5.0f), before = std::nextafter(4.0f, 3.0f);
  CHECK(between(4, 4));
  CHECK(between(4, kInfinity));
  CHECK(between(-kInfinity, 4));
  CHECK_FALSE(between(after, 100));
  CHECK_FALSE(between(0, before));
  CHECK_FALSE(between(5, 3));
  CHECK_FALSE(between(kNan, 10));
  CHECK_FALSE(between(0, kNan));
  CHECK_FALSE(hits({{0, 0, 0}, {0, 0, 0}}));
  CHECK_FALSE(hits({{0, 0, 0}, {0, 0, -1}}));
  CHECK_FALSE(hits({{0, 0, 4}, {0, 0, 1}}));  // starts on it: t = 0
  for (const float bad : {kNan, kInfinity, -kInfinity}) {
    CHECK_FALSE(hits({{bad, 0, 0}, {0, 0, 1}}));
    CHECK_FALSE(hits({{0, bad, 0}, {0, 0, 1}}));
    CHECK_FALSE(hits({{0, 0, bad}, {0, 0, 1}}));
    CHECK_FALSE(hits({{0, 0, 0}, {bad, 0, 1}}));
    CHECK_FALSE(hits({{0, 0, 0}, {0, bad, 1}}));
    CHECK_FALSE(hits({{0, 0, 0}, {0, 0, bad}}));
  }
  for (const std::uint32_t source : {0u, kInsideBit}) {  // the source triangle, either side
    CHECK_FALSE(hits({{0, 0, 0}, {0, 0, 1}, source}));
  }
  CHECK(hits({{0, 0, 0}, {0, 0, 1}, 1}));
}

}  // namespace
}  // namespace sheaf
