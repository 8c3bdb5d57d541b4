// Distributed ray tracing: the same bits everywhere, and the light, blur and gloss that formulas
// give.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "same_bits.h"
#include "sheaf/render.h"
#include "src/render/compile_scene.h"
#include "src/scalar/camera_ray.h"
#include "src/scalar/incidence.h"
#include "test_frames.h"

namespace sheaf {
namespace {

constexpr double kPi = std::numbers::pi;

// The scene with everything, and all that is drawn from.
Scene DistributedScene(std::uint64_t seed) {
  Scene scene = EverythingScene(seed);
  Random random(seed + 50);
  scene.lights.push_back(
      {"panel", RectangleLight{{2, 6, 1}, {3, 0, 0.5}, {0, 0.2, 2}}, {1, 0.9, 0.8}, 30, true, 3});
  scene.lights.push_back({"plate", DiskLight{{-5, 4, 2}, 1.5, {1, -1, 0}}, {0.5, 1, 1}, 20});
  scene.lights.push_back({"ball", SphereLight{{1, -5, 4}, 1.2}, {1, 0.5, 1}, 25});
  scene.lights.push_back({"unblocked", SphereLight{{-3, 2, 6}, 0.7}, {0.2, 0.2, 0.2}, 9, false});
  scene.lights.push_back({"hazy sun", DirectionalLight{{0.3, -1, 0.2}, 12}, {0.3, 0.3, 0.2}, 1});
  for (Material& material : scene.materials) {
    if (material.reflect != Colour(0.0) || material.transmit != Colour(0.0)) {
      material.roughness = Uniform(random, 0.1, 0.9);
    }
  }
  scene.cameras[0].lens = Lens{0.4, 6.0};
  scene.cameras[1].lens = Lens{0.3, std::nullopt, 5, 20};
  return scene;
}

TEST_CASE("distributed frames have the same bits on every target, thread count, tile and crop") {
  for (std::uint64_t seed = 1; seed <= 2; ++seed) {
    CAPTURE(seed);
    const Scene scene = DistributedScene(seed);
    RenderOptions options;
    options.width = 61;
    options.height = 47;
    options.samples = 3;
    for (const Precision precision : {Precision::kStrict, Precision::kDouble}) {
      options.precision = precision;
      for (const Camera& camera : scene.cameras) {
        CAPTURE(camera.name);
        CheckSameBits(scene, camera, options);
      }
    }
  }
}

TEST_CASE("distributed frames sampled adaptively have the same bits on every target") {
  const Scene scene = DistributedScene(3);
  RenderOptions options;
  options.width = 61;
  options.height = 47;
  options.samples = 4;
  options.contrast = 0.1;
  CheckSameBits(scene, scene.cameras[0], options);
}

TEST_CASE("the classic integrator draws nothing: every sample of it is alike") {
  Scene scene = DistributedScene(4);
  scene.settings.integrator = Integrator::kWhitted;
  RenderOptions options;
  options.width = 40;
  options.height = 30;
  options.samples = 1;
  const Film sharp = RenderOrFail(scene, scene.cameras[0], options);
  Scene plain = scene;
  for (Material& material : plain.materials) material.roughness = 0;
  plain.cameras[0].lens.reset();
  CHECK(PixelsThatDiffer(sharp, RenderOrFail(plain, plain.cameras[0], options)) == 0);
  options.integrator = Integrator::kDistributed;
  CHECK(PixelsThatDiffer(sharp, RenderOrFail(scene, scene.cameras[0], options)) > 100);
}

// A white floor, seen from above, of which a light lies `height` over the middle.
struct Floor {
  Scene scene;

  explicit Floor(const Light& light) {
    Material white;
    white.kd = 1;
    scene.materials = {white};
    scene.objects = {
        {"floor", Quad{{Vec3d(-9, 0, 9), Vec3d(9, 0, 9), Vec3d(9, 0, -9), Vec3d(-9, 0, -9)}}, 0}};
    scene.lights = {light};
    scene.cameras = {{"above", {0, 1, 0}, {0, 0, 0}, {0, 0, -1}, Orthographic{0.01}}};
  }

  // The mean of all samples at (x, 0, 0).
  double LightAt(double x, int samples) const {
    Camera camera = scene.cameras[0];
    camera.eye.x = camera.look_at.x = x;
    RenderOptions options;
    options.width = options.height = 8;
    options.samples = samples;
    const Film film = RenderOrFail(scene, camera, options);
    double sum = 0;
    for (std::size_t i = 0; i < film.rgb.size(); i += 3) sum += static_cast<double>(film.rgb[i]);
    return sum / 64;
  }
};

// Closed forms: the radiance that a light of intensity I shows is I over its area (pi r^2 of a
// ball), and its light is that times the projected solid angle.
TEST_CASE("lights with a size give what their closed forms say") {
  const double intensity = 7, height = 2, radius = 1.5;
  SUBCASE("a disk overhead: I / (h^2 + R^2)") {
    const Floor floor({"", DiskLight{{0, height, 0}, radius, {0, -1, 0}}, Colour(1.0), intensity});
    const double want = intensity / (height * height + radius * radius);
    CHECK(floor.LightAt(0, 256) == doctest::Approx(want).epsilon(2e-4));
  }
  SUBCASE("a ball: that of a point, however large it is and wherever it stands wholly above") {
    const Floor floor({"", SphereLight{{0, height, 0}, radius}, Colour(1.0), intensity});
    for (const double x : {0.0, 0.6, 2.0}) {
      const double square = height * height + x * x;
      const double want = intensity / square * height / std::sqrt(square);
      CHECK(floor.LightAt(x, 256) == doctest::Approx(want).epsilon(2e-4));
    }
  }
  // Lambert's formula for a corner: E = L / 2 * (a/A atan(b/A) + b/B atan(a/B)), A^2 = a^2 + h^2.
  SUBCASE("a rectangle, by its four corners") {
    const double a = 0.8, b = 1.7;  // half edges
    const Floor floor(
        {"", RectangleLight{{0, height, 0}, {2 * a, 0, 0}, {0, 0, 2 * b}}, Colour(1.0), intensity});
    // u x v = x cross z points down.
    const double A = std::sqrt(a * a + height * height), B = std::sqrt(b * b + height * height);
    const double corner = (a / A * std::atan(b / A) + b / B * std::atan(a / B)) / 2;
    const double want = intensity / (4 * a * b) * 4 * corner;
    CHECK(floor.LightAt(0, 256) == doctest::Approx(want).epsilon(2e-4));
  }
  SUBCASE("a sun of 40 degrees overhead: the mean cosine of its cap") {
    const Floor floor({"", DirectionalLight{{0, -1, 0}, 40}, Colour(1.0), intensity});
    const double cosine = std::cos(20 * kPi / 180);
    CHECK(floor.LightAt(0, 256) == doctest::Approx(intensity * (1 + cosine) / 2).epsilon(2e-4));
  }
  SUBCASE("behind a rectangle there is no light") {
    const Floor floor(
        {"", RectangleLight{{0, height, 0}, {0, 0, 2}, {2, 0, 0}}, Colour(1.0), intensity});
    CHECK(floor.LightAt(0, 16) == 0);
  }
}

// A wall's edge before a distant disk: the share of a circle beyond a chord at the distance c from
// its middle, (acos c - c sqrt(1 - c^2)) / pi.
TEST_CASE("the penumbra of an edge is that of a disk behind a chord") {
  const double height = 100, radius = 5, edge = 50;  // half way: twice as far on the disk
  Floor floor({"", DiskLight{{0, height, 0}, radius, {0, -1, 0}}, Colour(1.0), 1e4});
  const double open = floor.LightAt(0, 64);
  floor.scene.objects.push_back(
      {"wall",
       Quad{{Vec3d(0, edge, 50), Vec3d(50, edge, 50), Vec3d(50, edge, -50), Vec3d(0, edge, -50)}},
       0});
  // Under the wall the camera sees it from below only if it stands lower, as it does.
  for (const double c : {-0.8, -0.3, 0.0, 0.5, 0.9}) {
    // From (x, 0, 0) the edge hides what lies right of -x on the disk's plane.
    const double x = c * radius;
    const double want = (std::acos(c) - c * std::sqrt(1 - c * c)) / kPi;
    CAPTURE(c);
    CHECK(floor.LightAt(x, 256) / open == doctest::Approx(want).epsilon(0.004));
  }
}

// Where indices match, facets do not scatter what goes through.
TEST_CASE("holes of rough surfaces let all light through") {
  Scene scene;
  scene.settings.background = Colour(1.0);
  Material material;
  material.reflect = Colour(0.5);
  material.roughness = 1;
  material.alpha = {AlphaMode::kMask, 0.0};
  scene.materials = {material};
  scene.objects = {
      {"", Quad{{Vec3d(-9, -9, 0), Vec3d(9, -9, 0), Vec3d(9, 9, 0), Vec3d(-9, 9, 0)}}, 0}};
  scene.cameras = {{"", {1, 2, 5}, {0, 0, 0}, {0, 1, 0}, Perspective{40}}};
  RenderOptions options;
  options.width = options.height = 8;
  options.samples = 4;
  const Film film = RenderOrFail(scene, scene.cameras[0], options);
  for (const float x : film.rgb) CHECK(x == doctest::Approx(1.0f).epsilon(1e-6));
}

TEST_CASE("a lens that is sharp at infinity shows what lies there") {
  Scene scene = DistributedScene(1);
  scene.settings.background = Colour(0.0);
  scene.lights.clear();
  for (Material& material : scene.materials) material.emission = Colour(1.0);
  RenderOptions options;
  options.width = options.height = 24;
  double last = 0;
  for (const double focus : {1e6, 1e25}) {
    scene.cameras[0].lens = Lens{1e-4, focus};
    const Film film = RenderOrFail(scene, scene.cameras[0], options);
    double sum = 0;
    for (const float x : film.rgb) sum += static_cast<double>(x);
    if (last > 0) CHECK(sum == doctest::Approx(last).epsilon(1e-3));
    last = sum;
  }
  CHECK(last > 100);
}

// Rays through a lens spread over a disk of the aperture's diameter times |1 - distance / focus|.
TEST_CASE("the circle of confusion is the lens' own seen through the plane of focus") {
  Camera camera{"", {0, 0, 0}, {0, 0, -1}, {0, 1, 0}, Perspective{40}};
  camera.lens = Lens{0.5, 4.0};
  const CameraData<double> data = CompileCamera<double>(camera, 100, 100);
  for (const double distance : {1.0, 3.0, 4.0, 8.0, 20.0}) {
    double largest = 0, sum_x = 0, sum_y = 0, squares = 0;
    const auto middle = scalar::PinholeRay(data, 70.0, 20.0, 0.5, 0.5);
    const double along = distance / -middle.direction.z;
    for (std::uint32_t i = 0; i < 1024; ++i) {
      const auto ray = scalar::CameraRay(data, 70.0, 20.0, 0.5, 0.5,
                                         scalar::DrawSample<double>(1, i, kLensDimension));
      const double t = (-distance - ray.origin.z) / ray.direction.z;
      const double x = ray.origin.x + ray.direction.x * t - middle.direction.x * along;
      const double y = ray.origin.y + ray.direction.y * t - middle.direction.y * along;
      largest = std::max(largest, std::hypot(x, y));
      sum_x += x;
      sum_y += y;
      squares += x * x + y * y;
    }
    const double radius = 0.25 * std::abs(1 - distance / 4);
    CHECK(largest <= radius + 1e-12);
    CHECK(largest >= 0.99 * radius - 1e-12);
    CHECK(squares / 1024 == doctest::Approx(radius * radius / 2).epsilon(1e-3));
    CHECK(std::abs(sum_x) / 1024 <= 1e-3 * radius + 1e-12);
    CHECK(std::abs(sum_y) / 1024 <= 1e-3 * radius + 1e-12);
  }
}

TEST_CASE("a lens' blades make its polygon, of the right size and turned") {
  for (const int sides : {3, 5, 6}) {
    double area_mean = 0;
    constexpr std::uint32_t kCount = 4096;
    const double turn = 0.3;
    for (std::uint32_t i = 0; i < kCount; ++i) {
      const auto p = scalar::PolygonPoint(static_cast<double>(sides), turn,
                                          scalar::DrawSample<double>(2, i, kLensDimension));
      // Inside every side's half plane.
      for (int k = 0; k < sides; ++k) {
        const double angle = (k + 0.5) * 2 * kPi / sides + turn * kPi / 2;
        CHECK(p.x * std::cos(angle) + p.y * std::sin(angle) <= std::cos(kPi / sides) + 1e-12);
      }
      area_mean += p.x * p.x + p.y * p.y;
    }
    // The second moment of a regular polygon of circumradius 1.
    const double want = (2 + std::cos(2 * kPi / sides)) / 6;
    CHECK(area_mean / kCount == doctest::Approx(want).epsilon(2e-3));
  }
}

}  // namespace
}  // namespace sheaf
