// The scenes that rays are timed on, made by the project itself: the same floats on every machine.
#ifndef SHEAF_BENCH_MAKE_SCENES_H_
#define SHEAF_BENCH_MAKE_SCENES_H_

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace sheaf::bench {

// Triangles, then spheres: primitive i is triangle i, or sphere i - triangle_count() beyond them.
struct BenchScene {
  std::string name;
  std::vector<float> vertices;         // x, y, z each
  std::vector<std::uint32_t> indices;  // three a triangle
  std::vector<float> spheres;          // x, y, z, radius each
  float eye[3], look_at[3], up[3];
  float fov;  // degrees, of both sides of a square picture
  float light[3];

  std::uint32_t triangle_count() const { return static_cast<std::uint32_t>(indices.size() / 3); }
  std::uint32_t sphere_count() const { return static_cast<std::uint32_t>(spheres.size() / 4); }
  std::uint32_t primitive_count() const { return triangle_count() + sphere_count(); }
};

// A scene of the catalogue. It is made when asked for, because the largest takes seconds.
struct SceneMaker {
  const char* name;
  std::uint32_t primitives;
  BenchScene (*make)();
};

// All scenes, in the order in which tables show them. The closed surfaces of rising size are called
// "scan-...".
std::span<const SceneMaker> SceneCatalogue();

// A sphere of radius 1 of 20 * frequency^2 triangles: an icosahedron whose faces are cut into
// frequency^2 and blown up. Closed: triangles that meet share their vertices. `frequency` >= 1.
BenchScene GeodesicSphere(std::uint32_t frequency);

// A sphere of radius 0.5 with 9 spheres a third as large around its upper side, and so on, `depth`
// times, over a ground of two triangles (Haines 1987, "balls"): 7,381 spheres at depth 4.
BenchScene SphereFlake(int depth);

// A tetrahedron between corners of the cube [-1, 1]^3, of which only the four half as large at its
// corners are kept, and so on, `depth` times (Haines 1987, "tetra"): 4^(depth + 1) triangles.
BenchScene TetraPyramid(int depth);

// A height field over [-1, 1]^2 of 2 * side^2 triangles, z up. `side` >= 1.
BenchScene Mountain(std::uint32_t side);

// A tube along a (2, 3) torus knot: 896 by 56 quads, 100,352 triangles.
BenchScene TorusKnot();

// A number in [0, 1) that depends on `key` alone.
double HashUnit(std::uint64_t key);

}  // namespace sheaf::bench

#endif  // SHEAF_BENCH_MAKE_SCENES_H_
