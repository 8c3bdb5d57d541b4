#include "bench/make_scenes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "src/core/vec3.h"

namespace sheaf::bench {
namespace {
using Vec = Vec3<double>;

// ---- Numbers without libm, which differs between platforms ----

std::uint64_t Hash(std::uint64_t x) {  // splitmix64
  x += 0x9e3779b97f4a7c15u;
  x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9u;
  x = (x ^ x >> 27) * 0x94d049bb133111ebu;
  return x ^ x >> 31;
}

struct CosSin {
  double cos, sin;
};

// The point of the unit circle after `turns` >= 0 turns.
CosSin Turn(double turns) {
  const double part = turns - std::floor(turns);
  const int quarter = static_cast<int>(part * 4);
  const double x = (part - quarter * 0.25) * 6.283185307179586;
  const double xx = x * x;
  double cos = 1, sin = 1;
  for (int k = 20; k >= 2; k -= 2) {  // Taylor, enough up to a quarter turn
    cos = 1 - cos * xx / ((k - 1) * k);
    sin = 1 - sin * xx / (k * (k + 1));
  }
  sin *= x;
  switch (quarter) {
    case 0:
      return {cos, sin};
    case 1:
      return {-sin, cos};
    case 2:
      return {-cos, -sin};
    default:
      return {sin, -cos};
  }
}

// Gradient noise in about [-1, 1], one cell a unit.
double Noise(Vec p) {
  const double floor[3] = {std::floor(p.x), std::floor(p.y), std::floor(p.z)};
  const double f[3] = {p.x - floor[0], p.y - floor[1], p.z - floor[2]};
  double weight[3];
  for (int k = 0; k < 3; ++k) weight[k] = f[k] * f[k] * f[k] * (f[k] * (f[k] * 6 - 15) + 10);
  double sum = 0;
  for (int corner = 0; corner < 8; ++corner) {
    std::uint64_t key = 0;
    double share = 1, d[3];
    for (int k = 0; k < 3; ++k) {
      const int upper = corner >> k & 1;
      key = key << 21 |
            (static_cast<std::uint64_t>(static_cast<std::int64_t>(floor[k]) + upper) & 0x1fffff);
      share *= upper ? weight[k] : 1 - weight[k];
      d[k] = f[k] - upper;
    }
    const std::uint64_t bits = Hash(key);
    double slope = 0;
    for (int k = 0; k < 3; ++k) {
      slope += (static_cast<double>(bits >> 20 * k & 0xfffff) * 0x1p-19 - 1) * d[k];
    }
    sum += share * slope;
  }
  return sum;
}

// Octaves of noise, each twice as fine and half as high as the one before.
double Fractal(Vec p, int octaves) {
  double sum = 0, height = 1;
  for (int octave = 0; octave < octaves; ++octave) {
    sum += height * Noise(p);
    p = p * 2.0 + Vec{17.3, 5.1, 29.7};
    height *= 0.5;
  }
  return sum;
}

// ---- Pieces of meshes ----

class MeshBuilder {
 public:
  explicit MeshBuilder(BenchScene& scene) : scene_(scene) {}

  std::uint32_t AddVertex(Vec p) {
    const auto index = static_cast<std::uint32_t>(scene_.vertices.size() / 3);
    for (int k = 0; k < 3; ++k) scene_.vertices.push_back(static_cast<float>(p[k]));
    return index;
  }
  void AddTriangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    scene_.indices.insert(scene_.indices.end(), {a, b, c});
  }
  void AddQuad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    AddTriangle(a, b, c);
    AddTriangle(a, c, d);
  }
  void AddQuad(Vec a, Vec b, Vec c, Vec d) {
    const std::uint32_t first = AddVertex(a);
    AddVertex(b), AddVertex(c), AddVertex(d);
    AddQuad(first, first + 1, first + 2, first + 3);
  }

  // point(u, v) on a grid of `nu` by `nv` quads, u and v from 0 to 1.
  template <typename Point>
  void AddGrid(std::uint32_t nu, std::uint32_t nv, Point point) {
    AddGrid(nu, nv, nu + 1, nv + 1, point);
  }
  // The same, closed along u: u = 1 is u = 0.
  template <typename Point>
  void AddTube(std::uint32_t nu, std::uint32_t nv, Point point) {
    AddGrid(nu, nv, nu, nv + 1, point);
  }
  // The same, closed along both.
  template <typename Point>
  void AddTorus(std::uint32_t nu, std::uint32_t nv, Point point) {
    AddGrid(nu, nv, nu, nv, point);
  }

  void AddBox(Vec lower, Vec upper) {
    std::uint32_t corner[8];
    for (int i = 0; i < 8; ++i) {
      corner[i] = AddVertex(
          {(i & 1 ? upper : lower).x, (i & 2 ? upper : lower).y, (i & 4 ? upper : lower).z});
    }
    constexpr int kFaces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                  {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    for (const auto& f : kFaces) AddQuad(corner[f[0]], corner[f[1]], corner[f[2]], corner[f[3]]);
  }

  // 20 * frequency^2 triangles; place(unit vector) says where a vertex lies.
  template <typename Place>
  void AddGeodesic(std::uint32_t frequency, Place place);

 private:
  template <typename Point>
  void AddGrid(std::uint32_t nu, std::uint32_t nv, std::uint32_t columns, std::uint32_t rows,
               Point point) {
    const auto first = static_cast<std::uint32_t>(scene_.vertices.size() / 3);
    for (std::uint32_t j = 0; j < rows; ++j) {
      for (std::uint32_t i = 0; i < columns; ++i) {
        AddVertex(point(static_cast<double>(i) / nu, static_cast<double>(j) / nv));
      }
    }
    for (std::uint32_t j = 0; j < nv; ++j) {
      const std::uint32_t low = first + j * columns, high = first + (j + 1) % rows * columns;
      for (std::uint32_t i = 0; i < nu; ++i) {
        const std::uint32_t next = (i + 1) % columns;
        AddQuad(low + i, low + next, high + next, high + i);
      }
    }
  }

  BenchScene& scene_;
};

constexpr std::uint32_t kIcosahedronFaces[20][3] = {
    {0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
    {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
    {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};

std::vector<Vec> IcosahedronVertices() {
  const double g = (1 + std::sqrt(5.0)) / 2;
  std::vector<Vec> vertices = {{-1, g, 0}, {1, g, 0}, {-1, -g, 0}, {1, -g, 0},
                               {0, -1, g}, {0, 1, g}, {0, -1, -g}, {0, 1, -g},
                               {g, 0, -1}, {g, 0, 1}, {-g, 0, -1}, {-g, 0, 1}};
  for (Vec& vertex : vertices) vertex = Normalize(vertex);
  return vertices;
}

template <typename Place>
void MeshBuilder::AddGeodesic(std::uint32_t frequency, Place place) {
  const std::uint32_t n = frequency;
  const std::vector<Vec> corners = IcosahedronVertices();
  const auto first = static_cast<std::uint32_t>(scene_.vertices.size() / 3);
  auto blend = [&](std::initializer_list<std::pair<Vec, std::uint32_t>> parts) {
    Vec sum{0, 0, 0};
    for (const auto& [corner, weight] : parts) sum = sum + corner * static_cast<double>(weight);
    AddVertex(place(Normalize(sum)));
  };

  // Corners, then the inner points of the 30 edges, then those of the faces, so that faces that
  // meet share their vertices.
  for (const Vec& corner : corners) AddVertex(place(corner));
  std::uint32_t edge_first[12][12] = {};  // [lower corner][higher corner]
  for (const auto& face : kIcosahedronFaces) {
    for (int k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(face[k], face[(k + 1) % 3]);
      if (edge_first[low][high] != 0) continue;
      edge_first[low][high] = static_cast<std::uint32_t>(scene_.vertices.size() / 3);
      for (std::uint32_t i = 1; i < n; ++i) blend({{corners[low], n - i}, {corners[high], i}});
    }
  }
  // The vertex `i` steps of n from corner a toward corner b.
  auto on_edge = [&](std::uint32_t a, std::uint32_t b, std::uint32_t i) {
    if (i == 0) return first + a;
    if (i == n) return first + b;
    return a < b ? edge_first[a][b] + i - 1 : edge_first[b][a] + n - i - 1;
  };
  std::vector<std::uint32_t> row, next_row;
  for (const auto& [a, b, c] : kIcosahedronFaces) {
    row.clear();
    for (std::uint32_t i = 0; i <= n; ++i) row.push_back(on_edge(a, b, i));
    for (std::uint32_t j = 1; j <= n; ++j) {
      // Row j is j steps from edge ab toward c.
      next_row.assign(1, on_edge(a, c, j));
      for (std::uint32_t i = 1; i < n - j; ++i) {
        next_row.push_back(static_cast<std::uint32_t>(scene_.vertices.size() / 3));
        blend({{corners[a], n - i - j}, {corners[b], i}, {corners[c], j}});
      }
      if (j < n) next_row.push_back(on_edge(b, c, j));
      for (std::uint32_t i = 0; i + j <= n; ++i) {
        AddTriangle(row[i], row[i + 1], next_row[i]);
        if (i + j < n) AddTriangle(row[i + 1], next_row[i + 1], next_row[i]);
      }
      std::swap(row, next_row);
    }
  }
}

void SetVector(float (&to)[3], Vec from) {
  for (int k = 0; k < 3; ++k) to[k] = static_cast<float>(from[k]);
}

BenchScene NewScene(Vec eye, Vec look_at, Vec up, float fov, Vec light) {
  BenchScene scene;
  SetVector(scene.eye, eye);
  SetVector(scene.look_at, look_at);
  SetVector(scene.up, up);
  SetVector(scene.light, light);
  scene.fov = fov;
  return scene;
}

void AddSphere(BenchScene& scene, Vec center, double radius) {
  for (int k = 0; k < 3; ++k) scene.spheres.push_back(static_cast<float>(center[k]));
  scene.spheres.push_back(static_cast<float>(radius));
}

// ---- Scenes ----

// Four planes of a room, five boxes and four coarse balls: triangles larger than packets.
BenchScene LowPoly() {
  BenchScene scene = NewScene({0.4, 2.2, 6.5}, {0, 1.4, -1}, {0, 1, 0}, 60, {2.5, 4.6, 2});
  MeshBuilder mesh(scene);
  mesh.AddQuad({-4, 0, 4}, {4, 0, 4}, {4, 0, -4}, {-4, 0, -4});
  mesh.AddQuad({-4, 0, -4}, {4, 0, -4}, {4, 5, -4}, {-4, 5, -4});
  mesh.AddQuad({-4, 0, 4}, {-4, 0, -4}, {-4, 5, -4}, {-4, 5, 4});
  mesh.AddQuad({4, 0, -4}, {4, 0, 4}, {4, 5, 4}, {4, 5, -4});
  mesh.AddBox({-3.2, 0, -3.2}, {-1.4, 2.6, -1.6});
  mesh.AddBox({1.6, 0, -3}, {3.2, 1.1, -1.2});
  mesh.AddBox({-0.7, 0, -0.4}, {0.6, 0.6, 0.7});
  mesh.AddBox({-3.4, 0, 0.9}, {-2.5, 0.9, 1.8});
  mesh.AddBox({2.7, 0, 1.1}, {3.5, 1.5, 1.9});
  auto ball = [&](Vec center, double radius, std::uint32_t frequency) {
    mesh.AddGeodesic(frequency, [&](Vec p) { return center + p * radius; });
  };
  ball({2.4, 1.9, -2.1}, 0.8, 3);
  ball({-0.05, 1.3, 0.15}, 0.7, 3);
  ball({-1.6, 0.6, 1.6}, 0.6, 3);
  ball({1.5, 0.45, 1.2}, 0.45, 2);
  return scene;
}

// A closed surface like a scanned statue: large forms with ever finer ones on them, seen so that it
// fills two thirds of the picture.
BenchScene Scan(std::uint32_t frequency) {
  BenchScene scene = NewScene({1.1, 1.0, 3.15}, {0, 0, 0}, {0, 1, 0}, 40, {3, 5, 4});
  scene.vertices.reserve(30 * std::size_t{frequency} * frequency + 6);
  scene.indices.reserve(60 * std::size_t{frequency} * frequency);
  MeshBuilder(scene).AddGeodesic(frequency, [](Vec p) {
    const double form = Fractal(p * 1.3, 2);
    const double detail = Fractal(p * 5.0 + Vec{3, 1, 4}, 5);
    return p * (1 + 0.42 * form + 0.08 * detail);
  });
  return scene;
}

// A hall with fluted columns, arches, a coffered vault, banners and balustrades: long and small
// triangles mixed, and every ray hits.
BenchScene Interior() {
  BenchScene scene = NewScene({-1.6, 2.4, 21.5}, {0.7, 4.4, -6}, {0, 1, 0}, 70, {1.5, 9, 4});
  MeshBuilder mesh(scene);
  mesh.AddGrid(80, 200, [](double u, double v) {
    const Vec p{-8.2 + 16.4 * u, 0, 24.2 - 48.4 * v};
    return p + Vec{0, 0.03 * Fractal(p * 0.8, 3), 0};
  });
  mesh.AddGrid(64, 160, [](double u, double v) {
    const auto [cos, sin] = Turn(u / 2);
    const double across = Turn(u * 8).cos, along = Turn(v * 24).cos;
    const double r = 8 + 0.25 * std::max(0.0, across) * std::max(0.0, along);
    return Vec{r * cos, 8 + r * sin, 24.2 - 48.4 * v};
  });
  for (const double side : {-1.0, 1.0}) {
    // A wall of 192 strips from floor to vault, every other pair of them a pilaster.
    mesh.AddGrid(192, 1, [&](double u, double v) {
      const bool is_pilaster = std::lround(u * 192) / 2 % 2 == 0;
      return Vec{side * (is_pilaster ? 7.8 : 8.0), -0.1 + 8.2 * v, 24.2 - 48.4 * u};
    });
    mesh.AddBox({side * 7.6 - 0.2, 7.6, -24}, {side * 7.6 + 0.2, 7.9, 24});
    mesh.AddBox({side * 5 - 0.7, 6.9, -24}, {side * 5 + 0.7, 7.1, 24});
    // An end wall: a rectangle under a fan of long triangles.
    const double z = side * 24;
    mesh.AddQuad({-8.2, -0.1, z}, {8.2, -0.1, z}, {8.2, 8, z}, {-8.2, 8, z});
    const std::uint32_t hub = mesh.AddVertex({0, 8, z});
    std::uint32_t last = mesh.AddVertex({8.4, 8, z});
    for (int i = 1; i <= 64; ++i) {
      const auto [cos, sin] = Turn(i / 128.0);
      const std::uint32_t rim = mesh.AddVertex({8.4 * cos, 8 + 8.4 * sin, z});
      mesh.AddTriangle(hub, last, rim);
      last = rim;
    }
    for (int i = 0; i < 8; ++i) {
      const Vec foot{side * 5, 0, 21 - 6.0 * i};
      mesh.AddTube(40, 30, [&](double u, double v) {
        const auto [cos, sin] = Turn(u);
        const double r = (0.55 - 0.12 * v) * (1 - 0.06 * std::max(0.0, Turn(u * 10).cos));
        return foot + Vec{r * cos, 4.2 * v, r * sin};
      });
      for (const double y : {0.12, 4.2}) {
        mesh.AddTorus(40, 10, [&](double u, double v) {
          const auto [cos, sin] = Turn(u);
          const auto [out, up] = Turn(v);
          const double r = 0.58 + 0.14 * out;
          return foot + Vec{r * cos, y + 0.14 * up, r * sin};
        });
      }
      if (i == 7) continue;
      // The arch to the next column.
      mesh.AddTube(20, 48, [&](double u, double v) {
        const auto [cos, sin] = Turn(v / 2);
        const auto [out, across] = Turn(u);
        const double r = 2.7 + 0.3 * out;
        return foot + Vec{0.45 * across, 4.1 + 0.95 * r * sin, -3 + r * cos};
      });
      // A banner that hangs in it, with folds.
      if (i % 7 > 4) continue;
      mesh.AddGrid(40, 60, [&](double u, double v) {
        const Vec p{0, 6.4 - 3.6 * v, -3 + 2.2 * (u - 0.5)};
        const double fold = 0.10 * Turn(u * 5 + 0.3 * v).sin + 0.12 * Fractal((foot + p) * 1.4, 3);
        return foot + p + Vec{fold * (0.3 + v), 0, 0};
      });
    }
    // A balustrade: turned balusters under a rail.
    mesh.AddBox({side * 3.4 - 0.1, 0.9, -22}, {side * 3.4 + 0.1, 1.0, 14});
    for (int i = 0; i < 30; ++i) {
      const Vec foot{side * 3.4, 0, 13.5 - 1.2 * i};
      mesh.AddTube(12, 10, [&](double u, double v) {
        const auto [cos, sin] = Turn(u);
        const double r = 0.07 + 0.035 * Turn(v * 1.5).cos;
        return foot + Vec{r * cos, 0.9 * v, r * sin};
      });
    }
  }
  return scene;
}

// A sphere and nine a third as large around its upper side, and so on; `up` is a unit vector.
void AddFlake(BenchScene& scene, Vec center, double radius, Vec up, int depth) {
  AddSphere(scene, center, radius);
  if (depth == 0) return;
  const Vec other = std::abs(up.x) < 0.6 ? Vec{1, 0, 0} : Vec{0, 1, 0};
  const Vec side = Normalize(Cross(up, other)), front = Cross(up, side);
  for (int i = 0; i < 9; ++i) {
    // Six around the equator and three above: directions 60 degrees apart.
    const bool upper = i >= 6;
    const auto [cos, sin] = Turn(upper ? (i - 6) / 3.0 + 1.0 / 12 : i / 6.0);
    const double out = upper ? std::sqrt(1.0 / 3) : 1, rise = upper ? std::sqrt(2.0 / 3) : 0;
    const Vec direction = side * (out * cos) + front * (out * sin) + up * rise;
    AddFlake(scene, center + direction * (radius * 4 / 3), radius / 3, direction, depth - 1);
  }
}

void AddTetrahedra(BenchScene& scene, const std::array<Vec, 4>& corners, int depth) {
  if (depth == 0) {
    MeshBuilder mesh(scene);
    const std::uint32_t a = mesh.AddVertex(corners[0]), b = mesh.AddVertex(corners[1]),
                        c = mesh.AddVertex(corners[2]), d = mesh.AddVertex(corners[3]);
    mesh.AddTriangle(a, b, c), mesh.AddTriangle(a, c, d);
    mesh.AddTriangle(a, d, b), mesh.AddTriangle(b, d, c);
    return;
  }
  for (const Vec& kept : corners) {
    std::array<Vec, 4> half = corners;
    for (Vec& corner : half) corner = (corner + kept) * 0.5;
    AddTetrahedra(scene, half, depth - 1);
  }
}

BenchScene SphereCloud() {
  BenchScene scene = NewScene({2.0, 1.4, 3.0}, {0, 0, 0}, {0, 1, 0}, 40, {3, 5, 4});
  for (std::uint64_t i = 0; i < 1'000'000; ++i) {
    auto unit = [&](std::uint64_t field) { return HashUnit(i * 4 + field); };
    AddSphere(scene, {2 * unit(0) - 1, 2 * unit(1) - 1, 2 * unit(2) - 1}, 0.002 + 0.006 * unit(3));
  }
  return scene;
}

// scenes/crystal-ball.json, its front camera and its key light.
BenchScene CrystalBall() {
  BenchScene scene = NewScene({0, 0, 0}, {-0.25, -1, -10}, {0, 1, 0}, 60, {-30, 100, 30});
  AddSphere(scene, {-1, 0, -12}, 2);
  AddSphere(scene, {0.5, -0.5, -8}, 1.5);
  MeshBuilder(scene).AddQuad({-5, -3, -6}, {5, -3, -6}, {5, -3, -16}, {-5, -3, -16});
  return scene;
}

}  // namespace

BenchScene SphereFlake(int depth) {
  BenchScene scene = NewScene({2.1, 1.3, 1.7}, {0, 0, 0}, {0, 0, 1}, 45, {4, 3, 2});
  MeshBuilder(scene).AddQuad({12, 12, -0.5}, {-12, 12, -0.5}, {-12, -12, -0.5}, {12, -12, -0.5});
  AddFlake(scene, {0, 0, 0}, 0.5, {0, 0, 1}, depth);
  return scene;
}

BenchScene TorusKnot() {
  BenchScene scene = NewScene({0, -1.6, 9.3}, {0, 0, 0}, {0, 1, 0}, 45, {4, 6, 8});
  auto curve = [](double t) {
    const auto [cos2, sin2] = Turn(2 * t);
    const auto [cos3, sin3] = Turn(3 * t);
    const double r = 2 + cos3;
    return Vec{r * cos2, r * sin2, sin3};
  };
  MeshBuilder(scene).AddTorus(896, 56, [&](double u, double v) {
    const Vec p = curve(u), ahead = Normalize(curve(u + 1e-4) - p);
    // The torus axis never runs along the knot, so this frame turns without a jump.
    const Vec side = Normalize(Cross(ahead, Vec{0, 0, 1})), up = Cross(side, ahead);
    const auto [cos, sin] = Turn(v);
    return p + side * (0.5 * cos) + up * (0.5 * sin);
  });
  return scene;
}

BenchScene TetraPyramid(int depth) {
  BenchScene scene = NewScene({1, -3.2, -2.2}, {0, 0, 0}, {-1, -1, 1}, 45, {2, -18, -5});
  AddTetrahedra(scene, {Vec{-1, -1, 1}, {-1, 1, -1}, {1, -1, -1}, {1, 1, 1}}, depth);
  return scene;
}

BenchScene Mountain(std::uint32_t side) {
  BenchScene scene = NewScene({-1.6, 1.6, 1.7}, {0, 0, 0}, {0, 0, 1}, 45, {-100, -100, 100});
  MeshBuilder(scene).AddGrid(side, side, [](double u, double v) {
    const Vec p{2 * u - 1, 2 * v - 1, 0};
    // Higher toward the middle, so that it is one mountain.
    const double rise = 0.35 * (1 - Dot(p, p) / 2);
    return p + Vec{0, 0, rise + 0.35 * Fractal(p * 1.7 + Vec{0.3, 0.6, 0.5}, 6)};
  });
  return scene;
}

namespace {

constexpr SceneMaker kCatalogue[] = {
    {"crystal-ball", 4, CrystalBall},
    {"low-poly", 688, LowPoly},
    {"scan-1k", 980, [] { return Scan(7); }},
    {"scan-10k", 9'680, [] { return Scan(22); }},
    {"scan-100k", 100'820, [] { return Scan(71); }},
    {"scan-1M", 1'003'520, [] { return Scan(224); }},
    {"scan-10M", 9'996'980, [] { return Scan(707); }},
    {"interior-200k", 206'732, Interior},
    {"knot-100k", 100'352, TorusKnot},
    {"sphereflake-7k", 7'383, [] { return SphereFlake(4); }},
    {"sphereflake-66k", 66'432, [] { return SphereFlake(5); }},
    {"spheres-1M", 1'000'000, SphereCloud},
};

}  // namespace

double HashUnit(std::uint64_t key) { return static_cast<double>(Hash(key) >> 11) * 0x1p-53; }

std::span<const SceneMaker> SceneCatalogue() { return kCatalogue; }

BenchScene GeodesicSphere(std::uint32_t frequency) {
  BenchScene scene = NewScene({0, 0, 3}, {0, 0, 0}, {0, 1, 0}, 45, {3, 5, 4});
  scene.name = "geodesic";
  MeshBuilder(scene).AddGeodesic(frequency, [](Vec p) { return p; });
  return scene;
}

}  // namespace sheaf::bench
