// Queries of places: what is inside, nearest points, what meets a box or a ball. Beside every
// primitive in turn, and beside answers that are found in another way.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "bits.h"
#include "random_rays.h"
#include "random_scene.h"
#include "sheaf/queries.h"
#include "src/bvh/geometry_access.h"
#include "src/scalar/nearest.h"
#include "src/scalar/overlap.h"
#include "targets.h"

namespace sheaf {
namespace {

using scalar::Wide3;

template <typename Real>
struct Places {
  std::vector<Real> x, y, z, radius;

  Places(Random& random, std::size_t count, double size) {
    for (std::size_t i = 0; i < count; ++i) {
      for (auto* axis : {&x, &y, &z})
        axis->push_back(static_cast<Real>(Uniform(random, -size, size)));
      radius.push_back(static_cast<Real>(Uniform(random, 0, 2)));
    }
  }
  PointArraysOf<Real> view() const { return {x.data(), y.data(), z.data()}; }
  Wide3 at(std::size_t i) const { return Vec3<Real>{x[i], y[i], z[i]}.template To<double>(); }
};

template <typename Real>
struct World {
  Random random;
  RandomObjects<Real> objects;
  FlatInputOf<Real> flat;
  GeometryOf<Real> geometry;
  GeometryView<Real> view;

  World(std::uint64_t seed, std::uint32_t primitives)
      : random(seed),
        objects(random, primitives),
        flat(GeometryAccess::FlattenTo<Real>(objects.Input(), {}).value()),
        geometry(GeometryOf<Real>::Build(objects.Input()).value()),
        view(flat.arrays.view()) {}
};

TEST_CASE_TEMPLATE("the nearest point is that of every primitive in turn", Real, float, double) {
  World<Real> world(21, 200);
  const std::size_t count = 1500;
  Places<Real> places(world.random, count, 6);
  places.x[3] = std::numeric_limits<Real>::quiet_NaN();
  places.y[4] = std::numeric_limits<Real>::infinity();
  const std::vector<std::uint32_t> object_mask = {1, 2, 4, 2};
  std::vector<std::uint32_t> ray_mask, excluded;
  std::vector<Real> max_distance;
  for (std::size_t i = 0; i < count; ++i) {
    ray_mask.push_back(static_cast<std::uint32_t>(world.random()) & 7u);
    excluded.push_back(static_cast<std::uint32_t>(world.random() % 800));
    max_distance.push_back(static_cast<Real>(Uniform(world.random, 0, 1)));
  }
  for (const bool is_ruled : {false, true}) {
    NearestOptionsOf<Real> options;
    if (is_ruled) {
      options.rules = {object_mask.data(), ray_mask.data(), 0, excluded.data(), 1};
      options.max_distance = max_distance.data();
    }
    std::vector<Real> distance(count), position[3];
    for (auto& axis : position) axis.resize(count);
    std::vector<std::uint32_t> primitive(count), object(count);
    const NearestArraysOf<Real> arrays = {
        distance.data(),
        primitive.data(),
        object.data(),
        {position[0].data(), position[1].data(), position[2].data()}};
    REQUIRE(FindNearest(world.geometry, places.view(), count, arrays, options));
    std::size_t wrong = 0, found = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const double most =
          is_ruled ? static_cast<double>(max_distance[i]) : std::numeric_limits<double>::infinity();
      const auto admits = [&](std::uint32_t id) {
        return !is_ruled || (id != excluded[i] &&
                             (object_mask[world.geometry.object_of(id)] & ray_mask[i]) != 0);
      };
      scalar::NearestPrimitive want =
          scalar::FindNearest(world.view, places.at(i), most * most, admits);
      if (i == 3 || i == 4) want = {most * most};
      wrong += primitive[i] != want.primitive;
      if (want.primitive == kNoPrimitive) {
        wrong += object[i] != kNoPrimitive || distance[i] != static_cast<Real>(most) ||
                 position[0][i] != 0;
        continue;
      }
      ++found;
      wrong += object[i] != world.geometry.object_of(want.primitive);
      wrong += !SameBits(distance[i], static_cast<Real>(std::sqrt(want.square)));
      for (int k = 0; k < 3; ++k) {
        wrong += !SameBits(position[k][i], static_cast<Real>((places.at(i) + want.offset)[k]));
      }
    }
    CHECK(wrong == 0);
    CHECK(found > 200);
  }
}

// ---- Overlap ----

// What is left of a polygon within a box: Sutherland and Hodgman.
std::vector<Wide3> Clip(std::vector<Wide3> polygon, const scalar::Box& box) {
  for (int side = 0; side < 6; ++side) {
    const int axis = side % 3;
    const auto depth = [&](Wide3 p) {
      return side < 3 ? p[axis] - box.lower[axis] : box.upper[axis] - p[axis];
    };
    std::vector<Wide3> kept;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Wide3 a = polygon[i], b = polygon[(i + 1) % polygon.size()];
      if (depth(a) >= 0) kept.push_back(a);
      if ((depth(a) >= 0) != (depth(b) >= 0)) {
        kept.push_back(a + (b - a) * (depth(a) / (depth(a) - depth(b))));
      }
    }
    polygon = kept;
  }
  return polygon;
}

// A polygon in a disk's plane, whose corners are `part` radii from the center.
std::vector<Wide3> Rim(const DiskArrays<double>& disks, std::uint32_t i, double part) {
  const scalar::Frame<double> frame(NormalizeWide(scalar::DiskNormal(disks, i)));
  std::vector<Wide3> corners;
  for (int k = 0; k < 720; ++k) {
    const double angle = k * 3.14159265358979 / 360;
    corners.push_back(scalar::DiskCenter(disks, i) +
                      (frame.x * std::cos(angle) + frame.y * std::sin(angle)) *
                          (disks.radius[i] * part));
  }
  return corners;
}

TEST_CASE("boxes meet what is left of primitives within them") {
  World<double> world(22, 120);
  Places<double> places(world.random, 300, 4);
  std::size_t met = 0, wrong = 0;
  for (std::size_t i = 0; i < 300; ++i) {
    const Wide3 reach = {places.radius[i], Uniform(world.random, 0, 2),
                         Uniform(world.random, 0, 2)};
    const scalar::Box box = {places.at(i), places.at(i) + reach};
    const auto& triangles = world.view.triangles;
    for (std::uint32_t k = 0; k < triangles.count; ++k) {
      const bool meets = scalar::MeetsBox(box, triangles, k);
      wrong += meets == Clip({scalar::TriangleVertex(triangles, k, 0),
                              scalar::TriangleVertex(triangles, k, 1),
                              scalar::TriangleVertex(triangles, k, 2)},
                             box)
                            .empty();
      met += meets;
    }
    const auto& disks = world.view.disks;
    for (std::uint32_t k = 0; k < disks.count; ++k) {
      const bool meets = scalar::MeetsBox(box, disks, k);
      wrong += !meets && !Clip(Rim(disks, k, 1), box).empty();
      wrong += meets && Clip(Rim(disks, k, 1.0001), box).empty();
      met += meets;
    }
    const auto& spheres = world.view.spheres;
    for (std::uint32_t k = 0; k < spheres.count; ++k) {
      const Wide3 center = {spheres.center_x[k], spheres.center_y[k], spheres.center_z[k]};
      const bool meets = scalar::MeetsBox(box, spheres, k);
      // Corners outside while the point of the box nearest to the center is inside.
      double furthest = 0;
      for (int corner = 0; corner < 8; ++corner) {
        const Wide3 p = {corner & 1 ? box.upper.x : box.lower.x,
                         corner & 2 ? box.upper.y : box.lower.y,
                         corner & 4 ? box.upper.z : box.lower.z};
        furthest = std::max(furthest, std::sqrt(Dot(p - center, p - center)));
      }
      const Wide3 nearest = box.Clamp(center) - center;
      wrong += meets != (std::sqrt(Dot(nearest, nearest)) <= spheres.radius[k] &&
                         furthest >= spheres.radius[k]);
      met += meets;
    }
  }
  CHECK(wrong == 0);
  CHECK(met > 1000);
}

template <typename Real, typename Find, typename Meets>
void CheckOverlaps(const World<Real>& world, std::size_t count, Find find, Meets meets) {
  constexpr std::uint32_t kRoom = 20;
  std::vector<std::uint32_t> primitive(kRoom * count), listed(count), total(count);
  REQUIRE(find(OverlapLists{kRoom, primitive.data(), listed.data(), total.data()}));
  std::size_t wrong = 0, most = 0, none = 0;
  for (std::size_t i = 0; i < count; ++i) {
    std::vector<std::uint32_t> want;
    ForEachKind(world.view, [&](const auto& arrays) {
      for (std::uint32_t k = 0; k < arrays.count; ++k) {
        if (meets(i, arrays, k)) want.push_back(arrays.id[k]);
      }
    });
    std::sort(want.begin(), want.end());
    most = std::max(most, want.size());
    none += want.empty();
    wrong += total[i] != want.size() || listed[i] != std::min<std::size_t>(kRoom, want.size());
    for (std::size_t k = 0; k < listed[i] && k < want.size(); ++k) {
      wrong += primitive[kRoom * i + k] != want[k];
    }
  }
  CHECK(wrong == 0);
  CHECK(most > kRoom);
  CHECK(none > 0);
}

TEST_CASE_TEMPLATE("overlaps are those of every primitive in turn", Real, float, double) {
  World<Real> world(23, 150);
  const std::size_t count = 600;
  Places<Real> places(world.random, count, 5), upper = places;
  for (std::size_t i = 0; i < count; ++i) {
    for (auto* axis : {&upper.x, &upper.y, &upper.z}) {
      (*axis)[i] += static_cast<Real>(Uniform(world.random, 0, 1));
    }
  }
  upper.x[7] = places.x[7] - 1;
  places.y[8] = std::numeric_limits<Real>::quiet_NaN();
  const BoxArraysOf<Real> boxes = {{places.x.data(), places.y.data(), places.z.data()},
                                   {upper.x.data(), upper.y.data(), upper.z.data()}};
  CheckOverlaps(
      world, count,
      [&](const OverlapLists& lists) { return FindInBoxes(world.geometry, boxes, count, lists); },
      [&](std::size_t i, const auto& arrays, std::uint32_t k) {
        const scalar::Box box = {places.at(i), upper.at(i)};
        return !box.is_empty() && scalar::MeetsBox(box, arrays, k);
      });
  CheckOverlaps(
      world, count,
      [&](const OverlapLists& lists) {
        return FindInBalls(world.geometry, places.view(), places.radius.data(), count, lists);
      },
      [&](std::size_t i, const auto& arrays, std::uint32_t k) {
        const auto radius = static_cast<double>(places.radius[i]);
        return scalar::NearestOf(places.at(i), arrays, k).square <= radius * radius;
      });
}

// ---- Inside ----

// Two cubes, the smaller within the larger, and a ball beside them. All triangles in one mesh.
struct Nested {
  std::vector<float> vertices;
  std::vector<std::uint32_t> indices;
  std::vector<float> ball = {4, 0, 0, 1};

  Nested() {
    Add(2);
    Add(1);
  }
  void Add(float half) {
    const auto first = static_cast<std::uint32_t>(vertices.size() / 3);
    for (int i = 0; i < 8; ++i) {
      for (const int bit : {1, 2, 4}) vertices.push_back(i & bit ? half : -half);
    }
    const std::uint32_t faces[6][4] = {{0, 2, 6, 4}, {1, 5, 7, 3}, {0, 4, 5, 1},
                                       {2, 3, 7, 6}, {0, 1, 3, 2}, {4, 6, 7, 5}};
    for (const auto& f : faces) {
      for (const int k : {0, 1, 2, 0, 2, 3}) indices.push_back(first + f[k]);
    }
  }
};

TEST_CASE_TEMPLATE("inside is between the surfaces", Real, float, double) {
  const Nested nested;
  GeometryInput input;
  input.AddTriangles(nested.vertices, nested.indices);
  input.AddSpheres(nested.ball);
  const auto geometry = GeometryOf<Real>::Build(input).value();
  // Whole and half numbers: rays along x meet edges, vertices and the diagonals of faces.
  std::vector<Real> x, y, z;
  std::vector<std::uint32_t> want, want_ball;
  for (int i = 0; i < 13 * 9 * 9; ++i) {
    const double at[3] = {i / 81 * 0.5 - 2.25, i / 9 % 9 * 0.5 - 2, i % 9 * 0.5 - 2};
    const double reach = std::max({std::abs(at[0]), std::abs(at[1]), std::abs(at[2])});
    if (std::abs(at[1]) == 2 || std::abs(at[2]) == 2) continue;  // on the surface
    if (reach <= 1 && (std::abs(at[1]) == 1 || std::abs(at[2]) == 1)) continue;
    x.push_back(static_cast<Real>(at[0]));
    y.push_back(static_cast<Real>(at[1]));
    z.push_back(static_cast<Real>(at[2]));
    const double from_ball = (at[0] - 4) * (at[0] - 4) + at[1] * at[1] + at[2] * at[2];
    want_ball.push_back(from_ball < 1);
    want.push_back(want_ball.back() ^ ((reach < 2 && reach > 1) ? 1u : 0u));
  }
  const PointArraysOf<Real> points = {x.data(), y.data(), z.data()};
  std::vector<std::uint32_t> inside(x.size()), in_ball(x.size());
  const std::vector<std::uint32_t> masks = {1, 2};
  ForEachTarget([&](Target target) {
    REQUIRE(FindInside(geometry, points, x.size(), inside.data(), {}, target));
    CHECK(inside == want);
    const HitRules ball = {.object_mask = masks.data(), .all_ray_mask = 2};
    REQUIRE(FindInside(geometry, points, x.size(), in_ball.data(), ball, target));
    CHECK(in_ball == want_ball);
  });
  CHECK(std::count(want_ball.begin(), want_ball.end(), 1u) > 0);

  // Signed distances are below 0 exactly there.
  std::vector<Real> distance(x.size());
  REQUIRE(FindNearest(geometry, points, x.size(), {.distance = distance.data()},
                      {.sign = DistanceSign::kInside}));
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < x.size(); ++i) wrong += (distance[i] < 0) != (want[i] == 1);
  CHECK(wrong == 0);
}

TEST_CASE("a vertex that a ray goes through counts once, one that it touches does not") {
  // An octahedron. All rays run through vertices or along edges.
  const std::vector<float> vertices = {1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1};
  std::vector<std::uint32_t> indices;
  for (const std::uint32_t x : {0u, 1u}) {
    for (const std::uint32_t y : {2u, 3u}) {
      for (const std::uint32_t z : {4u, 5u}) indices.insert(indices.end(), {x, y, z});
    }
  }
  GeometryInput input;
  input.AddTriangles(vertices, indices);
  const Geometry geometry = Geometry::Build(input).value();
  const auto count = [&](Vec3<float> o, Vec3<float> d) {
    std::uint32_t crossings = 9;
    REQUIRE(CountCrossings(geometry, {&o.x, &o.y, &o.z, &d.x, &d.y, &d.z}, 1, &crossings));
    return crossings;
  };
  CHECK(count({0, 0, 0}, {1, 0, 0}) == 1);
  CHECK(count({0, 0, 0}, {1, 1, 0}) == 1);
  CHECK(count({0, 0, 0}, {-1, 0, 1}) == 1);
  CHECK(count({-3, 0, 0}, {1, 0, 0}) == 2);
  CHECK(count({0, 0, 3}, {0, 0, -1}) == 2);
  CHECK(count({2, -1, 0}, {-1, 1, 0}) % 2 == 0);  // along an edge
  CHECK(count({0, -1, -3}, {0, 0, 1}) % 2 == 0);  // touches a vertex
  CHECK(count({-2, 1, 0}, {1, 0, 0}) % 2 == 0);
  CHECK(count({0, 0, 0}, {0.25f, 0.25f, 0.5f}) == 1);
}

TEST_CASE("what is missing is named") {
  const Geometry empty;
  const float zero = 0;
  const PointArrays point = {&zero, &zero, &zero};
  std::uint32_t one = 7;
  CHECK(FindInside(empty, {}, 1, &one).error().message == "x is null");
  CHECK(FindInside(empty, point, 1, nullptr).error().message == "inside is null");
  CHECK(FindNearest(empty, {&zero, &zero, nullptr}, 1, {}).error().message == "z is null");
  CHECK(FindInBoxes(empty, BoxArrays{}, 1, {}).error().message == "lower is null");
  CHECK(FindInBalls<float>(empty, point, nullptr, 1, {}).error().message == "radius is null");
  CHECK(CountCrossings(empty, RayArrays{}, 1, &one).error().message == "origin_x is null");
  REQUIRE(FindInside(empty, point, 1, &one));
  CHECK(one == 0);
  float distance = 0;
  REQUIRE(FindNearest(empty, point, 1, {.distance = &distance}));
  CHECK(std::isinf(distance));
}

}  // namespace
}  // namespace sheaf
