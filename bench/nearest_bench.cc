// Nearest points beside a search of every primitive by other formulas, in long double. Exits 1
// where a distance differs by more than 2 units in the last place.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "bench/make_scenes.h"
#include "sheaf/queries.h"
#include "src/core/parallel.h"
#include "src/core/vec3.h"

namespace sheaf::bench {
namespace {

using Long = long double;
using Vec = Vec3<Long>;
constexpr std::uint32_t kBatch = 1 << 12;
constexpr std::uint32_t kBalls = 100, kDisks = 100;

struct Shapes {
  BenchScene mesh = GeodesicSphere(3);
  std::vector<float> disks;

  Shapes() {
    std::uint64_t key = 0;
    const auto unit = [&] { return static_cast<float>(HashUnit(key++)); };
    for (float& x : mesh.vertices) x *= 0.5f + unit();
    for (std::uint32_t i = 0; i < kBalls; ++i) {
      for (int k = 0; k < 3; ++k) mesh.spheres.push_back(4 * unit() - 2);
      mesh.spheres.push_back(0.4f * unit());
    }
    for (std::uint32_t i = 0; i < kDisks; ++i) {
      for (int k = 0; k < 3; ++k) disks.push_back(4 * unit() - 2);
      disks.push_back(0.4f * unit());
      for (int k = 0; k < 3; ++k) disks.push_back(unit() - 0.5f);
    }
  }
  Vec Vertex(std::uint32_t triangle, std::uint32_t corner) const {
    return From(&mesh.vertices[std::size_t{3} * mesh.indices[3 * triangle + corner]]);
  }
  static Vec From(const float* p) { return {p[0], p[1], p[2]}; }
};

// Ericson, "Real-Time Collision Detection" (2005), 5.1.5: by the regions of the corners, the edges
// and the face.
Vec NearestOfTriangle(Vec p, Vec a, Vec b, Vec c) {
  const Vec ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const Long d1 = Dot(ab, ap), d2 = Dot(ac, ap), d3 = Dot(ab, bp), d4 = Dot(ac, bp),
             d5 = Dot(ab, cp), d6 = Dot(ac, cp);
  if (d1 <= 0 && d2 <= 0) return a;
  if (d3 >= 0 && d4 <= d3) return b;
  const Long vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + ab * (d1 / (d1 - d3));
  if (d6 >= 0 && d5 <= d6) return c;
  const Long vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + ac * (d2 / (d2 - d6));
  const Long va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 >= d3 && d5 >= d6) {
    return b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)));
  }
  const Long sum = va + vb + vc;
  return a + ab * (vb / sum) + ac * (vc / sum);
}

Long DistanceByHand(const Shapes& shapes, Vec p) {
  Long best = HUGE_VALL;
  for (std::uint32_t i = 0; i < shapes.mesh.triangle_count(); ++i) {
    const Vec way =
        NearestOfTriangle(p, shapes.Vertex(i, 0), shapes.Vertex(i, 1), shapes.Vertex(i, 2)) - p;
    best = std::min(best, std::sqrt(Dot(way, way)));
  }
  for (std::uint32_t i = 0; i < kBalls; ++i) {
    const float* const ball = &shapes.mesh.spheres[4 * i];
    const Vec way = Shapes::From(ball) - p;
    best = std::min(best, std::abs(std::sqrt(Dot(way, way)) - static_cast<Long>(ball[3])));
  }
  for (std::uint32_t i = 0; i < kDisks; ++i) {
    const float* const disk = &shapes.disks[7 * i];
    const Vec way = Shapes::From(disk) - p, normal = Shapes::From(disk + 4);
    const Vec across = Cross(way, normal);
    const Long length = std::sqrt(Dot(normal, normal));
    const Long beside = std::sqrt(Dot(across, across)) / length - static_cast<Long>(disk[3]);
    best = std::min(best, std::hypot(Dot(way, normal) / length, std::max(beside, Long(0))));
  }
  return best;
}

// A place anywhere, or near a triangle, or far away.
Vec3<float> DrawPlace(const Shapes& shapes, std::uint64_t key) {
  const auto unit = [&] { return HashUnit(key++); };
  const auto draw = [&](double size) {
    return Vec3<double>{(unit() - 0.5) * size, (unit() - 0.5) * size, (unit() - 0.5) * size};
  };
  const double kind = unit();
  if (kind < 0.4) return draw(4).To<float>();
  if (kind < 0.5) return draw(4000).To<float>();
  const auto triangle = static_cast<std::uint32_t>(unit() * shapes.mesh.triangle_count());
  const double u = unit() * 1.2 - 0.1, v = unit() * 1.2 - 0.1;
  const auto corner = [&](std::uint32_t k) { return shapes.Vertex(triangle, k).To<double>(); };
  const Vec3<double> on = corner(0) * (1 - u - v) + corner(1) * u + corner(2) * v;
  return (on + draw(std::pow(10, -7 * unit()))).To<float>();
}

// Units in the last place between two distances.
std::int64_t Steps(float a, float b) {
  return std::abs(std::int64_t{std::bit_cast<std::int32_t>(a)} - std::bit_cast<std::int32_t>(b));
}

int Main(int argc, char** argv) {
  CLI::App app("Nearest points beside a search by hand", "nearest_bench");
  double point_count = 1e5;  // a double, so that 1e7 may be written
  int threads = 0;
  app.add_option("--points", point_count, "points (1e5)")->check(CLI::Range(1.0, 1e13));
  app.add_option("--threads", threads, "0: one a core (0)")->check(CLI::Range(0, 1024));
  CLI11_PARSE(app, argc, argv);
  const Shapes shapes;
  GeometryInput input;
  input.AddTriangles(shapes.mesh.vertices, shapes.mesh.indices);
  input.AddSpheres(shapes.mesh.spheres);
  input.AddDisks(shapes.disks);
  const Geometry geometry = Geometry::Build(input).value();
  const auto batches = static_cast<std::uint64_t>(std::ceil(point_count / kBatch));
  std::atomic<std::uint64_t> wrong = 0, not_equal = 0;
  std::atomic<std::int64_t> worst = 0;
  ParallelFor(ThreadCount(threads), batches, [&](int, std::uint64_t number) {
    std::vector<Vec3<float>> places;
    for (std::uint64_t i = 0; i < kBatch; ++i) {
      places.push_back(DrawPlace(shapes, (number * kBatch + i) << 5));
    }
    std::vector<float> distance(kBatch);
    FindNearest(geometry, {&places[0].x, &places[0].y, &places[0].z, sizeof(places[0])}, kBatch,
                {.distance = distance.data()})
        .value();
    for (std::uint32_t i = 0; i < kBatch; ++i) {
      const auto want = static_cast<float>(DistanceByHand(shapes, places[i].To<Long>()));
      const std::int64_t steps = Steps(distance[i], want);
      wrong += steps > 2;
      not_equal += steps > 0;
      for (std::int64_t seen = worst; steps > seen && !worst.compare_exchange_weak(seen, steps);) {
      }
    }
  });
  fmt::print("{} points: {} distances differ, {} by more than 2 ULP, {} ULP at most\n",
             batches * kBatch, not_equal.load(), wrong.load(), worst.load());
  return wrong == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}

}  // namespace
}  // namespace sheaf::bench

int main(int argc, char** argv) { return sheaf::bench::Main(argc, argv); }
