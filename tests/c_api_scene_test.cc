// Scenes, frames and pictures of the C API beside those of C++: the same pictures to the bit, and
// every error a status.
#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "sheaf/capi.h"
#include "sheaf/sheaf.h"
#include "tests/c_handles.h"
#include "tests/run_command.h"

namespace sheaf {
namespace {

TEST_CASE("frames are those of C++") {
  const ReadSceneResult read = ReadScene(kScene).value();
  SceneOwner scene;
  REQUIRE(sheaf_scene_read(kScene.c_str(), nullptr, &scene.handle) == SHEAF_OK);
  REQUIRE(sheaf_scene_camera_count(scene.handle) == read.scene.cameras.size());
  CHECK(sheaf_scene_camera_name(scene.handle, 1) == read.scene.cameras[1].name);
  CHECK(sheaf_scene_camera_name(scene.handle, 99) == nullptr);
  CHECK(sheaf_scene_warning_count(scene.handle) == 0);
  sheaf_settings settings = SHEAF_SETTINGS_INIT;
  REQUIRE(sheaf_scene_get_settings(scene.handle, &settings) == SHEAF_OK);
  CHECK(settings.width == 640);
  CHECK(settings.max_depth == 5);

  sheaf_render_options options = SHEAF_RENDER_OPTIONS_INIT;
  options.camera = 1;
  options.width = 64;
  options.height = 48;
  options.samples = 4;
  options.layers = SHEAF_DEPTH | SHEAF_NORMAL;
  options.crop[0] = 10;
  options.crop[2] = 50;
  options.crop[3] = 48;
  RenderOptions same;
  same.width = 64;
  same.height = 48;
  same.samples = 4;
  same.layers.Add(Layer::kDepth);
  same.layers.Add(Layer::kNormal);
  same.crop = PixelRect{10, 0, 50, 48};
  for (const auto& [given, precision] :
       {std::pair(SHEAF_STRICT, Precision::kStrict), std::pair(SHEAF_DOUBLE, Precision::kDouble)}) {
    options.precision = given;
    same.precision = precision;
    const Film expected = Render(read.scene, read.scene.cameras[1], same).value();
    FilmOwner film;
    sheaf_render_statistics statistics = SHEAF_RENDER_STATISTICS_INIT;
    REQUIRE(sheaf_render(scene.handle, &options, &statistics, &film.handle) == SHEAF_OK);
    REQUIRE(sheaf_film_width(film.handle) == 40);
    REQUIRE(sheaf_film_height(film.handle) == 48);
    const std::size_t bytes = expected.rgb.size() * sizeof(float);
    CHECK(std::memcmp(sheaf_film_rgb(film.handle), expected.rgb.data(), bytes) == 0);
    const auto& depth = expected.layers[static_cast<int>(Layer::kDepth)];
    CHECK(std::memcmp(sheaf_film_layer(film.handle, SHEAF_DEPTH), depth.data(),
                      depth.size() * sizeof(float)) == 0);
    CHECK(sheaf_film_layer(film.handle, SHEAF_ALBEDO) == nullptr);
    CHECK(statistics.primary_rays == 40 * 48 * 4);
    CHECK(statistics.traced_rays > statistics.primary_rays);
    // The scene's own camera, given by its numbers, sees the same.
    sheaf_camera view = SHEAF_CAMERA_INIT;
    REQUIRE(sheaf_scene_get_camera(scene.handle, 1, &view) == SHEAF_OK);
    sheaf_render_options by_view = options;
    by_view.camera = 99;
    by_view.view = &view;
    FilmOwner again;
    REQUIRE(sheaf_render(scene.handle, &by_view, nullptr, &again.handle) == SHEAF_OK);
    CHECK(std::memcmp(sheaf_film_rgb(again.handle), expected.rgb.data(), bytes) == 0);
  }
}

TEST_CASE("lenses, integrators, errors and budgets are those of C++") {
  std::string text = ReadText(SHEAF_SOURCE_DIR "/scenes/soft-light.json");
  const std::size_t lens = text.find("\"lens\":");
  REQUIRE(lens != std::string::npos);
  text.replace(lens, text.find('}', lens) + 1 - lens,
               R"("lens": {"aperture": 0.2, "focus": 3, "blades": 5, "rotation": 9})");
  const Scene read = ParseSceneJson(text, "lens.json").value();
  SceneOwner scene;
  REQUIRE(sheaf_scene_parse(text.data(), text.size(), "lens.json", &scene.handle) == SHEAF_OK);
  sheaf_settings settings = SHEAF_SETTINGS_INIT;
  REQUIRE(sheaf_scene_get_settings(scene.handle, &settings) == SHEAF_OK);
  CHECK(settings.integrator == SHEAF_DISTRIBUTED);
  sheaf_camera view = SHEAF_CAMERA_INIT;
  REQUIRE(sheaf_scene_get_camera(scene.handle, 0, &view) == SHEAF_OK);
  CHECK(view.aperture == 0.2);
  CHECK(view.focus == 3);
  CHECK(view.blades == 5);
  CHECK(view.rotation == 9);

  sheaf_render_options options = SHEAF_RENDER_OPTIONS_INIT;
  options.view = &view;
  options.width = 40;
  options.height = 30;
  options.samples = 16;
  RenderOptions same;
  same.width = 40;
  same.height = 30;
  same.samples = 16;
  sheaf_render_statistics statistics = SHEAF_RENDER_STATISTICS_INIT;
  const auto is_same = [&] {
    FilmOwner film;
    REQUIRE(sheaf_render(scene.handle, &options, &statistics, &film.handle) == SHEAF_OK);
    if (statistics.rounds > 0) same.error = statistics.error;
    const Film expected = Render(read, read.cameras[0], same).value();
    return std::memcmp(sheaf_film_rgb(film.handle), expected.rgb.data(),
                       expected.rgb.size() * sizeof(float)) == 0;
  };
  for (const auto& [given, integrator] : {std::pair(SHEAF_WHITTED, Integrator::kWhitted),
                                          std::pair(SHEAF_DISTRIBUTED, Integrator::kDistributed),
                                          std::pair(SHEAF_PATH, Integrator::kPath)}) {
    options.integrator = given;
    same.integrator = integrator;
    CHECK(is_same());
  }
  CHECK(statistics.rounds == 0);
  options.integrator = SHEAF_SCENE_INTEGRATOR;
  same.integrator.reset();
  options.samples = same.samples = 256;
  options.error = 0.02;
  same.error = 0.02;
  CHECK(is_same());
  // However far it comes.
  options.budget = 1e-3;
  CHECK(is_same());
  CHECK(statistics.rounds >= 1);
  CHECK(statistics.samples >= 16 * 40 * 30);
}

TEST_CASE("frames that fail") {
  SceneOwner scene;
  FilmOwner film;
  CHECK(sheaf_scene_read("/nowhere/scene.json", nullptr, &scene.handle) == SHEAF_INPUT_OUTPUT);
  CHECK(scene.handle == nullptr);
  CHECK(Says("/nowhere/scene.json"));
  const std::string bad = "{\"objects\": 7}";
  CHECK(sheaf_scene_parse(bad.data(), bad.size(), "bad.json", &scene.handle) == SHEAF_BAD_SCENE);
  CHECK(Says("bad.json:1"));
  const std::string text = ReadText(kScene);
  REQUIRE(sheaf_scene_parse(text.data(), text.size(), kScene.c_str(), &scene.handle) == SHEAF_OK);
  const std::vector<std::function<void(sheaf_render_options&)>> mistakes = {
      [](auto& options) { options.camera = 99; },
      [](auto& options) { options.width = -7; },
      [](auto& options) { options.samples = 1 << 20; },
      [](auto& options) { options.threads = -1; },
      [](auto& options) { options.crop[2] = -4; },
      [](auto& options) { options.layers = 1u << 20; },
      [](auto& options) { options.precision = static_cast<sheaf_precision>(3); },
      [](auto& options) { options.target = ""; },
      [](auto& options) { std::memset(&options.integrator, 4, sizeof(options.integrator)); },
      [](auto& options) { options.samples = 64, options.error = 2; },
      [](auto& options) { options.samples = 8, options.error = 0.1; },
      [](auto& options) { options.budget = -1; },
  };
  for (const auto& mistake : mistakes) {
    sheaf_render_options options = SHEAF_RENDER_OPTIONS_INIT;
    mistake(options);
    CHECK(sheaf_render(scene.handle, &options, nullptr, &film.handle) == SHEAF_USAGE);
    CHECK(film.handle == nullptr);
  }
  sheaf_camera view = SHEAF_CAMERA_INIT;
  view.lens = 180;
  sheaf_render_options options = SHEAF_RENDER_OPTIONS_INIT;
  options.view = &view;
  CHECK(sheaf_render(scene.handle, &options, nullptr, &film.handle) == SHEAF_BAD_SCENE);

  ProgressOwner progress;
  REQUIRE(sheaf_progress_create(&progress.handle) == SHEAF_OK);
  sheaf_progress_stop(progress.handle);
  options = SHEAF_RENDER_OPTIONS_INIT;
  options.progress = progress.handle;
  CHECK(sheaf_render(scene.handle, &options, nullptr, &film.handle) == SHEAF_INTERRUPTED);
  ProgressOwner other;
  REQUIRE(sheaf_progress_create(&other.handle) == SHEAF_OK);
  options.progress = other.handle;
  options.width = options.height = 32;
  REQUIRE(sheaf_render(scene.handle, &options, nullptr, &film.handle) == SHEAF_OK);
  CHECK(sheaf_progress_pixels_done(other.handle) == 32 * 32);
}

TEST_CASE("pictures are written and read") {
  const Workspace work;
  const std::vector<float> padded = {0, 0.5f, 1, 9, 0.25f, 0.75f, 0.125f, 9};  // 1 x 2, 4 a row
  FilmOwner film, read;
  REQUIRE(sheaf_film_create(1, 2, padded.data(), 4 * sizeof(float), &film.handle) == SHEAF_OK);
  CHECK(sheaf_film_rgb(film.handle)[3] == 0.25f);
  const std::string pfm = work / "a.pfm", png = work / "a.png", linear = work / "b.png";
  REQUIRE(sheaf_film_write(film.handle, pfm.c_str(), nullptr) == SHEAF_OK);
  REQUIRE(sheaf_film_read(pfm.c_str(), &read.handle) == SHEAF_OK);
  CHECK(std::memcmp(sheaf_film_rgb(read.handle), sheaf_film_rgb(film.handle), 24) == 0);
  sheaf_picture_options options = SHEAF_PICTURE_OPTIONS_INIT;
  options.bits = 16;
  REQUIRE(sheaf_film_write(film.handle, png.c_str(), &options) == SHEAF_OK);
  options.linear = 1;
  options.ev = -1;
  REQUIRE(sheaf_film_write(film.handle, linear.c_str(), &options) == SHEAF_OK);
  for (const auto& [path, factor] : {std::pair(png, 1.0f), std::pair(linear, 0.5f)}) {
    FilmOwner back;
    REQUIRE(sheaf_film_read(path.c_str(), &back.handle) == SHEAF_OK);
    for (int i = 0; i < 6; ++i) {
      const float expected = sheaf_film_rgb(film.handle)[i] * factor;
      CHECK(std::abs(sheaf_film_rgb(back.handle)[i] - expected) < 3e-5f);  // a step of 16 bits
    }
  }
  CHECK(sheaf_film_write(film.handle, (work / "a.gif").c_str(), nullptr) == SHEAF_USAGE);
  CHECK(sheaf_film_write(film.handle, "/nowhere/a.png", nullptr) == SHEAF_INPUT_OUTPUT);
  options.layers = SHEAF_DEPTH;
  CHECK(sheaf_film_write(film.handle, pfm.c_str(), &options) == SHEAF_USAGE);
  CHECK(Says("the film has no layer depth"));
  options = SHEAF_PICTURE_OPTIONS_INIT;
  options.ev = std::nan("");
  CHECK(sheaf_film_write(film.handle, png.c_str(), &options) == SHEAF_USAGE);
  FilmOwner none;
  CHECK(sheaf_film_create(0, 2, padded.data(), 0, &none.handle) == SHEAF_USAGE);
  CHECK(sheaf_film_create(1, 2, nullptr, 0, &none.handle) == SHEAF_USAGE);
  CHECK(sheaf_film_width(nullptr) == 0);
  CHECK(sheaf_film_rgb(nullptr) == nullptr);
}

}  // namespace
}  // namespace sheaf
