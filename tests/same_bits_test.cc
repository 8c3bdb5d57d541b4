// Frames have the same bits on every target, thread count, tile size and crop.
#include "same_bits.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "sheaf/render.h"
#include "src/render/render_frame.h"
#include "targets.h"
#include "test_frames.h"

namespace sheaf {
namespace {

TEST_CASE("every scene of scenes/ has the same bits on every target") {
  int scenes = 0;
  for (const auto& entry : std::filesystem::directory_iterator(SHEAF_SOURCE_DIR "/scenes")) {
    const std::string path = entry.path().string();
    if (entry.path().extension() != ".json" || entry.path().stem().extension() == ".schema")
      continue;
    CAPTURE(path);
    const Result<Scene> scene = ReadSceneJson(path);
    REQUIRE(scene.ok());
    ++scenes;
    RenderOptions options;
    options.width = 160;
    options.height = 120;
    for (const Camera& camera : scene.value().cameras) {
      CAPTURE(camera.name);
      CheckSameBits(scene.value(), camera, options);
    }
  }
  CHECK(scenes >= 1);
}

TEST_CASE("the front view at full size has the same bits on every target") {
  const Scene scene = CrystalBall();
  RenderOptions options;
  options.target = Target::Scalar();
  const Film scalar = RenderOrFail(scene, scene.cameras[0], options);
  options.target = Target();
  ForEachTarget([&](Target target) {
    options.target = target;
    CHECK(PixelsThatDiffer(RenderOrFail(scene, scene.cameras[0], options), scalar) == 0);
  });
}

TEST_CASE("scenes with everything have the same bits on every target") {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    CAPTURE(seed);
    const Scene scene = EverythingScene(seed);
    RenderOptions options;
    options.width = 61;
    options.height = 47;
    options.samples = seed == 2 ? 3 : 1;
    options.max_depth = seed == 3 ? 0 : 6;
    for (const Precision precision : {Precision::kStrict, Precision::kDouble}) {
      options.precision = precision;
      for (const Camera& camera : scene.cameras) {
        CAPTURE(camera.name);
        CheckSameBits(scene, camera, options);
      }
    }
  }
}

// Disks of every material, seen from both sides and edge on, some of them twice, in each other's
// shadow and beside other kinds.
TEST_CASE("disks have the same bits on every target") {
  Scene scene = EverythingScene(9);
  Random random(10);
  std::vector<Object> disks;
  for (std::uint32_t i = 0; i < 24; ++i) {
    const Vec3d center = UniformPoint(random, -4, 4);
    Vec3d normal = UniformPoint(random, -1, 1);
    if (i % 4 == 0) normal = {0, i % 8 ? 1 : -1, 0};
    disks.push_back({"", Disk{center, Uniform(random, 0.2, 2), normal}, i % 7});
    if (i % 6 == 0) disks.push_back(disks.back());
  }
  scene.objects.insert(scene.objects.begin(), disks.begin(), disks.end());
  RenderOptions options;
  options.width = 61;
  options.height = 47;
  options.max_depth = 5;
  for (const Precision precision : {Precision::kStrict, Precision::kDouble}) {
    options.precision = precision;
    for (const Camera& camera : scene.cameras) {
      CAPTURE(camera.name);
      RenderStats stats;
      RenderOrFail(scene, camera, options, &stats);
      CHECK(stats.disks == disks.size());
      CheckSameBits(scene, camera, options);
    }
  }
}

// What a scene does not need is left out; with everything forced the bits are the same.
TEST_CASE("skipping changes no bit") {
  std::vector<Scene> scenes = {CrystalBall(), EverythingScene(7)};
  // The same without one thing after the other.
  for (int without = 0; without < 5; ++without) {
    Scene scene = EverythingScene(8);
    for (Material& material : scene.materials) {
      if (without == 0) material.transmit = Colour(0.0);
      if (without == 1) material.reflect = material.transmit = Colour(0.0);
      if (without == 2) material.ks = 0;
      if (without == 3) material.kd = material.ks = 0;
      if (without == 4) material.base_colour = Colour(0.5);
    }
    scenes.push_back(scene);
  }
  for (const Scene& scene : scenes) {
    RenderOptions options;
    options.width = 80;
    options.height = 60;
    options.samples = 2;
    ForEachTarget([&](Target target) {
      options.target = target;
      RenderStats on, off;
      const Film film = RenderOrFail(scene, scene.cameras[0], options, &on);
      Film forced;
      const BandSink keep = [&](Film& band) {
        forced = std::move(band);
        return Status(Done{});
      };
      options.band_rows = options.height;
      ScenePreparer preparer(scene);
      REQUIRE(RenderFrame(preparer, scene.cameras[0], options, Skips::kOff, keep, &off, nullptr));
      CHECK(PixelsThatDiffer(film, forced) == 0);
      CHECK(on.rays.shadow <= off.rays.shadow);
      CHECK(on.rays.reflected == off.rays.reflected);
    });
  }
}

TEST_CASE("a least weight drops rays, and never more light than it says") {
  const Scene scene = GlassAndMirrors();
  RenderOptions options;
  options.width = 64;
  options.height = 48;
  options.max_depth = 7;
  RenderStats all, some;
  const Film exact = RenderOrFail(scene, scene.cameras[0], options, &all);
  options.min_throughput = 0.02;
  const Film film = RenderOrFail(scene, scene.cameras[0], options, &some);
  CheckSameBits(scene, scene.cameras[0], options);
  CHECK(some.rays.traced() < all.rays.traced() * 9 / 10);
  double largest = 0;
  for (std::size_t i = 0; i < film.rgb.size(); ++i) {
    largest = std::max(largest, std::abs(double{film.rgb[i]} - double{exact.rgb[i]}));
  }
  CHECK(largest > 0);
  CHECK(largest < 0.1);
}

TEST_CASE("several materials that spawn rays at one depth have the same bits on every target") {
  const Scene scene = GlassAndMirrors();
  RenderOptions options;
  options.width = 64;
  options.height = 48;
  options.max_depth = 7;
  CheckSameBits(scene, scene.cameras[0], options);
}

// Reflect and transmit add up to 2, so that weights overflow to infinity inside the ball, where
// nothing is shaded.
TEST_CASE("weights that overflow have the same bits on every target") {
  Scene scene;
  Material glass;
  glass.reflect = glass.transmit = Colour(1.0);
  glass.ior = 1.5;
  scene.materials = {glass};
  scene.objects = {{"", Sphere{{0, 0, 0}, 1}, 0}};
  const Camera camera{"in", {0.9, 0, 0}, {0.9, 0, -1}, {0, 1, 0}, Perspective{40}};
  RenderOptions options;
  options.width = 8;
  options.height = 8;
  options.max_depth = 300;
  options.target = Target::Scalar();
  const Film scalar = RenderOrFail(scene, camera, options);
  options.target = Target();
  ForEachTarget([&](Target target) {
    options.target = target;
    CHECK(PixelsThatDiffer(RenderOrFail(scene, camera, options), scalar) == 0);
  });
}

TEST_CASE("a scene of many materials is binned by the few that a tile meets") {
  Scene scene;
  for (int i = 0; i < 5000; ++i) {
    Material material;
    material.base_colour = Colour(i % 7 * 0.1, i % 11 * 0.05, 0.5);
    material.ambient = 1;
    scene.materials.push_back(material);
  }
  for (std::uint32_t i = 0; i < 25; ++i) {
    const double x = i % 5, y = i / 5;
    scene.objects.push_back({"", Sphere{{x - 2, y - 2, -6}, 0.6}, 4999 - 199 * i});
  }
  scene.settings.background = {0.5, 0.5, 0.5};
  const Camera camera{"c", {0, 0, 0}, {0, 0, -1}, {0, 1, 0}, Perspective{60}};
  RenderOptions options;
  options.width = 70;
  options.height = 60;
  CheckSameBits(scene, camera, options);
}

TEST_CASE("an empty scene shows its background, and nothing is lit without lights") {
  Scene scene;
  scene.settings.background = {0.25, 0.5, 0.75};
  const Camera camera{"c", {0, 0, 5}, {0, 0, 0}, {0, 1, 0}, Perspective{}};
  RenderOptions options;
  options.width = 53;
  options.height = 53;
  CheckSameBits(scene, camera, options);
  Film film = RenderOrFail(scene, camera, options);
  CHECK(film.pixel(9, 9)[0] == 0.25f);
  CHECK(film.pixel(9, 9)[2] == 0.75f);

  Material material;
  material.base_colour = Colour(0.5);
  material.ambient = 0.5;
  material.kd = 1;
  scene.materials = {material};
  scene.objects = {{"", Sphere{{0, 0, 0}, 1}, 0}};
  film = RenderOrFail(scene, camera, options);
  CHECK(film.pixel(26, 26)[1] == 0.125f);  // ka * base * background
}

}  // namespace
}  // namespace sheaf
