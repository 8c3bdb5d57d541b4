// `Renderer`: pictures of one scene one after another, each as if it were the only one.
#include <doctest/doctest.h>

#include <thread>
#include <vector>

#include "same_bits.h"
#include "sheaf/render.h"
#include "src/render/prepare_scene.h"
#include "src/scene/transform.h"
#include "test_frames.h"

namespace sheaf {
namespace {

struct Wanted {
  Camera camera;
  RenderOptions options;
};

// What changes the compiled scene, and what does not: places of the eye near and far, integrators,
// arithmetics, depths, sizes.
std::vector<Wanted> WantedOf(const Scene& scene) {
  std::vector<Wanted> wanted;
  RenderOptions options;
  options.width = 24;
  options.height = 16;
  options.samples = 2;
  options.threads = 1;
  for (const double step : {0.0, 0.5, 3000.0}) {
    Camera camera = scene.cameras.at(0);
    camera.eye.z += step;
    camera.look_at.x += step;
    for (const Integrator integrator :
         {Integrator::kWhitted, Integrator::kPath, Integrator::kDistributed}) {
      for (const Precision precision : {Precision::kStrict, Precision::kDouble}) {
        options.integrator = integrator;
        options.precision = precision;
        options.max_depth = 1 + static_cast<int>(wanted.size() % 3);
        wanted.push_back({camera, options});
      }
    }
  }
  return wanted;
}

// A square so large that its corners depend on how near the eye is to what it sees.
Scene OnHugeGround() {
  Scene scene;
  scene.materials = {Material{}};
  scene.objects = {
      {"", Sphere{{0, 1, -4}, 1}, 0},
      {"", Quad{{Vec3d(-1e7, 0, 1e7), {1e7, 0, 1e7}, {1e7, 0, -1e7}, {-1e7, 0, -1e7}}}, 0}};
  scene.lights = {{"sun", DirectionalLight{{-1, -1.5, -0.7}}}};
  scene.cameras = {{"c", {0.3, 2, 2}, {0, 0.5, -4}, {0, 1, 0}, Perspective{50}}};
  Transform off;
  off.translation = {0.3, -0.7, 0.1};
  REQUIRE(TransformScene(off, &scene) == "");
  REQUIRE(TransformScene(RotationAbout({0.1, 0.2, 1}, 12), &scene) == "");
  return scene;
}

void CheckPictures(const Scene& scene) {
  const Renderer renderer(scene);
  for (const Wanted& wanted : WantedOf(scene)) {
    const Result<Film> alone = Render(scene, wanted.camera, wanted.options);
    const Result<Film> kept = renderer.Render(wanted.camera, wanted.options);
    REQUIRE(alone);
    REQUIRE(kept);
    CHECK(PixelsThatDiffer(kept.value(), alone.value()) == 0);
  }
}

TEST_CASE("a picture of many has the bits of one alone") {
  CheckPictures(EverythingScene(5));
  CheckPictures(OnHugeGround());
}

TEST_CASE("what is made of a scene is kept where another camera would make the same") {
  const Scene scene = EverythingScene(5);
  ScenePreparer preparer(scene);
  REQUIRE(preparer.Check());
  const auto prepare = [&](const Camera& camera, Integrator integrator, Skips skips = Skips::kOn) {
    const auto prepared = preparer.Prepare<float>(camera, integrator, skips, 1);
    REQUIRE(prepared);
    return prepared.value();
  };
  const auto first = prepare(scene.cameras[0], Integrator::kWhitted);
  Camera moved = scene.cameras[0];
  moved.eye *= 1.25;
  CHECK(prepare(moved, Integrator::kWhitted) == first);
  REQUIRE(preparer.Prepare<double>(moved, Integrator::kWhitted, Skips::kOn, 1));
  CHECK(prepare(moved, Integrator::kWhitted) == first);
  CHECK(prepare(moved, Integrator::kWhitted, Skips::kOff) != first);
  CHECK(prepare(moved, Integrator::kPath) != first);
  // The last one alone.
  CHECK(prepare(moved, Integrator::kWhitted) != first);
}

TEST_CASE("how near the eye is decides where huge corners lie, and then nothing is kept") {
  const Scene scene = OnHugeGround();
  ScenePreparer preparer(scene);
  const Camera& near = scene.cameras[0];
  Camera far = near;
  far.eye = near.look_at + (near.eye - near.look_at) * 4.0;
  const auto prepare = [&](const Camera& camera) {
    return preparer.Prepare<float>(camera, Integrator::kWhitted, Skips::kOn, 1).value();
  };
  const auto first = prepare(near);
  REQUIRE(first->has_rounded_corners);
  CHECK(prepare(near) == first);
  CHECK(prepare(far) != first);
}

TEST_CASE("threads share a renderer, and faults are said at each call") {
  const Scene scene = EverythingScene(5);
  const std::vector<Wanted> wanted = WantedOf(scene);
  const Renderer renderer(scene);
  std::vector<Result<Film>> films(wanted.size(), Film{});
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < 6; ++i) {
    threads.emplace_back(
        [&, i] { films[i] = renderer.Render(wanted[i].camera, wanted[i].options); });
  }
  for (std::thread& thread : threads) thread.join();
  for (std::size_t i = 0; i < threads.size(); ++i) {
    REQUIRE(films[i]);
    CHECK(PixelsThatDiffer(films[i].value(),
                           RenderOrFail(scene, wanted[i].camera, wanted[i].options)) == 0);
  }
  Scene broken = scene;
  broken.objects[0].material = 1000;
  const Renderer refusing(broken);
  for (int i = 0; i < 2; ++i) {
    const Result<Film> film = refusing.Render(scene.cameras[0]);
    REQUIRE(!film);
    CHECK(film.error().kind == ErrorKind::kScene);
  }
  Camera blind = scene.cameras[0];
  blind.look_at = blind.eye;
  CHECK(renderer.Render(blind).error().kind == ErrorKind::kScene);
}

}  // namespace
}  // namespace sheaf
