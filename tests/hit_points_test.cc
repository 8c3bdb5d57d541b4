// Going on from a hit: the renderer's own points for a user's rays, which do not meet what they
// start on again.
#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "bits.h"
#include "random_rays.h"
#include "sheaf/geometry.h"
#include "src/bvh/geometry_access.h"
#include "src/scalar/primitives.h"
#include "src/scalar/trace.h"
#include "targets.h"

namespace sheaf {
namespace {

template <typename Real>
struct PointLists {
  std::vector<Real> number[15];
  std::vector<std::uint32_t> front_source, back_source, side;

  explicit PointLists(std::size_t n) : front_source(n, 7), back_source(n, 7), side(n, 7) {
    for (auto& list : number) list.assign(n, 7);
  }
  HitPointArraysOf<Real> view() {
    const auto three = [&](int k) {
      return std::array<Real*, 3>{number[k].data(), number[k + 1].data(), number[k + 2].data()};
    };
    return {three(0),           three(3),   three(6), three(9), three(12), front_source.data(),
            back_source.data(), side.data()};
  }
  HitPointOf<Real> at(std::size_t i) const {
    const auto three = [&](int k) {
      return std::array<Real, 3>{number[k][i], number[k + 1][i], number[k + 2][i]};
    };
    return {three(0),  three(3),        three(6),       three(9),
            three(12), front_source[i], back_source[i], side[i]};
  }
};

template <typename Real>
bool SamePoint(const HitPointOf<Real>& a, const HitPointOf<Real>& b) {
  return SameBits(a.position, b.position) && SameBits(a.face, b.face) &&
         SameBits(a.normal, b.normal) && SameBits(a.front, b.front) && SameBits(a.back, b.back) &&
         a.front_source == b.front_source && a.back_source == b.back_source && a.side == b.side;
}

template <typename Real>
std::array<Real, 3> Array(Vec3<Real> v) {
  return {v.x, v.y, v.z};
}

// By the specification, from the input's own arrays.
template <typename Real>
HitPointOf<Real> Expected(const GeometryView<Real>& view, const scalar::Ray<Real>& ray,
                          const scalar::Hit<Real>& hit) {
  HitPointOf<Real> point;
  if (hit.primitive == kNoPrimitive) return point;
  ForEachKind(view, [&](const auto& arrays) {
    for (std::uint32_t i = 0; i < arrays.count; ++i) {
      if (arrays.id[i] != hit.primitive) continue;
      const scalar::Surface<Real> surface = scalar::SurfaceAt(ray, hit, arrays, i);
      const Vec3<Real> away = surface.face * surface.offset;
      point = {Array(surface.position),        Array(surface.face),
               Array(surface.normal),          Array(surface.position + away),
               Array(surface.position - away), surface.source,
               surface.source ^ kInsideBit,    surface.inside() ? 1u : 0u};
    }
  });
  return point;
}

TEST_CASE_TEMPLATE("hit points are those of the specification, on every target", Real, float,
                   double) {
  Random random(1);
  const RandomObjects<Real> objects(random, 40);
  const GeometryInput input = objects.Input();
  const auto geometry = std::move(GeometryOf<Real>::Build(input)).value();
  const auto flat = std::move(GeometryAccess::FlattenTo<Real>(input, {})).value();
  const std::uint32_t primitives = geometry.first_primitive(geometry.object_count());
  RayLists<Real> rays;
  std::vector<scalar::Ray<Real>> list;
  for (int i = 0; i < 1500; ++i) {
    list.push_back(RandomRay<Real>(random, primitives));
    rays.Add(list.back());
  }
  HitLists<Real> hits(rays.size());
  TraceClosest(geometry, rays.view(), rays.size(), hits.view(), {.interval = rays.interval()})
      .value();
  std::vector<HitPointOf<Real>> want;
  int by_object[4] = {}, smooth = 0, inside = 0;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const scalar::Hit<Real> hit = {hits.t[i], hits.primitive[i], hits.u[i], hits.v[i]};
    want.push_back(Expected(flat.arrays.view(), list[i], hit));
    if (hit.primitive == kNoPrimitive) continue;
    ++by_object[hits.object[i]];
    smooth += want.back().normal != want.back().face;
    inside += want.back().side == 1;
  }
  for (const int count : by_object) CHECK(count > 30);
  CHECK(smooth > 20);
  CHECK(inside > 30);
  const auto check = [&](Target target) {
    for (const std::size_t count : {std::size_t{0}, std::size_t{1}, std::size_t{63},
                                    std::size_t{64}, std::size_t{65}, list.size()}) {
      PointLists<Real> points(list.size());
      FindHitPoints(geometry, rays.view(), hits.view(), count, points.view(), target).value();
      std::size_t wrong = 0;
      for (std::size_t i = 0; i < count; ++i) wrong += !SamePoint(points.at(i), want[i]);
      CHECK(wrong == 0);
      if (count < list.size()) CHECK(points.at(count).side == 7);
    }
  };
  ForEachTarget(check);
  check(Target::Scalar());
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < list.size(); ++i) {
    wrong += !SamePoint(FindHitPoint(geometry, rays.view(), hits.view(), i).value(), want[i]);
  }
  CHECK(wrong == 0);
  // What is null is left out.
  PointLists<Real> points(list.size());
  HitPointArraysOf<Real> some;
  some.front = points.view().front;
  FindHitPoints(geometry, rays.view(), hits.view(), list.size(), some).value();
  CHECK(points.at(0).front == want[0].front);
  CHECK(points.at(0).back[0] == 7);
}

// ---- A ray that goes on does not meet where it starts ----

// Rays at the diagonal of a parallelogram of two triangles. Its corners are whole numbers, so that
// they lie in one plane, and that runs along no axis, so that points of it are rounded off it.
struct Diagonal {
  Geometry geometry;
  RayLists<float> rays;
  Vec3<float> mirrored;  // the direction of the rays, mirrored by the plane

  Diagonal() {
    const Vec3<float> corner = {307, -211, 503}, side = {589, 31, -97}, other = {-41, 611, 203};
    std::vector<float> corners;
    for (const auto& p : {corner, corner + side, corner + side + other, corner + other}) {
      corners.insert(corners.end(), {p.x, p.y, p.z});
    }
    const std::vector<std::uint32_t> triangles = {0, 1, 2, 0, 2, 3};
    GeometryInput input;
    input.AddTriangles(corners, triangles);
    geometry = std::move(Geometry::Build(input)).value();
    const Vec3<float> normal = Normalize(Cross(side, other)), slant = Normalize(side) * 0.1f;
    const Vec3<float> direction = slant - normal;
    mirrored = slant + normal;
    for (int i = 1; i < 2000; ++i) {
      const Vec3<float> at = corner + (side + other) * (static_cast<float>(i) / 2000);
      rays.Add({at - direction * 30.0f, direction});
    }
  }

  // How many of the rays from these points hit anything.
  std::uint32_t Again(const RayArrays& from, Target target) const {
    std::vector<std::uint32_t> occluded(rays.size());
    TraceOccluded(geometry, from, rays.size(), occluded.data(), {.target = target}).value();
    std::uint32_t again = 0;
    for (const std::uint32_t hit : occluded) again += hit;
    return again;
  }
};

TEST_CASE("rays that go on from the diagonal of a square do not meet its other half") {
  const Diagonal square;
  const RayLists<float>& rays = square.rays;
  const std::size_t n = rays.size();
  const auto check = [&](Target target) {
    HitLists<float> hits(n);
    TraceClosest(square.geometry, rays.view(), n, hits.view(), {.target = target}).value();
    for (const std::uint32_t primitive : hits.primitive) REQUIRE(primitive < 2);
    PointLists<float> points(n);
    FindHitPoints(square.geometry, rays.view(), hits.view(), n, points.view(), target).value();
    std::vector<float> up[3];
    for (int k = 0; k < 3; ++k) up[k].assign(n, square.mirrored[k]);
    const auto start = [&](int k, const std::vector<float>* to, const std::uint32_t* source) {
      return RayArrays{points.number[k].data(),
                       points.number[k + 1].data(),
                       points.number[k + 2].data(),
                       to[0].data(),
                       to[1].data(),
                       to[2].data(),
                       source};
    };
    const std::vector<float>* const down = &rays.number[3];
    CHECK(square.Again(start(12, down, points.back_source.data()), target) == 0);
    CHECK(square.Again(start(9, up, points.front_source.data()), target) == 0);
    // Without the primitive too: it is the place that keeps a ray off.
    CHECK(square.Again(start(12, down, nullptr), target) == 0);
    CHECK(square.Again(start(9, up, nullptr), target) == 0);
    // On the plane itself nothing does.
    CHECK(square.Again(start(0, down, points.back_source.data()), target) > 50);
    // From o + t d, with the triangle that was hit as their source, some do.
    std::vector<float> met[3];
    for (std::size_t i = 0; i < n; ++i) {
      for (int k = 0; k < 3; ++k) {
        met[k].push_back(rays.number[k][i] + hits.t[i] * rays.number[3 + k][i]);
      }
    }
    CHECK(square.Again({met[0].data(), met[1].data(), met[2].data(), rays.number[3].data(),
                        rays.number[4].data(), rays.number[5].data(), hits.primitive.data()},
                       target) > 50);
  };
  ForEachTarget(check);
  check(Target::Scalar());
}

TEST_CASE("rays and hits as structures have the points of arrays") {
  struct Both {
    float origin[3];
    std::uint32_t id;
    float direction[3], t, uv[2];
    std::uint32_t primitive;
  };
  Random random(5);
  const RandomObjects<float> objects(random, 40);
  const Geometry geometry = std::move(Geometry::Build(objects.Input())).value();
  RayLists<float> rays;
  for (int i = 0; i < 200; ++i) rays.Add(RandomRay<float>(random, 0));
  HitLists<float> hits(rays.size());
  TraceClosest(geometry, rays.view(), rays.size(), hits.view()).value();
  std::vector<Both> both(rays.size());
  for (std::size_t i = 0; i < both.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      both[i].origin[k] = rays.number[k][i];
      both[i].direction[k] = rays.number[3 + k][i];
    }
    both[i].t = hits.t[i], both[i].uv[0] = hits.u[i], both[i].uv[1] = hits.v[i];
    both[i].primitive = hits.primitive[i];
  }
  RayArrays from = {&both[0].origin[0],    &both[0].origin[1],    &both[0].origin[2],
                    &both[0].direction[0], &both[0].direction[1], &both[0].direction[2]};
  HitArrays at = {
      .t = &both[0].t, .primitive = &both[0].primitive, .u = &both[0].uv[0], .v = &both[0].uv[1]};
  from.stride = at.stride = sizeof(both[0]);
  PointLists<float> want(rays.size()), got(rays.size());
  FindHitPoints(geometry, rays.view(), hits.view(), rays.size(), want.view()).value();
  FindHitPoints(geometry, from, at, rays.size(), got.view()).value();
  std::size_t wrong = 0, found = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    wrong += !SamePoint(got.at(i), want.at(i));
    wrong += !SamePoint(FindHitPoint(geometry, from, at, i).value(), want.at(i));
    found += want.at(i).front_source != Geometry::kNoPrimitive;
  }
  CHECK(wrong == 0);
  CHECK(found > 50);
}

TEST_CASE("a ray goes on into a sphere and out again") {
  GeometryInput input;
  const std::vector<float> sphere = {0.3f, -1e5f, 0.1f, 2};
  input.AddSpheres(sphere);
  const Geometry geometry = std::move(Geometry::Build(input)).value();
  RayLists<float> rays;
  rays.Add({{0.4f, -1e5f + 5, 0.2f}, {0.01f, -1, 0.02f}});
  HitLists<float> hits(1);
  TraceClosest(geometry, rays.view(), 1, hits.view()).value();
  const HitPoint enters = FindHitPoint(geometry, rays.view(), hits.view(), 0).value();
  CHECK(enters.side == 0);
  CHECK(enters.face[1] > 0.9f);
  const scalar::Ray<float> through = {
      {enters.back[0], enters.back[1], enters.back[2]}, {0.01f, -1, 0.02f}, enters.back_source};
  RayLists<float> on;
  on.Add(through);
  TraceClosest(geometry, on.view(), 1, hits.view()).value();
  REQUIRE(hits.primitive[0] == 0);
  CHECK(hits.t[0] > 3.8f);
  const HitPoint leaves = FindHitPoint(geometry, on.view(), hits.view(), 0).value();
  CHECK(leaves.side == 1);
  CHECK(leaves.face[1] > 0.9f);
  RayLists<float> out;
  out.Add(
      {{leaves.back[0], leaves.back[1], leaves.back[2]}, {0.01f, -1, 0.02f}, leaves.back_source});
  std::uint32_t occluded[1];
  TraceOccluded(geometry, out.view(), 1, occluded).value();
  CHECK(occluded[0] == 0);
}

TEST_CASE("what hit points cannot be found of is named") {
  Random random(3);
  const RandomObjects<float> objects(random, 4);
  const Geometry geometry = std::move(Geometry::Build(objects.Input())).value();
  RayLists<float> rays;
  for (int i = 0; i < 100; ++i) rays.Add({{0, 0, 9}, {0, 0, -1}});
  HitLists<float> hits(100);
  hits.primitive.assign(100, 1);
  PointLists<float> points(100);
  const auto error_of = [&](const RayArrays& from, const HitArrays& given) {
    const Status found = FindHitPoints(geometry, from, given, 100, points.view());
    return found.ok() ? "" : found.error().message;
  };
  CHECK(error_of(rays.view(), hits.view()) == "");
  RayArrays no_direction = rays.view();
  no_direction.direction_y = nullptr;
  CHECK(error_of(no_direction, hits.view()) == "direction_y is null");
  HitArrays no_v = hits.view(), no_t = hits.view(), no_primitive = hits.view();
  no_v.v = nullptr;
  no_t.t = nullptr;
  no_primitive.primitive = nullptr;
  CHECK(error_of(rays.view(), no_v) == "v is null");
  CHECK(error_of(rays.view(), no_t) == "t is null");
  CHECK(error_of(rays.view(), no_primitive) == "primitive is null");
  for (const std::uint32_t wrong : {16u, 1u << 30, ~0u, Geometry::kInsideBit | 1u}) {
    hits.primitive[77] = wrong;
    CHECK(error_of(rays.view(), hits.view()) ==
          "hit 77: no ray hits its primitive in this geometry");
  }
  CHECK(FindHitPoint(geometry, rays.view(), hits.view(), 77).ok() == false);
  CHECK(FindHitPoints(geometry, {}, {}, 0, {}).ok());

  GeometryInput short_normals, odd_normals;
  const std::vector<float> nine(9);
  short_normals.AddTriangles(objects.vertices, objects.indices, nine);
  CHECK(Geometry::Build(short_normals).error().message ==
        "object 0: 9 numbers of normals for 36 of vertices");
  std::vector<float> normals = objects.normals;
  normals[20] = std::nanf("");
  odd_normals.AddTriangles(objects.vertices, objects.indices, normals);
  CHECK(Geometry::Build(odd_normals).error().message ==
        "object 0, triangle 2: a normal is not finite");
}

TEST_CASE("many threads may ask for the first hit points of a geometry") {
  Random random(4);
  const RandomObjects<float> objects(random, 500);
  const Geometry geometry = std::move(Geometry::Build(objects.Input())).value();
  RayLists<float> rays;
  for (int i = 0; i < 300; ++i) rays.Add(RandomRay<float>(random, 0));
  HitLists<float> hits(rays.size());
  TraceClosest(geometry, rays.view(), rays.size(), hits.view()).value();
  std::vector<PointLists<float>> points(4, PointLists<float>(rays.size()));
  std::vector<std::thread> threads;
  for (PointLists<float>& mine : points) {
    threads.emplace_back([&] {
      FindHitPoints(geometry, rays.view(), hits.view(), rays.size(), mine.view()).value();
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (const PointLists<float>& other : points) {
    for (int k = 0; k < 15; ++k) CHECK(other.number[k] == points[0].number[k]);
    CHECK(other.front_source == points[0].front_source);
  }
}

}  // namespace
}  // namespace sheaf
