// Triangles that are huge beside what stands on them, and walls as thin as floats allow.
#include <cmath>

#include "pixels_over.h"
#include "same_bits.h"
#include "sheaf/render.h"
#include "src/lab/find_thin_walls.h"
#include "src/scene/transform.h"

namespace sheaf {
namespace {

// Two balls on a square of this half size, seen from as far as they are large.
Scene BallsOnGround(double half_size, double degrees, double reflect) {
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
  REQUIRE(TransformScene(RotationAbout({0, 0, 1}, degrees), &scene) == "");
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
    for (const double degrees : {0, 12}) {
      for (const double reflect : {0.0, 0.6}) {
        CAPTURE(half_size);
        CAPTURE(degrees);
        CAPTURE(reflect);
        CheckAgainstDouble(BallsOnGround(half_size, degrees, reflect), 20);
      }
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
