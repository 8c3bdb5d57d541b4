// Meshes do not leak: rays at edges and vertices hit, by the specification and by every kernel.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include "random_scene.h"
#include "simd/query.h"
#include "simd/tree.h"
#include "src/bvh/build_tree.h"
#include "src/scalar/trace.h"
#include "targets.h"
#include "triangle_mesh.h"

namespace sheaf {
namespace {

using scalar::Ray;

constexpr float kInfinity = std::numeric_limits<float>::infinity();

Vec3<float> FromBits(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  return {std::bit_cast<float>(x), std::bit_cast<float>(y), std::bit_cast<float>(z)};
}

// Which of the rays miss, or hit farther away than `t_max`: a leak shows the far side of a mesh.
int CountLeaks(const GeometryView<float>& geometry, const std::vector<Ray<float>>& rays,
               float t_max) {
  int leaks = 0;
  for (const Ray<float>& ray : rays) {
    const scalar::Hit<float> hit = scalar::TraceClosest(geometry, ray);
    leaks += hit.primitive == kNoPrimitive || !(hit.t <= t_max);
  }
  return leaks;
}

int CountKernelLeaks(Target target, const TreeView<float>& tree,
                     const std::vector<Ray<float>>& rays, float t_max) {
  const auto count = static_cast<std::uint32_t>(rays.size());
  RayStream<float> stream;
  HitStream<float> hits;
  stream.Allocate(count), hits.Allocate(count);
  const auto out = stream.output();
  for (std::uint32_t i = 0; i < count; ++i) {
    out.origin_x[i] = rays[i].origin.x, out.origin_y[i] = rays[i].origin.y;
    out.origin_z[i] = rays[i].origin.z, out.source[i] = kNoPrimitive;
    out.direction_x[i] = rays[i].direction.x, out.direction_y[i] = rays[i].direction.y;
    out.direction_z[i] = rays[i].direction.z;
  }
  StrictKernels<float>(target.id())
      .trace_closest(tree, stream.view(), RayIntervals<float>{}, count, Coherence::kUnknown,
                     hits.output());
  int leaks = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    leaks += hits.view().primitive[i] == kNoPrimitive || !(hits.view().t[i] <= t_max);
  }
  return leaks;
}

void CheckNoLeaks(const TriangleMesh& mesh, const std::vector<Ray<float>>& rays,
                  float t_max = kInfinity) {
  const CompiledScene<float> scene = mesh.Compile();
  REQUIRE_FALSE(rays.empty());
  const Result<Tree<float>> tree = BuildTree<float>(scene.geometry());
  REQUIRE(tree);
  CHECK(CountLeaks(scene.geometry(), rays, t_max) == 0);
  ForEachTarget([&](Target target) {
    CHECK(CountKernelLeaks(target, tree.value().view(), rays, t_max) == 0);
  });
}

// A grid of n x n unit cells, two triangles each, in the plane across `axis`.
TriangleMesh GridMesh(int n, int axis, Vec3<float> at) {
  TriangleMesh mesh;
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; j <= n; ++j) {
      const auto a = static_cast<float>(i), b = static_cast<float>(j);
      const Vec3<float> v = axis == 0   ? Vec3<float>{0, a, b}
                            : axis == 1 ? Vec3<float>{b, 0, a}
                                        : Vec3<float>{a, b, 0};
      mesh.vertices.push_back(at + v);
    }
  }
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const auto v = static_cast<std::uint32_t>(i * (n + 1) + j),
                 row = static_cast<std::uint32_t>(n + 1);
      mesh.triangles.push_back({v, v + row, v + row + 1});
      mesh.triangles.push_back({v, v + row + 1, v + 1});
    }
  }
  return mesh;
}

TEST_CASE("axis-parallel rays at edges and vertices of an integer grid") {
  for (int axis = 0; axis < 3; ++axis) {
    for (const float away : {0.0f, -5.0f, 65536.0f}) {
      const TriangleMesh mesh = GridMesh(12, axis, {away, away, away});
      std::vector<Ray<float>> rays;
      for (int i = 0; i <= 48; ++i) {
        for (int j = 0; j <= 48; ++j) {
          // Quarters meet every vertex, edge and diagonal.
          const float a = away + static_cast<float>(i) / 4, b = away + static_cast<float>(j) / 4;
          for (const float side : {-10.0f, 10.0f}) {
            const float from = away + side, d = -side;
            if (axis == 0) rays.push_back({{from, a, b}, {d, 0, 0}});
            if (axis == 1) rays.push_back({{b, from, a}, {0, d, 0}});
            if (axis == 2) rays.push_back({{a, b, from}, {0, 0, d}});
          }
        }
      }
      CheckNoLeaks(mesh, rays, 1.0f);
    }
  }
}

TEST_CASE("oblique rays at edges and vertices of an integer grid") {
  Random random(30);
  const TriangleMesh mesh = GridMesh(8, 2, {-4, -4, 0});
  std::vector<Ray<float>> rays;
  for (int i = 0; i < 4000; ++i) {
    const auto integer = [&](int low, int high) {
      return static_cast<float>(low + static_cast<int>(random() % (high - low + 1)));
    };
    // Integer origins and targets: the rays meet vertices, diagonals and edges exactly.
    const Vec3<float> origin{integer(-20, 20), integer(-20, 20), integer(1, 20)};
    const Vec3<float> target{integer(-7, 7) / 2, integer(-7, 7) / 2, 0};  // not the border
    rays.push_back({origin, target - origin});
  }
  CheckNoLeaks(mesh, rays, 1.0001f);
}

TEST_CASE("a ray at the diagonal of a quad") {
  const TriangleMesh quad{{{-5, -5, 0}, {5, -5, 0}, {5, 5, 0}, {-5, 5, 0}}, {{0, 1, 2}, {0, 2, 3}}};
  const Ray<float> ray{{0, 0, 10}, {.30458447f, .30458447f, -.9024725f}};
  CheckNoLeaks(quad, {ray});
  const CompiledScene<float> scene = quad.Compile();
  const scalar::Hit<float> hit = scalar::TraceClosest(scene.geometry(), ray);
  const Vec3<float> point = ray.origin + ray.direction * hit.t;
  CHECK(point.x == doctest::Approx(3.375).epsilon(1e-4));
  CHECK(point.y == doctest::Approx(3.375).epsilon(1e-4));
  CHECK(std::abs(point.z) < 1e-5f);
}

TEST_CASE("a ray exactly at a slanted edge") {
  const Ray<float> ray{FromBits(0x3f708000, 0x3d780000, 0), {0, 0, -1}};
  const TriangleMesh both{{{1, 0, -1}, {0, 1, -1}, {0, 0, -1}, {1, 1, -1}}, {{0, 1, 2}, {1, 0, 3}}};
  CheckNoLeaks(both, {ray}, 1.0f);
  for (const auto& triangle : both.triangles) {  // zero counts as inside on both sides
    CheckNoLeaks({both.vertices, {triangle}}, {ray}, 1.0f);
  }
}

// A strip across the unit square whose middle band is `width` high: slivers in it, and along its
// edges.
TEST_CASE("slivers do not leak") {
  Random random(34);
  for (double width = 1e-4; width >= 0.9e-8; width /= 10) {
    for (const bool at_origin : {true, false}) {
      // Around 0 the floats are fine enough for every width.
      const double middle = at_origin ? 0.0 : 0.3;
      const double rows[] = {middle - 0.5, middle, middle + width, middle + 0.5};
      constexpr int kColumns = 6;
      TriangleMesh mesh;
      for (const double y : rows) {
        for (int i = 0; i <= kColumns; ++i) {
          const double x = i / double{kColumns};
          mesh.vertices.push_back(Vec3<double>{x, y, 0.2 * x + 0.1 * y}.To<float>());
        }
      }
      for (std::uint32_t row = 0; row < 3; ++row) {
        for (std::uint32_t i = 0; i < kColumns; ++i) {
          const std::uint32_t v = row * (kColumns + 1) + i, above = v + kColumns + 1;
          mesh.triangles.push_back({v, v + 1, above + 1});
          mesh.triangles.push_back({v, above + 1, above});
        }
      }
      std::vector<Ray<float>> rays;
      for (int i = 0; i < 4000; ++i) {
        const auto& triangle = mesh.triangles[random() % mesh.triangles.size()];
        const Vec3<double> a = mesh.vertices[triangle[random() % 3]].To<double>();
        const Vec3<double> b = mesh.vertices[triangle[random() % 3]].To<double>();
        Vec3<double> target = a + (b - a) * Uniform(random, 0, 1);
        if (i % 2) target.y = middle + Uniform(random, -2, 3) * width;
        // Keeps off the border of the sheet, where a miss is right.
        target.x = std::clamp(target.x, 0.01, 0.99);
        target.y = std::clamp(target.y, middle - 0.49, middle + 0.49);
        target.z = 0.2 * target.x + 0.1 * target.y;
        const Vec3<float> origin{static_cast<float>(Uniform(random, -1, 2)),
                                 static_cast<float>(Uniform(random, -1, 2)),
                                 i % 4 < 2 ? 1.5f : -1.5f};
        rays.push_back({origin, target.To<float>() - origin});
      }
      CheckNoLeaks(mesh, rays, 1.01f);
    }
  }
}

// An icosphere of 20 * 4^levels triangles. Its coordinates are multiples of 2^-20, so that their
// differences with such numbers below 8 are floats and rays can aim at vertices exactly.
TriangleMesh Icosphere(int levels, double radius) {
  const auto on_grid = [](double x) {
    return static_cast<float>(std::round(x * 0x1p20) * 0x1p-20);
  };
  std::vector<Vec3<double>> unit;
  const double phi = std::numbers::phi;
  for (const double a : {-1.0, 1.0}) {
    for (const double b : {-phi, phi}) {
      unit.push_back(Normalize(Vec3<double>{0, a, b}));
      unit.push_back(Normalize(Vec3<double>{a, b, 0}));
      unit.push_back(Normalize(Vec3<double>{b, 0, a}));
    }
  }
  TriangleMesh mesh;
  // The faces of the icosahedron are the triples at the shortest distance, turned outward.
  const auto is_edge = [&](std::size_t i, std::size_t j) { return Dot(unit[i], unit[j]) > 0.4; };
  for (std::uint32_t i = 0; i < 12; ++i) {
    for (std::uint32_t j = i + 1; j < 12; ++j) {
      for (std::uint32_t k = j + 1; k < 12; ++k) {
        if (!is_edge(i, j) || !is_edge(j, k) || !is_edge(i, k)) continue;
        const bool outward = Dot(Cross(unit[j] - unit[i], unit[k] - unit[i]), unit[i]) > 0;
        mesh.triangles.push_back(outward ? std::array{i, j, k} : std::array{i, k, j});
      }
    }
  }
  REQUIRE(mesh.triangles.size() == 20);
  for (int level = 0; level < levels; ++level) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t i, std::uint32_t j) {
      const auto [found, is_new] =
          middles.try_emplace(std::minmax(i, j), static_cast<std::uint32_t>(unit.size()));
      if (is_new) unit.push_back(Normalize(unit[i] + unit[j]));
      return found->second;
    };
    std::vector<std::array<std::uint32_t, 3>> finer;
    for (const auto& [a, b, c] : mesh.triangles) {
      const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    mesh.triangles = std::move(finer);
  }
  for (const Vec3<double>& v : unit) {
    mesh.vertices.push_back({on_grid(v.x * radius), on_grid(v.y * radius), on_grid(v.z * radius)});
  }
  return mesh;
}

// Rays at vertices, at the middles of edges and at random points of edges, from inside and outside.
// Outside, what the ray aims at must face it more steeply than neighbouring triangles are bent.
std::vector<Ray<float>> RaysAtEdges(Random& random, const TriangleMesh& mesh, std::uint32_t count) {
  std::vector<Ray<float>> rays;
  while (rays.size() < count) {
    const auto grid = [&](double extent) {
      return static_cast<float>(std::round(Uniform(random, -extent, extent) * 0x1p20) * 0x1p-20);
    };
    const bool is_inside = rays.size() % 2 == 0;
    const double extent = is_inside ? 0.5 : 3;
    Vec3<float> origin{grid(extent), grid(extent), grid(extent)};
    if (rays.size() % 16 == 0) origin = {0, 0, 0};
    if (!is_inside && Dot(origin, origin) < 2) continue;
    const auto& triangle = mesh.triangles[random() % mesh.triangles.size()];
    const Vec3<float> a = mesh.vertices[triangle[0]], b = mesh.vertices[triangle[1]];
    const std::uint64_t kind = random() % 3;
    const float along = kind == 0   ? 0
                        : kind == 1 ? 0.5f
                                    : static_cast<float>(Uniform(random, 0, 1));
    const Vec3<float> target = a + (b - a) * along, direction = target - origin;
    const float facing = Dot(Normalize(direction), Normalize(target));
    if (!is_inside && facing > -0.4f) continue;
    rays.push_back({origin, direction});
  }
  return rays;
}

// t_max keeps the far side out of reach.
TEST_CASE("a closed sphere mesh does not leak at vertices and edges, from inside and outside") {
  Random random(35);
  for (const auto& [levels, count] : {std::pair{4, 4000u}, {2, 40000u}}) {
    const TriangleMesh mesh = Icosphere(levels, 1);
    CheckNoLeaks(mesh, RaysAtEdges(random, mesh, count), 1.001f);
  }
}

// Where floats are a 64th apart the mesh is rough, but still closed.
TEST_CASE("a sphere mesh far from the origin does not leak") {
  Random random(36);
  const Vec3<float> far{148376, 1234, -223423};
  TriangleMesh mesh = Icosphere(2, 1);
  for (auto& v : mesh.vertices) v = v * 2.0f + far;
  std::vector<Ray<float>> rays;
  for (int i = 0; i < 20000; ++i) {
    const auto& triangle = mesh.triangles[random() % mesh.triangles.size()];
    const Vec3<float> a = mesh.vertices[triangle[0]], b = mesh.vertices[triangle[1]];
    const float along = i % 2 ? 0 : static_cast<float>(Uniform(random, 0, 1));
    const Vec3<float> origin = far + ToVec3(UniformPoint(random, -0.5, 0.5)).To<float>();
    rays.push_back({origin, a + (b - a) * along - origin});
  }
  CheckNoLeaks(mesh, rays);
}

TEST_CASE("perturbed spheres are hit at every vertex") {
  constexpr std::uint32_t kSide = 16;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    Random random(seed);
    const double radius = Uniform(random, 1, 6);
    TriangleMesh mesh;
    // Rings from pole to pole; the poles are one vertex each.
    mesh.vertices.push_back({0, 0, static_cast<float>(radius)});
    for (std::uint32_t ring = 1; ring < kSide; ++ring) {
      for (std::uint32_t i = 0; i < kSide; ++i) {
        const double theta = std::numbers::pi * ring / kSide,
                     phi = 2 * std::numbers::pi * i / kSide;
        const double r = radius * Uniform(random, 0.95, 1.05);
        mesh.vertices.push_back(Vec3<double>{r * std::sin(theta) * std::cos(phi),
                                             r * std::sin(theta) * std::sin(phi),
                                             r * std::cos(theta)}
                                    .To<float>());
      }
    }
    mesh.vertices.push_back({0, 0, static_cast<float>(-radius)});
    const auto at = [&](std::uint32_t ring, std::uint32_t i) -> std::uint32_t {
      if (ring == 0) return 0;
      if (ring == kSide) return static_cast<std::uint32_t>(mesh.vertices.size() - 1);
      return 1 + (ring - 1) * kSide + i % kSide;
    };
    for (std::uint32_t ring = 0; ring < kSide; ++ring) {
      for (std::uint32_t i = 0; i < kSide; ++i) {
        if (ring > 0) mesh.triangles.push_back({at(ring, i), at(ring + 1, i), at(ring, i + 1)});
        if (ring + 1 < kSide)
          mesh.triangles.push_back({at(ring, i + 1), at(ring + 1, i), at(ring + 1, i + 1)});
      }
    }
    std::vector<Ray<float>> rays;
    for (const Vec3<float> v : mesh.vertices) {
      const Vec3<float> origin = ToVec3(UniformPoint(random, -0.3, 0.3)).To<float>();
      rays.push_back({origin, v - origin});
      // From outside along the radius, toward the near side.
      rays.push_back({v * 2.0f, -v});
    }
    CheckNoLeaks(mesh, rays);
  }
}

}  // namespace
}  // namespace sheaf
