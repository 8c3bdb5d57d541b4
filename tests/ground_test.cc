// Triangles that are huge beside what stands on them, and walls as thin as floats allow.
#include <cmath>
#include <glm/geometric.hpp>

#include "pixels_over.h"
#include "same_bits.h"
#include "sheaf/render.h"
#include "src/lab/find_thin_walls.h"
#include "src/render/compile_scene.h"
#include "src/render/round_corners.h"
#include "src/scalar/triangle.h"
#include "src/scene/transform.h"

namespace sheaf {
namespace {

// How a ground lies.
struct Lie {
  Vec3d axis = {0, 0, 1};  // it is turned about this
  double degrees = 0;
  Vec3d moved{0.0};  // before it is turned: its plane does not pass through the origin then
};

// Two balls on a square of this half size, seen from as far as they are large.
Scene BallsOnGround(double half_size, const Lie& lie, double reflect) {
  Scene scene;
  scene.settings.background = Colour(0.4, 0.5, 0.6);
  scene.settings.ambient = Colour(0.2);
  Material ground, ball;
  ground.ambient = ball.ambient = 0.5;
  ground.kd = 0.7;
  ground.reflect = Colour(reflect);
  ball.kd = 0.8;
  ball.base_colour = Colour(0.9, 0.3, 0.2);
  scene.materials = {ground, ball};
  const double s = half_size;
  scene.objects = {{"", Sphere{{0, 1, -4}, 1}, 1},
                   {"", Sphere{{1.5, 0.1, -3}, 0.1}, 1},
                   {"", Quad{{Vec3d(-s, 0, s), {s, 0, s}, {s, 0, -s}, {-s, 0, -s}}}, 0}};
  scene.lights = {{"sun", DirectionalLight{{-1, -1.5, -0.7}}},
                  {"lamp", PointLight{{2, 5, 1}, {1, 0, 0}}, Colour(0.3)}};
  scene.cameras = {{"c", {0.3, 2, 2}, {0, 0.5, -4}, {0, 1, 0}, Perspective{50}}};
  Transform off;
  off.translation = lie.moved;
  REQUIRE(TransformScene(off, &scene) == "");
  REQUIRE(TransformScene(RotationAbout(lie.axis, lie.degrees), &scene) == "");
  return scene;
}

// Of 400 x 300, against double, and the same bits on every target.
void CheckAgainstDouble(const Scene& scene, int most) {
  RenderOptions options;
  options.width = 400;
  options.height = 300;
  options.max_depth = 3;
  options.precision = Precision::kDouble;
  const Film exact = RenderOrFail(scene, scene.cameras[0], options);
  options.precision = Precision::kStrict;
  const Film strict = RenderOrFail(scene, scene.cameras[0], options);
  const int over = PixelsOver(strict, exact);
  CAPTURE(over);
  CHECK(over <= most);
  ForEachTarget([&](Target target) {
    options.target = target;
    CHECK(PixelsThatDiffer(RenderOrFail(scene, scene.cameras[0], options), strict) == 0);
  });
  options.target = Target::Scalar();
  CHECK(PixelsThatDiffer(RenderOrFail(scene, scene.cameras[0], options), strict) == 0);
}

TEST_CASE("a ground may be any size") {
  for (const double half_size : {1e2, 1e3, 1e4, 1e5, 1e6, 1e7}) {
    for (const Lie& lie : {Lie{}, Lie{{0, 0, 1}, 12}, Lie{{0, 0, 1}, 12, {0, -1.3, 0}},
                           Lie{{0, 0, 1}, 45, {0, -1.3, 0}}, Lie{{3, -1, 2}, 33, {0.7, 2.1, -1}}}) {
      for (const double reflect : {0.0, 0.6}) {
        CAPTURE(half_size);
        CAPTURE(lie.degrees);
        CAPTURE(lie.moved.y);
        CAPTURE(reflect);
        CheckAgainstDouble(BallsOnGround(half_size, lie, reflect), 20);
      }
    }
  }
}

// The surface coordinates of a triangle at a point of its plane.
glm::dvec2 CoordinatesAt(const ShapePrimitive& triangle, const Vec3d& p) {
  Vec3d v[3];
  for (std::size_t k = 0; k < 9; ++k) v[k / 3][static_cast<int>(k % 3)] = triangle.fields[k];
  const Vec3d n = glm::cross(v[1] - v[0], v[2] - v[0]);
  glm::dvec2 sum(0.0);
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3d a = v[(k + 1) % 3], b = v[(k + 2) % 3];
    sum += triangle.uv[k] * (glm::dot(glm::cross(b - a, p - a), n) / glm::dot(n, n));
  }
  return sum;
}

TEST_CASE("corners that move within their plane take their texture along") {
  for (const double half_size : {1e4, 1e5, 1e7}) {
    CAPTURE(half_size);
    const Scene scene = BallsOnGround(half_size, {{3, -1, 2}, 33, {0.7, 2.1, -1}}, 0);
    const ScenePlacement placement = PlaceScene(scene, scene.cameras[0]);
    const auto rounded = RoundCorners(scene, placement);
    REQUIRE(rounded.count(2) == 1);
    const auto& c = std::get<Quad>(scene.objects[2].shape).corners;
    double moved = 0;
    for (const double u : {0.25, 0.5, 0.75}) {
      const Vec3d p = placement.Point(c[0] + (c[1] - c[0]) * u + (c[3] - c[0]) * 0.5);
      for (const ShapePrimitive& triangle : rounded.at(2)) {
        const glm::dvec2 at = CoordinatesAt(triangle, p);
        CHECK(std::abs(at.x - u) < 1e-12);
        CHECK(std::abs(at.y - 0.5) < 1e-12);
        moved = std::max(moved, std::abs(triangle.uv[1].x - 1));
      }
    }
    CHECK(moved > 1e-9);
  }
}

// Two halves of a ground that share an edge.
TEST_CASE("huge shapes that touch stay closed") {
  for (const double half_size : {1e5, 1e7}) {
    CAPTURE(half_size);
    Scene scene = BallsOnGround(half_size, {{3, -1, 2}, 33, {0.7, 2.1, -1}}, 0);
    const Quad whole = std::get<Quad>(scene.objects[2].shape);
    const auto& c = whole.corners;
    const Vec3d left = (c[0] + c[3]) * 0.5, right = (c[1] + c[2]) * 0.5;
    scene.objects[2].shape = Quad{{c[0], c[1], right, left}};
    scene.objects.push_back({"", Quad{{left, right, c[2], c[3]}}, 0});
    const ScenePlacement placement = PlaceScene(scene, scene.cameras[0]);
    const auto rounded = RoundCorners(scene, placement);
    CHECK(rounded.size() == 2);
    const CompiledScene<float> compiled = CompileScene<float>(scene, placement);
    const TriangleArrays<float> triangles = compiled.geometry().triangles;
    for (const Vec3d& corner : {left, right}) {
      const auto nearest = Vec3d(glm::vec3(placement.Point(corner)));
      int found = 0;
      for (std::uint32_t i = 0; i < triangles.count; ++i) {
        for (int k = 0; k < 3; ++k) {
          const Vec3<float> vertex = scalar::TriangleVertex(triangles, i, k);
          found += Vec3d(vertex.x, vertex.y, vertex.z) == nearest;
        }
      }
      CHECK(found == 3);
    }
  }
}

// The largest distance between two floats among the coordinates of the bubble below.
const double kUlp = std::ldexp(1.0, -21);

// A glass bubble with a wall, five away, before a checker.
Scene Bubble(double wall) {
  Scene scene;
  scene.settings.background = scene.settings.ambient.emplace(1.0);
  Material glass, air, checker;
  glass.transmit = air.transmit = Colour(1.0);
  glass.ior = 1.5;
  air.ior = 1 / 1.5;
  checker.ambient = 1;
  checker.base_colour = Checker{Colour(1.0), Colour(0.0), {20, 20}};
  scene.materials = {glass, air, checker};
  const double z = -9.5, s = 4.5;
  scene.objects = {{"", Sphere{{0, 0, -5}, 1.5}, 0},
                   {"", Sphere{{0, 0, -5}, 1.5 - wall}, 1},
                   {"", Quad{{Vec3d(-s, -s, z), {s, -s, z}, {s, s, z}, {-s, s, z}}}, 2}};
  scene.cameras = {{"c", {0, 0, 0}, {0, 0, -1}, {0, 1, 0}, Perspective{40}}};
  return scene;
}

TEST_CASE("a wall of glass may be four units in the last place thin") {
  for (const double ulps : {4, 5, 8, 16, 1000}) {
    CAPTURE(ulps);
    CheckAgainstDouble(Bubble(ulps * kUlp), 60);
  }
}

// A pane of two triangles to each side, before the same checker.
Scene Pane(double wall) {
  Scene scene = Bubble(1);
  const double s = 1.3, z = -5, back = z - wall;
  scene.objects.erase(scene.objects.begin(), scene.objects.begin() + 2);
  scene.objects.push_back({"", Quad{{Vec3d(-s, -s, z), {s, -s, z}, {s, s, z}, {-s, s, z}}}, 0});
  scene.objects.push_back(
      {"", Quad{{Vec3d(-s, -s, back), {-s, s, back}, {s, s, back}, {s, -s, back}}}, 0});
  return scene;
}

TEST_CASE("a pane may be eight units in the last place thin") {
  for (const double ulps : {8, 9, 16, 1000}) {
    CAPTURE(ulps);
    CheckAgainstDouble(Pane(ulps * kUlp), 20);
  }
}

TEST_CASE("glass that floats cannot tell is found") {
  CHECK(FindThinWalls(Bubble(4 * kUlp)).empty());
  CHECK(FindThinWalls(Pane(8 * kUlp)).empty());
  for (const double ulps : {0.5, 1.0, 2.0}) {
    CAPTURE(ulps);
    for (const Scene& scene : {Bubble(ulps * kUlp), Pane(ulps * kUlp)}) {
      const std::vector<ThinWall> walls = FindThinWalls(scene);
      REQUIRE(!walls.empty());
      CHECK(walls[0].thickness == doctest::Approx(ulps * kUlp).epsilon(0.01));
      CHECK(walls[0].needed > walls[0].thickness);
      CHECK(walls[0].needed < 8 * kUlp);
    }
  }
  // What lets no light in has no walls.
  Scene scene = Bubble(kUlp);
  for (Material& material : scene.materials) material.transmit = Colour(0.0);
  CHECK(FindThinWalls(scene).empty());
  // Nor has what alpha leaves out, beside glass elsewhere.
  Scene veil = Pane(kUlp);
  veil.materials.push_back(veil.materials[0]);
  veil.materials[0].transmit = Colour(0.0);
  veil.materials[0].alpha.mode = AlphaMode::kBlend;
  CHECK(FindThinWalls(veil).empty());
}

}  // namespace
}  // namespace sheaf
