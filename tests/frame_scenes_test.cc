// The scenes that whole frames are timed on, and that scene JSON holds them.
#include "bench/frame_scenes.h"

#include <map>

#include "same_bits.h"
#include "sheaf/render.h"
#include "src/formats/scene_json.h"
#include "src/formats/write_scene_json.h"

namespace sheaf {
namespace {

Film RenderSmall(const Scene& scene, Target target) {
  RenderOptions options;
  options.width = 64;
  options.height = 48;
  options.max_depth = scene.settings.max_depth;
  options.target = target;
  Result<Film> film = Render(scene, scene.cameras.at(0), options);
  REQUIRE(film.ok());
  return std::move(film).value();
}

TEST_CASE("frame scenes have the primitives that they say") {
  struct Counts {
    std::uint32_t spheres, triangles;
  };
  const std::map<std::string, Counts> expected = {
      {"balls", {7381, 2}}, {"tetra", {0, 4096}}, {"mount", {4, 8192}}, {"knot", {2, 100354}}};
  REQUIRE(bench::FrameScenes().size() == expected.size());
  for (const bench::FrameScene& frame : bench::FrameScenes()) {
    CAPTURE(frame.name);
    const Scene scene = frame.make();
    RenderOptions options;
    options.width = options.height = 1;
    RenderStats stats;
    REQUIRE(Render(scene, scene.cameras.at(0), options, &stats).ok());
    CHECK(stats.spheres == expected.at(frame.name).spheres);
    CHECK(stats.triangles == expected.at(frame.name).triangles);
  }
}

TEST_CASE("frame scenes have the same bits on every target") {
  for (const bench::FrameScene& frame : bench::FrameScenes()) {
    CAPTURE(frame.name);
    const Scene scene = frame.make();
    const Film scalar = RenderSmall(scene, Target::Scalar());
    // Something is there: not all of it is background.
    const float background = static_cast<float>(scene.settings.background.x);
    int shown = 0;
    for (std::size_t i = 0; i < scalar.rgb.size(); i += 3) shown += scalar.rgb[i] != background;
    CHECK(shown > 64 * 48 / 10);
    RenderOptions options;
    options.width = 64;
    options.height = 48;
    options.max_depth = scene.settings.max_depth;
    CheckSameBits(scene, scene.cameras.at(0), options);
  }
}

TEST_CASE("a written scene is read back to the very numbers") {
  for (const bench::FrameScene& frame : bench::FrameScenes()) {
    CAPTURE(frame.name);
    const std::string text = SceneJsonText(frame.make());
    const Result<Scene> read = ParseSceneJson(text, frame.name);
    REQUIRE(read.ok());
    CHECK(SceneJsonText(read.value()) == text);
    CHECK(RenderSmall(read.value(), Target()).rgb == RenderSmall(frame.make(), Target()).rgb);
  }
  // What those scenes lack.
  Scene scene;
  Material material;
  material.name = "\"quoted\" name";
  scene.materials = {material};
  scene.objects = {{"o", Triangle{{Vec3d(0), {1, 0, 0}, {0, 1.0 / 3, 1e-9}}, {}}, 0}};
  scene.lights = {{"sun", DirectionalLight{{1, -2, 0.1}}, {1, 0.5, 0}, 3, false}};
  scene.cameras = {{"flat", {0, 0, 9}, {0, 0, 0}, {0, 1, 0}, Orthographic{9}}};
  scene.views = {{"all", {0}}};
  const std::string text = SceneJsonText(scene);
  const Result<Scene> read = ParseSceneJson(text, "scene");
  REQUIRE(read.ok());
  CHECK(SceneJsonText(read.value()) == text);
  CHECK(read.value().objects.at(0).name == "o");
  CHECK_FALSE(read.value().lights.at(0).casts_shadows);
  CHECK(read.value().views.at(0).cameras.size() == 1);
}

}  // namespace
}  // namespace sheaf
