// Secondary and shadow rays start on their side of the surface and do not meet it again.
#include <doctest/doctest.h>

#include <cmath>

#include "exact.h"
#include "plain_surfaces.h"
#include "random_scene.h"
#include "simd/query.h"
#include "simd/shading.h"
#include "simd/tree.h"
#include "src/scalar/render_pixel.h"

namespace sheaf {
namespace {

using scalar::Ray;
using scalar::Surface;

// Shapes around points up to 1e5 away, with sizes from 1e-4 to 1e4.
struct Placement {
  Vec3<double> center;
  double size;

  explicit Placement(Random& random) {
    size = std::pow(10.0, Uniform(random, -4, 4));
    center = ToVec3(UniformPoint(random, -1, 1)) * std::pow(10.0, Uniform(random, -2, 5));
  }
};

CompiledScene<float> CompileOne(const Object& object) {
  Scene scene;
  scene.materials.push_back({});
  scene.objects.push_back(object);
  return CompileScene<float>(scene);
}

FrameView<float> FrameOf(const CompiledScene<float>& scene) {
  FrameView<float> frame{};
  frame.geometry = scene.geometry();
  frame.primitives = scene.objects.primitives;
  return frame;
}

// A ray at the shape from outside or, half the time, from its middle.
Ray<float> RayAt(Random& random, const Placement& at, bool from_inside) {
  const Vec3<double> origin =
      at.center + RandomUnit(random) * (at.size * (from_inside ? 0.3 : Uniform(random, 1.5, 30)));
  const Vec3<double> target = at.center + RandomUnit(random) * (at.size * Uniform(random, 0, 1));
  const Vec3<float> start = origin.To<float>();
  return {start, Normalize(target - start.To<double>()).To<float>()};
}

// Positive outside the sphere.
Exact SphereSide(const SphereArrays<float>& spheres, Vec3<float> p) {
  const Vec3<float> center{spheres.center_x[0], spheres.center_y[0], spheres.center_z[0]};
  const Vec3<Exact> f = p.To<Exact>() - center.To<Exact>();
  const Exact r = spheres.radius[0];
  return Dot(f, f) - r * r;
}

// A direction on the normal's side, a third of them grazing.
Vec3<float> AwayFrom(Random& random, Vec3<float> normal, int i) {
  const Vec3<double> n = normal.To<double>();
  const Vec3<double> v = RandomAbout(random, n);
  if (i % 3 != 0) return v.To<float>();
  const Vec3<double> along = Normalize(v - n * Dot(v, n));
  return Normalize(along + n * std::exp2(Uniform(random, -30, -3))).To<float>();
}

TEST_CASE("rays that a sphere spawns start on their side and do not hit it again") {
  Random random(58);
  int outside = 0, inside = 0;
  for (int i = 0; i < 200000; ++i) {
    const Placement at(random);
    const CompiledScene<float> scene = CompileOne({"", Sphere{ToGlm(at.center), at.size}, 0});
    const GeometryView<float> geometry = scene.geometry();
    const Ray<float> ray = RayAt(random, at, i % 2);
    const auto hit = scalar::TraceClosest(geometry, ray);
    if (hit.primitive == kNoPrimitive) continue;
    const Surface<float> surface = scalar::SphereSurface(ray, hit, geometry.spheres, 0);
    const Vec3<float> away = surface.normal * surface.offset;
    const Vec3<float> front = surface.position + away, back = surface.position - away;
    const Vec3<float> direction = AwayFrom(random, surface.normal, i);
    // The exact rule: by its id the sphere is not there for a ray outside it.
    const Vec3<float> out_start = surface.inside() ? back : front;
    const Vec3<float> outward = surface.inside() ? -direction : direction;
    REQUIRE_FALSE(scalar::TraceOccluded(geometry, {out_start, outward, 0}));
    // Where floats cannot resolve the sphere, a start beyond its middle is on no side of it.
    if (surface.offset > 0.05 * at.size) continue;
    const Vec3<float> in_start = surface.inside() ? front : back;
    const Vec3<float> inward = surface.inside() ? direction : -direction;
    REQUIRE(SphereSide(geometry.spheres, out_start) > 0);
    REQUIRE(SphereSide(geometry.spheres, in_start) < 0);
    // Even without its id, a ray that leaves misses: not by its rule but by where it starts.
    const bool is_grazing = i % 3 == 0;
    if (!is_grazing || at.size > 1e4 * surface.offset) {
      REQUIRE_FALSE(scalar::TraceOccluded(geometry, {out_start, outward}));
    }
    const auto far = scalar::TraceClosest(geometry, {in_start, inward, kInsideBit});
    REQUIRE(far.primitive == 0);
    REQUIRE(far.u == 1);
    ++(surface.inside() ? inside : outside);
  }
  MESSAGE(outside, " hits from outside, ", inside, " from inside");
  CHECK(outside > 10000);
  CHECK(inside > 10000);
}

// Positive on the side that the counter-clockwise normal shows to.
Exact TriangleSide(const TriangleArrays<float>& triangles, std::uint32_t i, Vec3<float> p) {
  const Vec3<Exact> a = scalar::TriangleVertex(triangles, i, 0).To<Exact>();
  const Vec3<Exact> b = scalar::TriangleVertex(triangles, i, 1).To<Exact>();
  const Vec3<Exact> c = scalar::TriangleVertex(triangles, i, 2).To<Exact>();
  return Dot(Cross(b - a, c - a), p.To<Exact>() - a);
}

// The same as a length: how far p lies over the triangle's plane.
double TriangleHeight(const TriangleArrays<float>& triangles, std::uint32_t i, Vec3<float> p) {
  const Vec3<Exact> a = scalar::TriangleVertex(triangles, i, 0).To<Exact>();
  const Vec3<Exact> n = Cross(scalar::TriangleVertex(triangles, i, 1).To<Exact>() - a,
                              scalar::TriangleVertex(triangles, i, 2).To<Exact>() - a);
  return static_cast<double>(Dot(n, p.To<Exact>() - a) / Sqrt(Dot(n, n)));
}

// A square of two triangles, turned any way; its corners are rounded to float first.
Quad RandomQuad(Random& random, const Placement& at) {
  const Vec3<double> n = RandomUnit(random);
  const Vec3<double> e = Normalize(Cross(n, RandomUnit(random))) * at.size;
  const Vec3<double> f = Cross(n, e);
  const auto corner = [&](double a, double b) {
    return ToGlm((at.center + e * a + f * b).To<float>().To<double>());
  };
  return {{corner(-1, -1), corner(1, -1), corner(1, 1), corner(-1, 1)}};
}

TEST_CASE("rays that a triangle spawns start on their side; a coplanar neighbour is not hit") {
  Random random(59);
  int hits = 0, folded = 0, flat = 0, real = 0;
  for (int i = 0; i < 200000; ++i) {
    const Placement at(random);
    const CompiledScene<float> scene = CompileOne({"", RandomQuad(random, at), 0});
    const FrameView<float> frame = FrameOf(scene);
    const Ray<float> ray = RayAt(random, at, false);
    const auto hit = scalar::TraceClosest(frame.geometry, ray);
    if (hit.primitive == kNoPrimitive) continue;
    const Surface<float> surface = scalar::SurfaceOf(frame, MaterialData<float>{}, ray, hit);
    const Vec3<float> away = surface.normal * surface.offset;
    const Exact sign = surface.inside() ? -1 : 1;
    const TriangleArrays<float>& triangles = frame.geometry.triangles;
    for (const std::uint32_t triangle : {0u, 1u}) {
      // Where rounding folded the square the neighbour is not coplanar any more.
      const bool is_own = triangle == hit.primitive;
      if (!is_own && surface.offset > 1e-3 * at.size) continue;
      // How far it is over a square that reaches farther than from here to the origin does not show
      // in the offset: it is less than 16 roundoffs of that.
      const double most = is_own || surface.offset >= kRoundoff<float> * at.size
                              ? 0
                              : 16 * double{kRoundoff<float>} * at.size;
      folded += most > 0;
      const auto height = [&](Vec3<float> p) {
        return TriangleHeight(triangles, triangle, p) * static_cast<double>(sign);
      };
      REQUIRE(height(surface.position + away) > -most);
      REQUIRE(height(surface.position - away) < most);
    }
    if (surface.offset > 1e-3 * at.size) continue;
    ++hits;
    const Vec3<float> direction = AwayFrom(random, surface.normal, i);
    if (Dot(direction, surface.normal) <= 0) continue;
    if (Dot(direction, surface.normal) <= 16 * kRoundoff<float>) {
      // As flat as the fold: what is hit is the neighbour, and rarely.
      const auto met = scalar::TraceClosest(frame.geometry,
                                            {surface.position + away, direction, surface.source});
      if (met.primitive == kNoPrimitive) continue;
      ++flat;
      const std::uint32_t neighbour = 1 - hit.primitive;
      REQUIRE(met.primitive == neighbour);
      const Exact end = TriangleSide(triangles, neighbour, {0, 0, 0});
      const Exact slope = TriangleSide(triangles, neighbour, direction) - end;
      real += TriangleSide(triangles, neighbour, surface.position + away) * slope < 0;
      continue;
    }
    REQUIRE_FALSE(scalar::TraceOccluded(frame.geometry,
                                        {surface.position + away, direction, surface.source}));
    REQUIRE_FALSE(scalar::TraceOccluded(
        frame.geometry, {surface.position - away, -direction, surface.source ^ kInsideBit}));
  }
  MESSAGE(hits, " hits, ", folded, " over a fold; ", flat, " flat rays meet the neighbour, ", real,
          " of them really");
  CHECK(hits > 20000);
  CHECK(flat < 50);
}

// A light within 32 roundoffs of the distance over the quad lies in its plane as far as floats
// tell: the vertices are rounded when seen from it, and so is n.l, whose sign alone lets it shine.
TEST_CASE("shadow rays do not meet the quad they are for, grazing light included") {
  constexpr float kInPlane = 32 * kRoundoff<float>;
  Random random(60);
  int lit = 0, grazing = 0, in_plane = 0;
  for (int i = 0; i < 200000; ++i) {
    const Placement at(random);
    const CompiledScene<float> scene = CompileOne({"", RandomQuad(random, at), 0});
    const FrameView<float> frame = FrameOf(scene);
    const Ray<float> ray = RayAt(random, at, false);
    const auto hit = scalar::TraceClosest(frame.geometry, ray);
    if (hit.primitive == kNoPrimitive) continue;
    const Surface<float> surface = scalar::SurfaceOf(frame, MaterialData<float>{}, ray, hit);
    if (surface.offset > 1e-3 * at.size) continue;
    const Vec3<float> towards = AwayFrom(random, surface.normal, i);
    LightData<float> light = PointLightAt({0, 0, 0}, 1, 0, 0);
    const LightKind kinds[] = {LightKind::kPointFromLight, LightKind::kPointFromSurface,
                               LightKind::kDirectional};
    light.kind = kinds[random() % 3];
    const bool is_point = light.kind != LightKind::kDirectional;
    const auto distance = static_cast<float>(at.size * std::exp2(Uniform(random, -2, 6)));
    const Vec3<float> at_light = is_point ? surface.position + towards * distance : towards;
    for (int axis = 0; axis < 3; ++axis) light.vector[axis] = at_light[axis];
    const auto incidence = scalar::IncidenceOf(light, surface);
    if (!(incidence.n_dot_l > 0)) continue;
    const Exact sign = surface.inside() ? -1 : 1;
    const TriangleArrays<float>& triangles = frame.geometry.triangles;
    const auto is_over = [&](std::uint32_t triangle) {
      return TriangleSide(triangles, triangle, at_light) * sign > 0;
    };
    if (is_point && !(is_over(0) && is_over(1))) continue;
    const bool is_occluded =
        scalar::TraceOccluded(frame.geometry, scalar::ShadowRay(light, surface, incidence));
    if (incidence.n_dot_l <= kInPlane) {
      in_plane += is_occluded;
      continue;
    }
    ++lit;
    grazing += incidence.n_dot_l < 1e-3f;
    if (is_occluded) {
      FAIL_CHECK("round ", i, " light kind ", static_cast<int>(light.kind), " n.l ",
                 incidence.n_dot_l, " size ", at.size, " offset ", surface.offset);
    }
  }
  MESSAGE(lit, " shadow rays, ", grazing, " of them grazing; ", in_plane,
          " occluded with the light in the plane");
  CHECK(lit > 20000);
  CHECK(grazing > 2000);
}

TEST_CASE("shadow rays do not meet the sphere they are for, from outside and inside") {
  Random random(61);
  int outside = 0, inside = 0;
  for (int i = 0; i < 200000; ++i) {
    const Placement at(random);
    const CompiledScene<float> scene = CompileOne({"", Sphere{ToGlm(at.center), at.size}, 0});
    const GeometryView<float> geometry = scene.geometry();
    const Ray<float> ray = RayAt(random, at, i % 2);
    const auto hit = scalar::TraceClosest(geometry, ray);
    if (hit.primitive == kNoPrimitive) continue;
    const Surface<float> surface = scalar::SphereSurface(ray, hit, geometry.spheres, 0);
    if (surface.offset > 1e-3 * at.size) continue;
    // A light inside lights the inside; one outside the outside.
    const double reach =
        surface.inside() ? Uniform(random, 0, 0.99) : std::exp2(Uniform(random, 0.1, 8));
    const Vec3<float> at_light = (at.center + RandomUnit(random) * (at.size * reach)).To<float>();
    for (const LightKind kind : {LightKind::kPointFromLight, LightKind::kPointFromSurface}) {
      LightData<float> light = PointLightAt(at_light, 1, 0, 0);
      light.kind = kind;
      const auto incidence = scalar::IncidenceOf(light, surface);
      if (!(incidence.n_dot_l > 0)) continue;
      ++(surface.inside() ? inside : outside);
      const Ray<float> shadow = scalar::ShadowRay(light, surface, incidence);
      // Outside, the id is the exact rule; from inside, a light may be beyond the sphere itself.
      const bool is_named = !surface.inside() || kind == LightKind::kPointFromSurface;
      REQUIRE(shadow.source == (is_named ? surface.source : kNoPrimitive));
      if (scalar::TraceOccluded(geometry, shadow)) {
        FAIL_CHECK("round ", i, " inside ", surface.inside(), " light kind ",
                   static_cast<int>(kind), " n.l ", incidence.n_dot_l, " size ", at.size,
                   " offset ", surface.offset);
      }
    }
  }
  MESSAGE(outside, " shadow rays outside, ", inside, " inside");
  CHECK(outside > 10000);
  CHECK(inside > 10000);
}

TEST_CASE("a light outside a sphere leaves its inside dark") {
  const CompiledScene<float> scene = CompileOne({"", Sphere{{0, 0, 0}, 1.0}, 0});
  const Ray<float> ray{{0, 0, 0}, {0, 1, 0}};
  const auto hit = scalar::TraceClosest(scene.geometry(), ray);
  REQUIRE(hit.primitive == 0);
  const Surface<float> surface = scalar::SphereSurface(ray, hit, scene.geometry().spheres, 0);
  REQUIRE(surface.inside());
  for (const LightKind kind : {LightKind::kPointFromLight, LightKind::kPointFromSurface}) {
    LightData<float> light = PointLightAt({0.5f, -5, 0}, 1, 0, 0);
    light.kind = kind;
    const auto incidence = scalar::IncidenceOf(light, surface);
    REQUIRE(incidence.n_dot_l > 0);
    CHECK(scalar::TraceOccluded(scene.geometry(), scalar::ShadowRay(light, surface, incidence)));
  }
}

}  // namespace
}  // namespace sheaf
