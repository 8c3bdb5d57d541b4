// The two properties that Vulkan's conformance tests ask of watertight ray tracing: no ray through
// a closed mesh misses, and a ray at an edge that two triangles share is told of one of them.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include "src/lab/probe.h"
#include "src/lab/ray_cases.h"
#include "src/lab/stress_cases.h"
#include "src/scalar/triangle.h"

namespace sheaf::stress {
namespace {

// A closed mesh without any order, of about as many triangles as asked for.
Shapes RoughBall(Random& random, std::uint32_t rings) {
  Shapes ball;
  const Vec center = random.InBox(10);
  AddSphereMesh(ball, {0, 0, 0}, 1, rings);
  for (std::uint32_t i = 0; i < ball.vertex_count(); ++i) {
    const float swell = random.In(0.8f, 1.2f);
    for (std::uint32_t axis = 0; axis < 3; ++axis) {
      float& coordinate = ball.vertices[3 * i + axis];
      coordinate = coordinate * swell + center[static_cast<int>(axis)];
    }
  }
  return ball;
}

Vec MiddleOf(const Shapes& shapes) {
  Vec sum = {0, 0, 0};
  for (std::uint32_t i = 0; i < shapes.vertex_count(); ++i) sum = sum + shapes.vertex(i);
  return sum * (1.0f / static_cast<float>(shapes.vertex_count()));
}

// The triangles at each edge, by its vertices, the lower one first.
using Edge = std::pair<std::uint32_t, std::uint32_t>;
std::map<Edge, std::vector<std::uint32_t>> TrianglesByEdge(const Shapes& shapes) {
  std::map<Edge, std::vector<std::uint32_t>> triangles;
  for (std::uint32_t i = 0; i < shapes.indices.size(); ++i) {
    const std::uint32_t next = i % 3 == 2 ? i - 2 : i + 1;
    const auto [low, high] = std::minmax(shapes.indices[i], shapes.indices[next]);
    triangles[{low, high}].push_back(i / 3);
  }
  return triangles;
}

}  // namespace

void NoMiss(Report& report) {
  const std::uint32_t seeds = report.is_thorough() ? 10 : 3;
  const int side = report.is_thorough() ? 256 : 48;
  for (std::uint32_t seed = 0; seed < seeds; ++seed) {
    for (const std::uint32_t rings : {2u, 4u, 16u, 64u, report.is_thorough() ? 128u : 32u}) {
      Random random(seed);
      const Shapes ball = RoughBall(random, rings);
      const Vec from = MiddleOf(ball);
      std::vector<Ray> rays;
      for (int i = 0; i < side * side; ++i) rays.push_back({from, random.Direction()});
      for (const Ray& ray : AimAtEdges(ball, from)) {
        if (rays.size() < 2u * side * side) rays.push_back(ray);
      }
      for (const Hit& hit : TraceEverywhere(report, ball, rays, Oracle::kTreeOnly)) {
        report.Expect(IsHit(hit), fmt::format("seed {}: a miss in {} rings", seed, rings));
      }
    }
  }
}

void SingleHit(Report& report) {
  std::uint64_t at_both = 0;
  for (std::uint32_t seed = 0; seed < (report.is_thorough() ? 10u : 3u); ++seed) {
    for (const std::uint32_t rings : {2u, 5u, 16u, report.is_thorough() ? 128u : 24u}) {
      Random random(seed);
      const Shapes ball = RoughBall(random, rings);
      const Vec from = MiddleOf(ball);
      const FlatShapes flat(ball);
      const TriangleArrays<float> triangles = flat.view().triangles;
      std::vector<Ray> rays;
      std::vector<std::vector<std::uint32_t>> beside;
      for (const auto& [edge, neighbours] : TrianglesByEdge(ball)) {
        const Vec a = ball.vertex(edge.first), b = ball.vertex(edge.second);
        rays.push_back(Towards(from, a + (b - a) * random.In(0.2f, 0.8f)));
        beside.push_back(neighbours);
      }
      const std::vector<Hit> hits = TraceEverywhere(report, ball, rays, Oracle::kTreeOnly);
      for (std::size_t i = 0; i < rays.size(); ++i) {
        const auto shear = scalar::ShearOf(rays[i].direction);
        Hit first{kInfinity};
        int met = 0;
        for (const std::uint32_t id : beside[i]) {
          const auto hit = scalar::HitTriangle(rays[i], shear, triangles, id);
          met += hit.has_value();
          if (!hit || hit->t > first.t || (hit->t == first.t && id > first.primitive)) continue;
          first = {hit->t, id};
        }
        at_both += met == 2;
        report.Expect(IsHit(first), "neither triangle at an edge is hit", &rays[i]);
        report.Expect(hits[i].primitive == first.primitive,
                      fmt::format("{} is reported where {} is the first at an edge",
                                  hits[i].primitive, first.primitive),
                      &rays[i]);
      }
    }
  }
  report.Expect(at_both > 0, "no ray meets both triangles at an edge");
  if (!report.is_thorough()) return;
  report.Note(fmt::format("{} rays meet both triangles at an edge", at_both));
}

}  // namespace sheaf::stress
