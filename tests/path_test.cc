// Path tracing: the same bits everywhere, and light that formulas and an independent tracer give.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include "same_bits.h"
#include "sheaf/render.h"
#include "src/render/compile_scene.h"
#include "src/scalar/emitters.h"
#include "test_frames.h"

namespace sheaf {
namespace {

double MeanOf(const Film& film) {
  double sum = 0;
  for (const float x : film.rgb) sum += static_cast<double>(x);
  return sum / static_cast<double>(film.rgb.size());
}

TEST_CASE("paths have the same bits on every target, thread count, tile and crop") {
  for (std::uint64_t seed = 1; seed <= 2; ++seed) {
    CAPTURE(seed);
    Scene scene = EverythingScene(seed);
    scene.settings.integrator = Integrator::kPath;
    scene.materials[1].roughness = 0.5;
    scene.materials[5].roughness = 0.3;
    scene.lights.push_back({"ball", SphereLight{{1, -5, 4}, 1.2}, {1, 0.5, 1}, 25});
    RenderOptions options;
    options.width = 61;
    options.height = 47;
    options.samples = 2;
    options.max_depth = 9;
    for (const Precision precision : {Precision::kStrict, Precision::kDouble}) {
      options.precision = precision;
      for (const Camera& camera : scene.cameras) {
        CAPTURE(camera.name);
        CheckSameBits(scene, camera, options);
      }
    }
  }
}

// A ball that takes nothing, before a background of 1, cannot be seen.
TEST_CASE("in a white furnace white balls vanish") {
  Scene scene;
  scene.settings.background = Colour(1.0);
  scene.settings.integrator = Integrator::kPath;
  scene.objects = {{"ball", Sphere{{0, 0, 0}, 1}, 0}};
  scene.cameras = {{"eye", {0, 0, 3}, {0, 0, 0}, {0, 1, 0}, Perspective{30}}};
  RenderOptions options;
  options.width = options.height = 48;
  options.samples = 64;
  options.max_depth = 400;
  Material material;
  const auto mean = [&] {
    scene.materials = {material};
    return MeanOf(RenderOrFail(scene, scene.cameras[0], options));
  };
  SUBCASE("diffuse") {
    material.kd = 1;
    CHECK(mean() == doctest::Approx(1).epsilon(1e-6));
  }
  SUBCASE("diffuse and mirror") {
    material.kd = 0.6;
    material.reflect = Colour(0.4);
    CHECK(mean() == doctest::Approx(1).epsilon(1e-6));
  }
  SUBCASE("smooth glass") {
    material.transmit = Colour(1.0);
    material.ior = 1.5;
    CHECK(mean() == doctest::Approx(1).epsilon(1e-6));
  }
  SUBCASE("rough mirrors") {
    material.reflect = Colour(1.0);
    for (const double roughness : {0.3, 0.7, 1.0}) {
      material.roughness = roughness;
      CAPTURE(roughness);
      CHECK(mean() == doctest::Approx(1).epsilon(1e-3));
    }
  }
  SUBCASE("rough glass") {
    material.transmit = Colour(1.0);
    for (const double roughness : {0.2, 0.5, 0.9}) {
      material.roughness = roughness;
      for (const double ior : {1.1, 1.5}) {
        material.ior = ior;
        CAPTURE(roughness);
        CAPTURE(ior);
        CHECK(mean() == doctest::Approx(1).epsilon(2e-3));
      }
    }
  }
}

// From the inside a ball that shines by 1 and gives back a share is as bright everywhere:
// 1 + share + share^2 and so on.
TEST_CASE("an integrating sphere adds up its bounces") {
  Scene scene;
  scene.settings.integrator = Integrator::kPath;
  Material material;
  material.emission = Colour(1.0);
  scene.objects = {{"ball", Sphere{{0, 0, 0}, 1}, 0}};
  scene.cameras = {{"inside", {0.3, 0.1, 0}, {0, 0, 1}, {0, 1, 0}, Perspective{90}}};
  RenderOptions options;
  options.width = options.height = 32;
  options.samples = 64;
  options.max_depth = 200;
  for (const double share : {0.3, 0.8}) {
    material.kd = share;
    scene.materials = {material};
    const double mean = MeanOf(RenderOrFail(scene, scene.cameras[0], options));
    CHECK(mean == doctest::Approx(1 / (1 - share)).epsilon(5e-3));
  }
}

// ---- Lamps ----

// A white floor under a lamp of radiance 1 that is a rectangle of two triangles, 2 above it.
Scene UnderLamp(double a, double b) {
  Scene scene;
  scene.settings.integrator = Integrator::kPath;
  scene.settings.max_depth = 1;
  Material white, lamp;
  white.kd = 1;
  lamp.emission = Colour(1.0);
  scene.materials = {white, lamp};
  scene.objects = {
      {"floor", Quad{{Vec3d(-9, 0, 9), Vec3d(9, 0, 9), Vec3d(9, 0, -9), Vec3d(-9, 0, -9)}}, 0},
      {"lamp", Quad{{Vec3d(-a, 2, -b), Vec3d(a, 2, -b), Vec3d(a, 2, b), Vec3d(-a, 2, b)}}, 1}};
  scene.cameras = {{"above", {0, 1, 0}, {0, 0, 0}, {0, 0, -1}, Orthographic{0.01}}};
  return scene;
}

// Lambert's formula for a corner: E = L / 2 * (a/A atan(b/A) + b/B atan(a/B)), A^2 = a^2 + h^2.
double LightUnderLamp(double a, double b) {
  const double A = std::sqrt(a * a + 4), B = std::sqrt(b * b + 4);
  return 4 * (a / A * std::atan(b / A) + b / B * std::atan(a / B)) / 2 / std::numbers::pi;
}

TEST_CASE("lamps light what their form factor says, small ones and large") {
  RenderOptions options;
  options.width = options.height = 16;
  options.samples = 256;
  for (const auto& [a, b] : {std::pair(0.05, 0.02), std::pair(0.8, 1.7), std::pair(30.0, 20.0)}) {
    const Scene scene = UnderLamp(a, b);
    CAPTURE(a);
    const double mean = MeanOf(RenderOrFail(scene, scene.cameras[0], options));
    CHECK(mean == doctest::Approx(LightUnderLamp(a, b)).epsilon(1e-3));
  }
}

// Drawn lamps alone are noisy near by, found ones where they are small. Both together are neither.
TEST_CASE("a pixel under a lamp has little noise, whatever the lamp's size") {
  RenderOptions options;
  options.width = options.height = 32;
  options.samples = 16;
  for (const double side : {0.05, 0.5, 5.0, 50.0}) {
    const Scene scene = UnderLamp(side, side);
    const Film film = RenderOrFail(scene, scene.cameras[0], options);
    const double want = LightUnderLamp(side, side);
    double squares = 0;
    for (const float x : film.rgb) {
      squares += (static_cast<double>(x) - want) * (static_cast<double>(x) - want);
    }
    CAPTURE(side);
    CHECK(std::sqrt(squares / static_cast<double>(film.rgb.size())) <= 0.06 * want);
  }
}

// Straight through, and no light is counted twice: that which is drawn stops at the pane.
TEST_CASE("a pane of glass before a lamp changes nothing where it does not bend light") {
  Scene scene = UnderLamp(5, 5);
  Material pane;
  pane.transmit = Colour(1.0);
  scene.materials.push_back(pane);
  scene.objects.push_back(
      {"pane", Quad{{Vec3d(-8, 1.5, -8), Vec3d(8, 1.5, -8), Vec3d(8, 1.5, 8), Vec3d(-8, 1.5, 8)}},
       2});
  scene.settings.max_depth = 3;
  RenderOptions options;
  options.width = options.height = 32;
  options.samples = 256;
  const double mean = MeanOf(RenderOrFail(scene, scene.cameras[0], options));
  CHECK(mean == doctest::Approx(LightUnderLamp(5, 5)).epsilon(2e-3));
}

TEST_CASE("at the last depth lamps give all of their light") {
  RenderOptions options;
  options.width = options.height = 16;
  options.samples = 256;
  options.max_depth = 0;
  for (const double side : {0.5, 20.0}) {
    const Scene scene = UnderLamp(side, side);
    const double mean = MeanOf(RenderOrFail(scene, scene.cameras[0], options));
    CHECK(mean == doctest::Approx(LightUnderLamp(side, side)).epsilon(0.02));
  }
}

// What is not there neither lights nor is in the way.
TEST_CASE("lamps with alpha shine as far as they are there") {
  Scene scene = UnderLamp(5, 5);
  scene.materials[1].alpha = {AlphaMode::kBlend, 0.5};
  scene.settings.max_depth = 3;
  RenderOptions options;
  options.width = options.height = 32;
  options.samples = 256;
  const double half = MeanOf(RenderOrFail(scene, scene.cameras[0], options));
  CHECK(half == doctest::Approx(LightUnderLamp(5, 5) / 2).epsilon(3e-3));
}

TEST_CASE("lamps of all colours and powers are drawn as often as they are bright") {
  Scene scene = UnderLamp(1, 1);
  Material red = scene.materials[1], off = scene.materials[0];
  red.emission = {9, 0, 0};
  off.kd = 0;
  scene.materials.push_back(red);
  scene.materials.push_back(off);
  scene.objects.push_back({"red", Triangle{{Vec3d(5, 1, 0), Vec3d(6, 1, 0), Vec3d(5, 2, 0)}}, 2});
  scene.objects.push_back({"dark", Triangle{{Vec3d(5, 1, 0), Vec3d(6, 1, 0), Vec3d(5, 2, 0)}}, 3});
  const CompiledScene<double> compiled = CompileScene<double>(scene, {}, Integrator::kPath);
  REQUIRE(compiled.emitters->view.count == 3);
  const EmitterView<double>& emitters = compiled.emitters->view;
  // Two triangles of area 2 and power 1, one of area 1/2 and power 3.
  const double all = 2 + 2 + 1.5;
  std::array<double, 3> share{};
  constexpr int kDraws = 100000;
  for (int i = 0; i < kDraws; ++i) {
    const auto choice = scalar::ChooseEmitter(emitters, (i + 0.5) / kDraws);
    REQUIRE(choice.rest >= 0);
    REQUIRE(choice.rest <= 1);
    share[choice.emitter] += 1.0 / kDraws;
  }
  CHECK(share[0] == doctest::Approx(2 / all).epsilon(1e-3));
  CHECK(share[1] == doctest::Approx(2 / all).epsilon(1e-3));
  CHECK(share[2] == doctest::Approx(1.5 / all).epsilon(1e-3));
  CHECK(emitters.density[2] == doctest::Approx(3 / all));
  CHECK(emitters.rgb[0][2] == doctest::Approx(9 / (3 / all) / std::numbers::pi));
  CHECK(emitters.rgb[1][2] == 0);
}

// ---- An independent tracer ----

struct Wall {
  Vec3d corner, u, v;
  double albedo;
};

// A box without a front, lit by a panel, with a screen in it.
constexpr double kSide = 2;
const Wall kWalls[] = {
    {{-1, -1, -1}, {kSide, 0, 0}, {0, 0, kSide}, 0.7},   // floor
    {{-1, 1, -1}, {kSide, 0, 0}, {0, 0, kSide}, 0.8},    // ceiling
    {{-1, -1, -1}, {kSide, 0, 0}, {0, kSide, 0}, 0.6},   // back
    {{-1, -1, -1}, {0, kSide, 0}, {0, 0, kSide}, 0.2},   // left
    {{1, -1, -1}, {0, kSide, 0}, {0, 0, kSide}, 0.5},    // right
    {{-0.7, -1, 0.1}, {0.9, 0, 0.3}, {0, 1.1, 0}, 0.4},  // screen
};
const RectangleLight kPanel{{0.1, 0.9, 0}, {0.8, 0, 0}, {0, 0, 0.6}};  // shines along x cross z
constexpr double kIntensity = 1.5;
constexpr int kMostBounces = 3;

double DotOf(const Vec3d& a, const Vec3d& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Vec3d CrossOf(const Vec3d& a, const Vec3d& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
Vec3d UnitOf(const Vec3d& v) { return v / std::sqrt(DotOf(v, v)); }

// Uniform numbers and directions, no sequences; light and bounces by the textbook.
class PlainTracer {
 public:
  double Radiance(const Vec3d& origin, const Vec3d& direction, int bounces) {
    double t = 1e30;
    const Wall* wall = Hit(origin, direction, t);
    if (!wall) return 0;
    const Vec3d p = origin + direction * t;
    Vec3d n = UnitOf(CrossOf(wall->u, wall->v));
    if (DotOf(n, direction) > 0) n = -n;
    const Vec3d start = p + n * 1e-9;
    // Radiance of the panel is pi I / A where a surface gives back albedo / pi.
    const Vec3d on_light =
        kPanel.center + kPanel.u * (Number() - 0.5) + kPanel.v * (Number() - 0.5);
    const Vec3d to_light = on_light - p;
    const double square = DotOf(to_light, to_light);
    const Vec3d l = to_light / std::sqrt(square);
    const Vec3d down = UnitOf(CrossOf(kPanel.u, kPanel.v));
    const double cosines = std::max(0.0, DotOf(n, l)) * std::max(0.0, -DotOf(down, l));
    double light = 0, end = std::sqrt(square);
    if (cosines > 0 && !Hit(start, l, end)) light = wall->albedo * kIntensity * cosines / square;
    if (bounces == 0) return light;
    // Evenly over the hemisphere: 2 pi times albedo / pi times the cosine.
    Vec3d next;
    do {
      next = {2 * Number() - 1, 2 * Number() - 1, 2 * Number() - 1};
    } while (DotOf(next, next) > 1 || DotOf(next, next) < 1e-6);
    next = UnitOf(next);
    if (DotOf(next, n) < 0) next = -next;
    return light + 2 * wall->albedo * DotOf(next, n) * Radiance(start, next, bounces - 1);
  }

 private:
  double Number() { return std::uniform_real_distribution<double>()(random_); }

  // The nearest wall before `t`, which becomes its distance.
  const Wall* Hit(const Vec3d& o, const Vec3d& d, double& t) const {
    const Wall* nearest = nullptr;
    for (const Wall& wall : kWalls) {
      const Vec3d n = CrossOf(wall.u, wall.v);
      const double at = DotOf(n, wall.corner - o) / DotOf(n, d);
      if (!(at > 0 && at < t)) continue;
      const Vec3d p = o + d * at - wall.corner;
      const double a = DotOf(p, wall.u) / DotOf(wall.u, wall.u);
      const double b = DotOf(p, wall.v) / DotOf(wall.v, wall.v);
      if (a < 0 || a > 1 || b < 0 || b > 1) continue;
      t = at;
      nearest = &wall;
    }
    return nearest;
  }

  std::mt19937_64 random_{7};
};

Scene BoxScene() {
  Scene scene;
  scene.settings.integrator = Integrator::kPath;
  for (const Wall& wall : kWalls) {
    Material material;
    material.kd = wall.albedo;
    scene.objects.push_back({"",
                             Quad{{wall.corner, wall.corner + wall.u, wall.corner + wall.u + wall.v,
                                   wall.corner + wall.v}},
                             static_cast<std::uint32_t>(scene.materials.size())});
    scene.materials.push_back(material);
  }
  scene.lights = {{"panel", kPanel, Colour(1.0), kIntensity}};
  scene.cameras = {{"eye", {0, 0, 4}, {0, 0, 0}, {0, 1, 0}, Perspective{40}}};
  scene.settings.max_depth = kMostBounces;
  return scene;
}

TEST_CASE("a box converges to what an independent tracer gets") {
  const Scene scene = BoxScene();
  constexpr int kPixels = 6;  // a side: large pixels, over each of which both average
  RenderOptions options;
  options.width = options.height = kPixels;
  options.samples = 16384;
  const Film film = RenderOrFail(scene, scene.cameras[0], options);
  PlainTracer tracer;
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> number;
  const double half = std::tan(20 * std::numbers::pi / 180);
  for (int y = 0; y < kPixels; ++y) {
    for (int x = 0; x < kPixels; ++x) {
      constexpr int kSamples = 60000;
      double sum = 0, squares = 0;
      for (int i = 0; i < kSamples; ++i) {
        const double a = (2 * (x + number(random)) / kPixels - 1) * half;
        const double b = (1 - 2 * (y + number(random)) / kPixels) * half;
        const double seen = tracer.Radiance({0, 0, 4}, UnitOf({a, b, -1}), kMostBounces);
        sum += seen;
        squares += seen * seen;
      }
      const double mean = sum / kSamples;
      const double error = std::sqrt((squares / kSamples - mean * mean) / kSamples);
      const double got = static_cast<double>(film.pixel(x, y)[0]);
      CAPTURE(x);
      CAPTURE(y);
      // 4.5 standard errors of the tracer, and as much as ours may have.
      CHECK(std::abs(got - mean) <= 4.5 * error + 2e-3 * mean);
    }
  }
}

TEST_CASE("the error falls at least as the root of the samples") {
  const Scene scene = BoxScene();
  RenderOptions options;
  options.width = options.height = 40;
  options.samples = 16384;
  const Film converged = RenderOrFail(scene, scene.cameras[0], options);
  const auto error = [&](int samples) {
    options.samples = samples;
    const Film film = RenderOrFail(scene, scene.cameras[0], options);
    double sum = 0;
    for (std::size_t i = 0; i < film.rgb.size(); ++i) {
      const double off = static_cast<double>(film.rgb[i]) - static_cast<double>(converged.rgb[i]);
      sum += off * off;
    }
    return std::sqrt(sum / static_cast<double>(film.rgb.size()));
  };
  const double slope = std::log2(error(256) / error(4)) / 6;
  MESSAGE("slope " << slope);
  CHECK(slope < -0.47);
  CHECK(slope > -1.2);
}

}  // namespace
}  // namespace sheaf
