// Rays aimed at the vertices and edges of closed meshes, from inside and from outside: each has to
// cross the surface an odd number of times from inside, and an even number from outside. Exits 1
// where one does not.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "bench/make_scenes.h"
#include "sheaf/queries.h"
#include "sheaf/target.h"
#include "src/core/parallel.h"
#include "src/core/vec3.h"

namespace sheaf::bench {
namespace {

using Vec = Vec3<double>;
constexpr std::uint32_t kBatch = 1 << 12;

// Numbers in [0, 1) that follow from a key.
class Draw {
 public:
  explicit Draw(std::uint64_t key) : key_(key) {}
  double operator()() { return HashUnit(key_++); }
  std::uint32_t Below(std::uint32_t n) { return static_cast<std::uint32_t>((*this)() * n); }
  Vec Direction() { return Normalize(Vec{(*this)() - 0.5, (*this)() - 0.5, (*this)() - 0.5}); }

 private:
  std::uint64_t key_;
};

// A place whose side is known without a ray.
struct Place {
  Vec at;
  bool is_inside;
};

struct ClosedMesh {
  std::string name;
  std::vector<float> vertices;
  std::vector<std::uint32_t> indices;
  std::function<Place(Draw&)> draw_place;
};

// Around the origin, whose surface lies between these radii.
std::function<Place(Draw&)> AroundOrigin(double inner, double outer) {
  return [=](Draw& draw) {
    const bool is_inside = draw() < 0.5;
    const double radius = is_inside ? inner * draw() : outer * (1 + 2 * draw());
    return Place{draw.Direction() * radius, is_inside};
  };
}

ClosedMesh Ball() {
  const BenchScene scene = GeodesicSphere(24);
  return {"ball", scene.vertices, scene.indices, AroundOrigin(0.9, 1.1)};
}

// A ball with each vertex drawn in by up to two thirds.
ClosedMesh Crumpled() {
  BenchScene scene = GeodesicSphere(24);
  for (std::size_t i = 0; i < scene.vertices.size(); i += 3) {
    const auto radius = static_cast<float>(1.0 / 3 + HashUnit(i) * 2 / 3);
    for (std::size_t k = 0; k < 3; ++k) scene.vertices[i + k] *= radius;
  }
  return {"crumpled", scene.vertices, scene.indices, AroundOrigin(0.25, 1.1)};
}

// Two cones, base to base, of triangles a hundred times as long as wide.
ClosedMesh Needles() {
  constexpr std::uint32_t kSides = 600;
  ClosedMesh mesh{"needles", {0, 0, 1, 0, 0, -1}, {}, AroundOrigin(0.5, 1.1)};
  for (std::uint32_t i = 0; i < kSides; ++i) {
    const double angle = 2 * 3.14159265358979 * i / kSides;
    mesh.vertices.insert(mesh.vertices.end(), {static_cast<float>(std::cos(angle)),
                                               static_cast<float>(std::sin(angle)), 0.0f});
    const std::uint32_t a = 2 + i, b = 2 + (i + 1) % kSides;
    mesh.indices.insert(mesh.indices.end(), {0, a, b, 1, b, a});
  }
  return mesh;
}

// The surface of random cubes of a grid: folded every way, with edges and vertices that several
// parts touch at. All coordinates are whole numbers, so that rays meet edges exactly, run along
// them and in the planes of faces.
ClosedMesh Cubes() {
  constexpr int kSize = 12, kCorners = kSize + 1;
  const auto is_solid = [](int x, int y, int z) {
    const auto outside = [](int c) { return c < 0 || c >= kSize; };
    if (outside(x) || outside(y) || outside(z)) return false;
    return HashUnit(static_cast<std::uint64_t>((x * kSize + y) * kSize + z)) < 0.4;
  };
  ClosedMesh mesh{"cubes", {}, {}, {}};
  for (int i = 0; i < kCorners * kCorners * kCorners; ++i) {
    for (const int c : {i / kCorners / kCorners, i / kCorners % kCorners, i % kCorners}) {
      mesh.vertices.push_back(static_cast<float>(c));
    }
  }
  for (int i = 0; i < kSize * kSize * kSize; ++i) {
    const int cell[3] = {i / kSize / kSize, i / kSize % kSize, i % kSize};
    if (!is_solid(cell[0], cell[1], cell[2])) continue;
    for (int face = 0; face < 6; ++face) {
      const int axis = face % 3, step = face < 3 ? -1 : 1;
      int next[3] = {cell[0], cell[1], cell[2]};
      next[axis] += step;
      if (is_solid(next[0], next[1], next[2])) continue;
      std::uint32_t corner[4];
      for (int k = 0; k < 4; ++k) {
        int at[3] = {cell[0], cell[1], cell[2]};
        at[axis] += step > 0;
        at[(axis + 1) % 3] += k == 1 || k == 2;
        at[(axis + 2) % 3] += k >= 2;
        corner[k] = static_cast<std::uint32_t>((at[0] * kCorners + at[1]) * kCorners + at[2]);
      }
      mesh.indices.insert(mesh.indices.end(),
                          {corner[0], corner[1], corner[2], corner[0], corner[2], corner[3]});
    }
  }
  mesh.draw_place = [is_solid](Draw& draw) {
    // The middle of a cell, in or around the grid, or a place about it.
    int cell[3];
    for (int& c : cell) c = static_cast<int>(draw.Below(kSize + 4)) - 2;
    const double spread = draw() < 0.5 ? 0 : 0.5;
    const auto at = [&](int c) { return c + 0.5 + (draw() - 0.5) * spread; };
    const Vec place{at(cell[0]), at(cell[1]), at(cell[2])};
    return Place{place, is_solid(cell[0], cell[1], cell[2])};
  };
  return mesh;
}

// Where a ray is aimed at: a vertex, the middle of an edge, or a point of one.
Vec AimAt(const ClosedMesh& mesh, Draw& draw) {
  const auto triangle = draw.Below(static_cast<std::uint32_t>(mesh.indices.size() / 3));
  const auto corner = draw.Below(3);
  const auto vertex = [&](std::uint32_t k) {
    const float* p = &mesh.vertices[std::size_t{3} * mesh.indices[3 * triangle + k % 3]];
    return Vec{p[0], p[1], p[2]};
  };
  const Vec from = vertex(corner), to = vertex(corner + 1);
  const double way = draw();
  return from + (to - from) * (way < 0.4 ? 0 : way < 0.6 ? 0.5 : draw());
}

template <typename Real>
struct Counts {
  std::atomic<std::uint64_t> crossings = 0, hits = 0, inside = 0;  // that are wrong
};

template <typename Real>
void CountBatch(const ClosedMesh& mesh, const GeometryOf<Real>& geometry, Target target,
                std::uint64_t number, Counts<Real>& wrong) {
  Draw draw(number << 40);
  std::vector<Real> numbers[6];
  std::vector<bool> is_inside;
  for (std::uint32_t i = 0; i < kBatch; ++i) {
    Place place = mesh.draw_place(draw);
    const Vec origin = place.at.To<Real>().template To<double>();
    Vec way = AimAt(mesh, draw) - origin;
    // Now and then along an axis.
    if (draw() < 0.1) way = {0, draw() < 0.5 ? 1.0 : -1.0, 0};
    const double all[6] = {origin.x, origin.y, origin.z, way.x, way.y, way.z};
    for (int k = 0; k < 6; ++k) numbers[k].push_back(static_cast<Real>(all[k]));
    is_inside.push_back(place.is_inside);
  }
  const RayArraysOf<Real> rays = {numbers[0].data(), numbers[1].data(), numbers[2].data(),
                                  numbers[3].data(), numbers[4].data(), numbers[5].data()};
  std::vector<std::uint32_t> crossings(kBatch), hits(kBatch), inside(kBatch);
  const RuledTraceOptionsOf<Real> options = {.target = target};
  CountCrossings(geometry, rays, kBatch, crossings.data(), options).value();
  TraceAll(geometry, rays, kBatch, {.total = hits.data()}, options).value();
  FindInside(geometry, {numbers[0].data(), numbers[1].data(), numbers[2].data()}, kBatch,
             inside.data(), {}, target)
      .value();
  std::uint64_t wrong_crossings = 0, wrong_hits = 0, wrong_inside = 0;
  for (std::uint32_t i = 0; i < kBatch; ++i) {
    const std::uint32_t want = is_inside[i];
    wrong_crossings += crossings[i] % 2 != want;
    wrong_hits += hits[i] % 2 != want;
    wrong_inside += inside[i] != want;
  }
  wrong.crossings += wrong_crossings;
  wrong.hits += wrong_hits;
  wrong.inside += wrong_inside;
}

// Returns the number of rays and points that were wrong.
template <typename Real>
std::uint64_t Run(const ClosedMesh& mesh, std::uint64_t batches, int threads) {
  GeometryInput input;
  input.AddTriangles(mesh.vertices, mesh.indices);
  const GeometryOf<Real> geometry = GeometryOf<Real>::Build(input).value();
  const std::vector<std::string> names = UsableTargets();
  Counts<Real> wrong;
  ParallelFor(threads, batches, [&](int, std::uint64_t number) {
    CountBatch(mesh, geometry, *Target::Named(names[number % names.size()]), number, wrong);
  });
  fmt::print("{:<10}{:<8}{:>14}{:>12}{:>12}{:>16}\n", mesh.name,
             sizeof(Real) == 4 ? "float" : "double", batches * kBatch, wrong.crossings.load(),
             wrong.inside.load(), wrong.hits.load());
  std::fflush(stdout);
  return wrong.crossings + wrong.inside;
}

int Main(int argc, char** argv) {
  CLI::App app("Parity of rays aimed at vertices and edges of closed meshes", "crossing_bench");
  double ray_count = 1e6;  // a double, so that 1e8 may be written
  int threads = 0;
  app.add_option("--rays", ray_count, "rays through all meshes (1e6)")
      ->check(CLI::Range(1.0, 1e13));
  app.add_option("--threads", threads, "0: one a core (0)")->check(CLI::Range(0, 1024));
  CLI11_PARSE(app, argc, argv);
  threads = ThreadCount(threads);
  const ClosedMesh meshes[] = {Ball(), Crumpled(), Needles(), Cubes()};
  const auto batches = static_cast<std::uint64_t>(std::ceil(ray_count / kBatch / 8));
  fmt::print("{:<10}{:<8}{:>14}{:>12}{:>12}{:>16}\n", "mesh", "numbers", "rays", "wrong", "inside",
             "hits counted");
  std::uint64_t wrong = 0;
  for (const ClosedMesh& mesh : meshes) {
    wrong += Run<float>(mesh, batches, threads);
    wrong += Run<double>(mesh, batches, threads);
  }
  return wrong == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}

}  // namespace
}  // namespace sheaf::bench

int main(int argc, char** argv) { return sheaf::bench::Main(argc, argv); }
