// What rays see that leave the scene: gradients and pictures of all directions.
#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>

#include "model_files.h"
#include "same_bits.h"
#include "sheaf/formats.h"
#include "sheaf/render.h"
#include "src/formats/write_scene_json.h"
#include "src/render/compile_scene.h"
#include "test_frames.h"

namespace sheaf {
namespace {

// The colour that a ray sees which goes `towards`.
glm::dvec3 Seen(const Environment& environment, const Vec3d& towards) {
  Scene scene;
  scene.settings.environment = environment;
  const Vec3d up = std::abs(towards.y) > 0.9 ? Vec3d(0, 0, 1) : Vec3d(0, 1, 0);
  scene.cameras = {{"c", {0, 0, 0}, towards, up, Perspective{1e-3}}};
  RenderOptions options;
  options.width = 1, options.height = 1;
  const Film film = RenderOrFail(scene, scene.cameras[0], options);
  return {film.rgb[0], film.rgb[1], film.rgb[2]};
}

void CheckColour(const glm::dvec3& got, const glm::dvec3& want) {
  for (int i = 0; i < 3; ++i) CHECK(got[i] == doctest::Approx(want[i]).epsilon(1e-5));
}

// Eight columns and four rows; red counts columns, green rows.
std::shared_ptr<const FloatImage> Numbered() {
  FloatImage image{"sky.pfm", 8, 4, {}};
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 8; ++x) {
      image.rgb.insert(image.rgb.end(), {static_cast<float>(x), static_cast<float>(y), 2.5f});
    }
  }
  return std::make_shared<const FloatImage>(std::move(image));
}

Vec3d Towards(double degrees_right, double degrees_up) {
  const double turn = std::acos(-1.0) / 180;
  const double level = std::cos(degrees_up * turn);
  return {level * std::sin(degrees_right * turn), std::sin(degrees_up * turn),
          -level * std::cos(degrees_right * turn)};
}

TEST_CASE("a gradient goes by height") {
  const Gradient gradient{{0, 0, 1}, {1, 1, 1}, {0.5, 0.25, 0}};
  CheckColour(Seen(gradient, {0, 0, -1}), {1, 1, 1});
  CheckColour(Seen(gradient, {1, 0, 0.5}), {1, 1, 1});
  CheckColour(Seen(gradient, {0, 1, 0}), {0, 0, 1});
  CheckColour(Seen(gradient, {0, -1, 0}), {0.5, 0.25, 0});
  CheckColour(Seen(gradient, {0.8, 0.6, 0}), {0.4, 0.4, 1});
  CheckColour(Seen(gradient, {0, -0.6, 0.8}), {0.7, 0.55, 0.4});
}

TEST_CASE("a map has -z in its middle, +x to the right, +y above, and goes around") {
  const EnvironmentMap map{Numbered()};
  // Middles of pixels: 45 degrees a column and a row.
  for (int x = 0; x < 8; ++x) {
    for (int y = 0; y < 4; ++y) {
      CheckColour(Seen(map, Towards(45 * (x - 3.5), 45 * (1.5 - y))), {x, y, 2.5});
    }
  }
  CheckColour(Seen(map, Towards(0, 22.5)), {3.5, 1, 2.5});
  CheckColour(Seen(map, Towards(180, 22.5)), {3.5, 1, 2.5});  // between the last and the first
  CheckColour(Seen(map, Towards(22.5, 89.999)), {4, 0, 2.5});
  // Turned counter-clockwise, what lay ahead lies to the left.
  const EnvironmentMap turned{Numbered(), 2, 45};
  CheckColour(Seen(turned, Towards(-22.5, 22.5)), {8, 2, 5});
}

TEST_CASE("ambient light is the mean of what is around") {
  Settings settings;
  settings.background = Colour(0.125);
  CheckColour(AmbientLightOf(settings), Colour(0.125));
  settings.environment = Gradient{{0, 0, 1}, {1, 1, 1}, {0.5, 0.25, 0}};
  CheckColour(AmbientLightOf(settings), {0.625, 0.5625, 0.75});
  // Rows of 45 degrees: the outer two have (1 - cos 45) / 2 of the sphere each.
  settings.environment = EnvironmentMap{Numbered(), 2};
  CheckColour(AmbientLightOf(settings), {7, 3, 5});
  settings.ambient = Colour(0.5);
  CheckColour(AmbientLightOf(settings), Colour(0.5));
}

TEST_CASE("environments have the same bits on every target") {
  for (const Environment& environment :
       {Environment(Gradient{{0.1, 0.2, 0.9}, {1, 0.9, 0.8}, {0.3, 0.2, 0.1}}),
        Environment(EnvironmentMap{Numbered(), 0.3, 77})}) {
    Scene scene = EverythingScene(3);
    scene.settings.environment = environment;
    scene.settings.ambient.reset();
    RenderOptions options;
    options.width = 61, options.height = 47;
    for (const Precision precision : {Precision::kStrict, Precision::kDouble}) {
      options.precision = precision;
      CheckSameBits(scene, scene.cameras[0], options);
    }
  }
}

TEST_CASE("environments of scene files") {
  const Folder folder;
  Film film(8, 4);
  const auto numbered = Numbered();
  std::copy(numbered->rgb.begin(), numbered->rgb.end(), film.rgb.begin());
  REQUIRE(WritePicture(film, Transfer::kLinear, folder / "sky.pfm").ok());
  const std::string cameras =
      R"(, "cameras": [{"name": "c", "eye": [0, 0, 5], "look_at": [0, 0, 0]}]})";
  const Scene first = ReadOrFail(folder.Write(
      "a.json", R"({"settings": {"environment": {"map": {"image": "sky.pfm", "strength": 2,
        "rotation": 30}}})" +
                    cameras));
  const Scene again = ReadOrFail(folder.Write("b.json", SceneJsonText(first)));
  for (const Scene* scene : {&first, &again}) {
    REQUIRE(scene->settings.environment.has_value());
    const auto* map = std::get_if<EnvironmentMap>(&*scene->settings.environment);
    REQUIRE(map != nullptr);
    CHECK(map->image->rgb == numbered->rgb);
    CHECK(map->strength == 2);
    CHECK(map->rotation == 30);
  }
  film.rgb[7] = -1;
  REQUIRE(WritePicture(film, Transfer::kLinear, folder / "dark.pfm").ok());
  const auto refused = [&](const std::string& environment, const std::string& part) {
    CheckRefused(
        folder.Write("c.json", R"({"settings": {"environment": )" + environment + "}" + cameras),
        part);
  };
  refused(R"({"map": {"image": "dark.pfm"}})", "a number that is negative or not finite");
  refused(R"({"map": {"image": "none.pfm"}})", "/settings/environment/map/image: none.pfm");
  refused(R"({"gradient": {"zenith": 1, "horizon": 1}})", "/settings/environment/gradient");
  refused("{}", "/settings/environment");
}

}  // namespace
}  // namespace sheaf
