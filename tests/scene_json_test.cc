// The scene reader: the crystal ball to the last bit, defaults, and what is valid.
#include "src/formats/scene_json.h"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>
#include <string>

#include "scene_text.h"
#include "src/scene/srgb.h"

namespace sheaf::scene_text {
namespace {

void CheckCrystalBallLights(const Scene& scene) {
  struct ExpectedLight {
    Vec3d position;
    Colour colour;
    double e0, distance;
    int power;
  };
  const ExpectedLight expected[] = {{Vec3d(-30, 100, 30), Colour(1, 1, .9), 1.2e5, 114.848, 2},
                                    {Vec3d(40, 60, -15), Colour(.6, .7, 1), 3.6e4, 74.733, 1},
                                    {Vec3d(0, 50, -30), Colour(.3, .3, .4), 1.1e4, 56.303, 0}};
  REQUIRE(scene.lights.size() == 3);
  for (int i = 0; i < 3; ++i) {
    const auto& light = scene.lights[i];
    const auto& point = std::get<PointLight>(light.source);
    const Vec3d d = Vec3d(0, -3, -11) - expected[i].position;
    const double square = d.x * d.x + d.y * d.y + d.z * d.z;
    CHECK(std::abs(std::sqrt(square) - expected[i].distance) < 5e-4);
    const double factor[] = {1.0, std::sqrt(square), square};
    CHECK(light.intensity == expected[i].e0 * factor[expected[i].power]);
    CHECK(point.position == expected[i].position);
    CHECK(point.falloff.constant == (expected[i].power == 0 ? 1.0 : 0.0));
    CHECK(point.falloff.linear == (expected[i].power == 1 ? 1.0 : 0.0));
    CHECK(point.falloff.quadratic == (expected[i].power == 2 ? 1.0 : 0.0));
    CHECK(light.colour == expected[i].colour);
    CHECK(light.casts_shadows);
  }
}

void CheckCrystalBallCameras(const Scene& scene) {
  const std::pair<const char*, Vec3d> eyes[] = {
      {"front", {0, 0, 0}},  {"up", {0, 5, 0}},    {"down", {0, -2, 0}}, {"left", {-6, 0, -1}},
      {"right", {6, 0, -1}}, {"near", {0, 0, -3}}, {"far", {0, 0, 6}}};
  REQUIRE(scene.cameras.size() == 7);
  for (int i = 0; i < 7; ++i) {
    CHECK(scene.cameras[i].name == eyes[i].first);
    CHECK(scene.cameras[i].eye == eyes[i].second);
    CHECK(scene.cameras[i].look_at == Vec3d(-.25, -1, -10));
    CHECK(scene.cameras[i].up == Vec3d(0, 1, 0));
    CHECK(std::get<Perspective>(scene.cameras[i].projection).fov_y == 60.0);
  }
  REQUIRE(scene.views.size() == 4);
  CHECK(scene.views[0].name == "seven");
  CHECK(scene.views[0].cameras == std::vector<std::uint32_t>{0, 1, 2, 3, 4, 5, 6});
  CHECK(scene.views[1].name == "sides");
  CHECK(scene.views[1].cameras == std::vector<std::uint32_t>{3, 4});
}

TEST_CASE("scenes are written for displays unless they say otherwise, and their colours stay") {
  CHECK(sheaf::Settings().transfer == Transfer::kSrgb);
  const std::pair<const char*, Transfer> cases[] = {{"", Transfer::kSrgb},
                                                    {R"(, "srgb": "pictures")", Transfer::kSrgb},
                                                    {R"(, "srgb": false)", Transfer::kLinear}};
  for (const auto& [key, transfer] : cases) {
    const Result<Scene> read = ParseSceneJson(
        R"({"cameras": [{"name": "c", "eye": [0, 0, 0], "look_at": [0, 0, -1]}],
            "settings": {"background": 0.5)" +
            std::string(key) + "}}",
        "s.json");
    if (!read.ok()) FAIL(read.error().message);
    CHECK(read.value().settings.transfer == transfer);
    CHECK(read.value().settings.background == Colour(0.5));
  }
}

TEST_CASE("the crystal ball holds exactly the numbers of its definition") {
  const Result<Scene> read = ReadSceneJson(kScenes + "crystal-ball.json");
  if (!read.ok()) FAIL(read.error().message);
  const Scene& scene = read.value();

  CHECK(scene.settings.width == 640);
  CHECK(scene.settings.height == 480);
  CHECK(scene.settings.samples == 1);
  CHECK(scene.settings.max_depth == 5);
  CHECK(scene.settings.background == Colour(.42, .50, .58));
  CHECK(!scene.settings.ambient);
  CHECK(scene.settings.exposure == 1 / 1.2e5);
  CHECK(scene.settings.transfer == Transfer::kLinear);

  REQUIRE(scene.materials.size() == 3);
  const auto& red = scene.materials[0];
  CHECK(std::get<Colour>(red.base_colour) == Colour(.890, .259, .204));
  const auto& glass = scene.materials[1];
  CHECK(glass.ambient == 0.0);
  CHECK(glass.kd == 0.0);
  CHECK(glass.ks == .5);
  CHECK(glass.shininess == 200.0);
  CHECK(glass.reflect == Colour(0.0));
  CHECK(glass.transmit == Colour(1.0));
  CHECK(glass.ior == 1.5);
  const auto& tiles = scene.materials[2];
  CHECK(std::get<Checker>(tiles.base_colour).even == Colour(.815, .235, .031));
  CHECK(std::get<Checker>(tiles.base_colour).odd == Colour(.937, .937, .231));
  CHECK(std::get<Checker>(tiles.base_colour).cells == glm::dvec2(10.0, 10.0));
  for (const auto* material : {&red, &tiles}) {
    CHECK(material->ambient == .3);
    CHECK(material->kd == .8);
    CHECK(material->ks == .2);
    CHECK(material->shininess == 25.0);
    CHECK(material->reflect == Colour(0.0));
    CHECK(material->transmit == Colour(0.0));
  }

  REQUIRE(scene.objects.size() == 3);
  CHECK(std::get<Sphere>(scene.objects[0].shape).center == Vec3d(-1, 0, -12));
  CHECK(std::get<Sphere>(scene.objects[0].shape).radius == 2.0);
  CHECK(std::get<Sphere>(scene.objects[1].shape).center == Vec3d(.5, -.5, -8));
  CHECK(std::get<Sphere>(scene.objects[1].shape).radius == 1.5);
  CHECK(std::get<struct Quad>(scene.objects[2].shape).corners ==
        std::array{Vec3d(-5, -3, -6), Vec3d(5, -3, -6), Vec3d(5, -3, -16), Vec3d(-5, -3, -16)});
  for (std::uint32_t i = 0; i < 3; ++i) CHECK(scene.objects[i].material == i);
  CheckCrystalBallLights(scene);
  CheckCrystalBallCameras(scene);
}

TEST_CASE("the smallest scene has the defaults of scene.h") {
  const Scene scene =
      Parse(R"({"cameras": [{"name": "c", "eye": [0, 0, 0], "look_at": [0, 0, -1]}]})");
  CHECK(scene.settings.width == 640);
  CHECK(scene.settings.exposure == 1.0);
  CHECK(scene.settings.background == Colour(0.0));
  CHECK(scene.objects.empty());
  CHECK(std::get<Perspective>(scene.cameras[0].projection).fov_y == 60.0);
  const Scene plain = Parse(Material(R"("kd": 1)"));
  CHECK(std::get<Colour>(plain.materials[0].base_colour) == Colour(1.0));
  CHECK(plain.materials[0].shininess == 1.0);
  CHECK(plain.materials[0].ior == 1.0);
}

TEST_CASE("the example in the documentation is a valid scene") {
  const std::string page = ReadText(std::string(SHEAF_SOURCE_DIR) + "/docs/scene-format.md");
  const std::string fence = "```json\n";
  const std::size_t start = page.find(fence);
  REQUIRE(start != page.npos);
  const std::size_t end = page.find("```", start + fence.size());
  CHECK(Outcome(page.substr(start + fence.size(), end - start - fence.size())) == "ok");
}

TEST_CASE("a number stands for grey, and 64e1 is an integer") {
  const Scene scene = Parse(Settings(R"({"background": 0.25, "size": [64e1, 480.0]})"));
  CHECK(scene.settings.background == Colour(0.25));
  CHECK(scene.settings.width == 640);
}

TEST_CASE("sRGB decodes base colours and the background, and nothing else") {
  const Scene scene = Parse(R"({
    "materials": [{"name": "a", "base_colour": 0.5, "reflect": 0.5, "transmit": 0.5},
                  {"name": "b", "base_colour": {"checker": {"even": 0.5, "odd": [0, 0.5, 1]}}}],
    "lights": [{"directional": {"direction": [0, -1, 0]}, "colour": 0.5, "intensity": 0.5}],
    "settings": {"background": 0.5, "ambient": 0.5, "srgb": true},
    "cameras": [{"name": "c", "eye": [0, 0, 0], "look_at": [0, 0, -1]}]})");
  const double half = SrgbDecode(0.5);
  CHECK(scene.settings.transfer == Transfer::kSrgb);
  CHECK(scene.settings.background == Colour(half));
  CHECK(scene.settings.ambient == Colour(0.5));
  CHECK(std::get<Colour>(scene.materials[0].base_colour) == Colour(half));
  CHECK(scene.materials[0].reflect == Colour(0.5));
  CHECK(scene.materials[0].transmit == Colour(0.5));
  const auto& checker = std::get<Checker>(scene.materials[1].base_colour);
  CHECK(checker.even == Colour(half));
  CHECK(checker.odd == Colour(0.0, half, 1.0));
  CHECK(scene.lights[0].colour == Colour(0.5));
  CHECK(scene.lights[0].intensity == 0.5);
}

TEST_CASE("lights take their strength from E0 or intensity") {
  const Scene scene = Parse(WithCamera(R"("lights": [
    {"point": {"position": [0, 3, 4], "falloff": [1, 2, 3]}, "E0": 2, "reference": [0, 0, 0]},
    {"point": {"position": [0, 3, 4]}, "intensity": 7, "shadows": false},
    {"directional": {"direction": [0, -2, 0]}, "E0": 5}])"));
  CHECK(scene.lights[0].intensity == 2.0 * (1 + 2 * 5 + 3 * 25));
  CHECK(scene.lights[1].intensity == 7.0);
  CHECK(!scene.lights[1].casts_shadows);
  CHECK(std::get<PointLight>(scene.lights[1].source).falloff.quadratic == 1.0);
  CHECK(scene.lights[2].intensity == 5.0);
  CHECK(std::get<DirectionalLight>(scene.lights[2].source).direction == Vec3d(0, -2, 0));
}

TEST_CASE("a disk has a center, a radius and a normal, by default towards +z") {
  const Scene scene = Parse(Shape(R"("disk": {"center": [1, 2, 3], "radius": 0.5})"));
  const Disk& disk = std::get<Disk>(scene.objects[0].shape);
  CHECK(disk.center == Vec3d(1, 2, 3));
  CHECK(disk.radius == 0.5);
  CHECK(disk.normal == Vec3d(0, 0, 1));
  const Scene turned =
      Parse(Shape(R"("disk": {"normal": [0, -4, 3], "radius": 2, "center": [0, 0, 0]})"));
  CHECK(std::get<Disk>(turned.objects[0].shape).normal == Vec3d(0, -4, 3));
}

TEST_CASE("odd but valid scenes are accepted") {
  CHECK(Outcome("\xEF\xBB\xBF" + Settings("{}")) == "ok");
  CHECK(Outcome("/* a */" + Settings("{}") + "// b") == "ok");
  CHECK(Outcome(Shape(R"("sphere": {"center": [0, 0, 0], "radius": 0})")) == "ok");
  CHECK(Outcome(Shape(R"("disk": {"center": [0, 0, 0], "radius": 0})")) == "ok");
  CHECK(Outcome(Shape(R"("triangle": {"vertices": [[0, 0, 0], [0, 0, 0], [0, 0, 0]]})")) == "ok");
  CHECK(Outcome(Quad("[[0, 0, 0], [1, 0, 0], [1, 1, 1e-7], [0, 1, 0]]")) == "ok");
  CHECK(Outcome(Quad("[[0, 0, 0], [1, 0, 0], [2, 0, 0], [1, 1, 0]]")) !=
        "ok");  // no area between 0, 1 and 2
  CHECK(Outcome(Quad("[[0, 0, 0], [2, 0, 0], [1, 1, 0], [0, 2, 0]]")) == "ok");  // 2 on line 1-3
  CHECK(Outcome(Quad("[[1e30, 0, 0], [0, 1e30, 0], [-1e30, 0, 0], [0, -1e30, 0]]")) == "ok");
  CHECK(Outcome(Quad("[[1e-30, 0, 0], [0, 1e-30, 0], [-1e-30, 0, 0], [0, -1e-30, 0]]")) == "ok");
  CHECK(Outcome(WithCamera(R"("objects": [], "lights": [], "materials": [], "views": {})")) ==
        "ok");
}

TEST_CASE("a scene of many objects is read") {
  std::string objects = "\"materials\": [{\"name\": \"glass\"}], \"objects\": [";
  for (int i = 0; i < 50000; ++i) {
    objects += fmt::format(
        "{}{{\"name\": \"s{}\", \"sphere\": {{\"center\": [{}, 0, 0], \"radius\": 1}}, "
        "\"material\": \"glass\"}}\n",
        i ? "," : "", i, i);
  }
  const Scene scene = Parse(WithCamera(objects + "]"));
  REQUIRE(scene.objects.size() == 50000);
  CHECK(std::get<Sphere>(scene.objects[49999].shape).center.x == 49999.0);
}

}  // namespace
}  // namespace sheaf::scene_text
