// The scene reader: the crystal ball to the last bit, every message, and agreement with the schema.
#include "src/formats/scene_json.h"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "src/core/atomic_file.h"
#include "src/formats/png.h"
#include "src/scene/srgb.h"

namespace sheaf {
namespace {

using nlohmann::json;

const std::string kScenes = std::string(SHEAF_SOURCE_DIR) + "/scenes/";

std::string ReadText(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  REQUIRE(file.good());
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

// "ok" or the message.
std::string Outcome(std::string_view text) {
  const Result<Scene> scene = ParseSceneJson(text, "f");
  if (scene.ok()) return "ok";
  CHECK(scene.error().kind == ErrorKind::kScene);
  return scene.error().message;
}

Scene Parse(std::string_view text) {
  Result<Scene> scene = ParseSceneJson(text, "f");
  if (!scene.ok()) FAIL(scene.error().message);
  return std::move(scene).value();
}

// A scene around one element, on line 1, with what it refers to.
std::string WithCamera(const std::string& members) {
  return "{" + members +
         R"(, "cameras": [{"name": "c", "eye": [0, 0, 0], "look_at": [0, 0, -1]}]})";
}
std::string Settings(const std::string& text) { return WithCamera("\"settings\": " + text); }
std::string Material(const std::string& members) {
  return WithCamera(R"("materials": [{"name": "m", )" + members + "}]");
}
std::string Object(const std::string& members) {
  return WithCamera(R"("materials": [{"name": "glass"}], "objects": [{)" + members + "}]");
}
std::string Shape(const std::string& members) {
  return Object(R"("material": "glass", )" + members);
}
std::string Quad(const std::string& corners) {
  return Shape("\"quad\": {\"corners\": " + corners + "}");
}
std::string Light(const std::string& members) {
  return WithCamera("\"lights\": [{" + members + "}]");
}
std::string Camera(const std::string& members) { return "{\"cameras\": [{" + members + "}]}"; }

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

TEST_CASE("odd but valid scenes are accepted") {
  CHECK(Outcome("\xEF\xBB\xBF" + Settings("{}")) == "ok");
  CHECK(Outcome("/* a */" + Settings("{}") + "// b") == "ok");
  CHECK(Outcome(Shape(R"("sphere": {"center": [0, 0, 0], "radius": 0})")) == "ok");
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

TEST_CASE("every mistake is named, with its line and path") {
  struct Row {
    std::string text;
    std::string message;
  };
  const Row rows[] = {
      // Text that is not JSON.
      {"", "f:1: not valid JSON: the file is empty"},
      {" \n\n", "f:2: not valid JSON: the file is empty"},
      {"\xEF\xBB\xBF", "f:1: not valid JSON: the file is empty"},
      {"{\n\"cameras\": [1,]\n}",
       "f:2: /cameras: not valid JSON: unexpected ']'; expected '[', '{', or a literal"},
      {"{\n\"settings\": {\"samples\": NaN}}",
       "f:2: /settings/samples: not valid JSON: invalid literal 'NaN'"},
      {"[tru]", "f:1: not valid JSON: invalid literal 'tru]'"},
      {"[true &]", "f:1: not valid JSON: invalid literal '&'; expected ']'"},
      {"[\xE2\x80\x9Cx]", "f:1: not valid JSON: invalid literal '\xE2\x80\x9Cx'"},
      {"[\xFF]", "f:1: not valid JSON: invalid literal '\\xFF'"},
      {"{\"settings\":\n {\"exposure\":\n 1e999}}",
       "f:3: /settings/exposure: the number 1e999 is too large"},
      {"{\"a\": [[0], [1,\n-1e999\n]]}", "f:2: /a/1/1: the number -1e999 is too large"},
      {Settings("{}") + "\n}", "f:2: not valid JSON: unexpected '}'; expected end of input"},
      {Settings("{}") + "\n\nx", "f:3: not valid JSON: invalid literal 'x'; expected end of input"},
      {"{\"cameras\": [",
       "f:1: /cameras: not valid JSON: unexpected end of input; expected '[', '{',"
       " or a literal"},
      {"{\"a\": \"x\xFF\"}", "f:1: /a: not valid JSON: invalid string: ill-formed UTF-8 byte"},
      {"{\"a\": \"x\ny\"}",
       "f:1: /a: not valid JSON: invalid string: control character U+000A (LF) must be escaped to "
       "\\u000A or \\n"},
      {"{} /* open",
       "f:1: not valid JSON: invalid comment; missing closing '*/'; expected end of "
       "input"},
      {std::string("{\n}\0x", 5), "f:2: not valid JSON: a NUL byte; the file must be UTF-8 text"},
      {"{\"a\": 1,\n\"a\": 2}", "f:2: /a: duplicate key"},
      {"{\"a\": {\"b\": {\"c\": 1, \"d\": 2, \"c\": 3}}}", "f:1: /a/b/c: duplicate key"},

      // Structure.
      {"[]", "f:1: /: expected an object, found an array"},
      {"{}", "f:1: /cameras: missing key"},
      {"\n{\n}\n", "f:2: /cameras: missing key"},
      {"{\"cameras\": []}", "f:1: /cameras: a scene needs at least one camera"},
      {WithCamera("\"camera\": 1"), "f:1: /camera: unknown key; did you mean \"cameras\"?"},
      {WithCamera("\"a/b~c\\n\": 1"), "f:1: /a~1b~0c\\u000A: unknown key"},
      {WithCamera("\"$schema\": 1"), "f:1: /$schema: expected a string, found a number"},
      {"{\n\"settings\": {\"size\": [1]},\n\"cameras\": 1}",
       "f:2: /settings/size: expected [width, height], found an array of length 1"},
      {"{\"cameras\":\n1,\n\"settings\":\n1}", "f:1: /cameras: expected an array, found a number"},

      // Settings.
      {Settings("1"), "f:1: /settings: expected an object, found a number"},
      {Settings(R"({"size": [640, 0]})"),
       "f:1: /settings/size/1: expected an integer in [1, 65536], found 0"},
      {Settings(R"({"size": [65537, 1]})"),
       "f:1: /settings/size/0: expected an integer in [1, 65536], found 65537"},
      {Settings(R"({"samples": 1.5})"),
       "f:1: /settings/samples: expected an integer in [1, 65536], found 1.5"},
      {Settings(R"({"samples": null})"),
       "f:1: /settings/samples: expected an integer in [1, 65536], found null"},
      {Settings(R"({"depth": 5})"),
       "f:1: /settings/depth: unknown key; did you mean \"max_depth\"?"},
      {Settings(R"({"exposure": 0})"),
       "f:1: /settings/exposure: expected a number in (0, 1e6], found 0"},
      {Settings(R"({"srgb": 1})"), "f:1: /settings/srgb: expected true or false, found a number"},
      {Settings(R"({"background": "red"})"),
       "f:1: /settings/background: expected a colour ([r, g, b] or one number), found a string"},
      {Settings(R"({"background": [0, 0, -1]})"),
       "f:1: /settings/background/2: expected a number in [0, 1e6], found -1"},

      // Materials.
      {WithCamera(R"("materials": [{}])"), "f:1: /materials/0/name: missing key"},
      {WithCamera(R"("materials": [{"name": ""}])"), "f:1: /materials/0/name: the name is empty"},
      {WithCamera(R"("materials": [{"name": "a\n"}])"),
       "f:1: /materials/0/name: a name must not hold control characters"},
      {WithCamera("\"materials\": [{\"name\": \"a\"},\n{\"name\": \"b\"},\n{\"name\": \"a\"}]"),
       "f:3: /materials/2/name: the material \"a\" exists already, from line 1"},
      {Material(R"("color": 1)"),
       "f:1: /materials/0/color: unknown key; did you mean"
       " \"base_colour\"?"},
      {Material(R"("ka": 1)"), "f:1: /materials/0/ka: unknown key"},
      {Material(R"("kd": 2e6)"),
       "f:1: /materials/0/kd: expected a number in [0, 1e6], found 2000000"},
      {Material(R"("reflect": 1.5)"),
       "f:1: /materials/0/reflect: expected a number in [0, 1], found 1.5"},
      {Material(R"("ior": 0)"), "f:1: /materials/0/ior: expected a number in [1e-6, 1e6], found 0"},
      {Material(R"("base_colour": true)"),
       "f:1: /materials/0/base_colour: expected a colour ([r, g, b] or one number) or "
       "{\"checker\": ...}, found a boolean"},
      {Material(R"("base_colour": {})"), "f:1: /materials/0/base_colour/checker: missing key"},
      {Material(R"("base_colour": {"checker": {"cells": [0, 1]}})"),
       "f:1: /materials/0/base_colour/checker/cells/0: expected a number in (0, 65536], found 0"},

      // Objects.
      {Object("\"name\": \"x\",\n\"material\": \"glass\",\n\"sphere\": {\"center\": [0, 0, 0],\n"
              "\"radus\": 1}"),
       "f:4: /objects/0/sphere/radus: unknown key; did you mean \"radius\"?"},
      {Shape("\"sphere\":\n{\"center\": [0, 0, 0]}"), "f:1: /objects/0/sphere/radius: missing key"},
      {Shape("\"sphere\": {\"radius\": 1,\n\"center\": [0,\n0,\n\"0\"]}"),
       "f:4: /objects/0/sphere/center/2: expected a number in [-1e30, 1e30], found a string"},
      {Shape(R"("sphere": {"center": [0, 0, 0], "radius": -1})"),
       "f:1: /objects/0/sphere/radius: expected a number in [0, 1e30], found -1"},
      {Shape(R"("sphere": {"center": [0, 0, 2e30], "radius": 1})"),
       "f:1: /objects/0/sphere/center/2: expected a number in [-1e30, 1e30], found 2e+30"},
      {Shape(R"("name": "x")"),
       "f:1: /objects/0: missing key; give one of \"sphere\", \"quad\", \"triangle\", \"mesh\", "
       "\"include\""},
      {Shape(R"("quad": {}, "sphere": {"center": [0, 0, 0], "radius": 1})"),
       "f:1: /objects/0/sphere: conflicts with \"quad\"; give one of \"sphere\", \"quad\", "
       "\"triangle\", \"mesh\", \"include\""},
      {Shape(R"("sphere": {"center": [0, 0, 0], "radius": 1}, "quad": {})"),
       "f:1: /objects/0/quad: conflicts with \"sphere\"; give one of \"sphere\", \"quad\", "
       "\"triangle\", \"mesh\", \"include\""},
      {Object(R"("sphere": {"center": [0, 0, 0], "radius": 1})"),
       "f:1: /objects/0/material: missing key"},
      {Object(R"("sphere": {"center": [0, 0, 0], "radius": 1}, "material": "Gals")"),
       "f:1: /objects/0/material: no material \"Gals\""},
      {Object(R"("sphere": {"center": [0, 0, 0], "radius": 1}, "material": "galss")"),
       "f:1: /objects/0/material: no material \"galss\"; did you mean \"glass\"?"},
      {Object(R"("sphere": {"center": [0, 0, 0], "radius": 1}, "material": 0)"),
       "f:1: /objects/0/material: expected a string, found a number"},
      {Quad("[[0, 0, 0], [1, 0, 0], [1, 1, 0]]"),
       "f:1: /objects/0/quad/corners: expected 4 points [x, y, z], found an array of length 3"},
      {Quad("[[0, 0, 0], [0, 0, 0], [0, 0, 0], [0, 0, 0]]"),
       "f:1: /objects/0/quad/corners: the quad has no area: its corners coincide"},
      {Quad("[[0, 0, 0], [1, 0, 0], [2, 0, 0], [0, 1, 0]]"),
       "f:1: /objects/0/quad/corners: the quad has no area between its corners 0, 1 and 2"},
      {Quad("[[0, 0, 0], [1, 0, 0], [1, 1, 0], [2, 2, 0]]"),
       "f:1: /objects/0/quad/corners: the quad has no area between its corners 0, 2 and 3"},
      {Quad("[[0, 0, 0], [1, 0, 0], [1, 1, 0.001], [0, 1, 0]]"),
       "f:1: /objects/0/quad/corners: the four corners are not in one plane"},
      {Quad("[[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]]"),
       "f:1: /objects/0/quad/corners: the corners, in this order, do not form a convex quad"},
      {Quad("[[0, 0, 0], [2, 0, 0], [0.5, 0.5, 0], [0, 2, 0]]"),
       "f:1: /objects/0/quad/corners: the corners, in this order, do not form a convex quad"},
      {Quad("[[0.5, 0.5, 0], [0, 2, 0], [0, 0, 0], [2, 0, 0]]"),
       "f:1: /objects/0/quad/corners: the corners, in this order, do not form a convex quad"},
      {Quad("[[0, 2, 0], [0, 0, 0], [2, 0, 0], [0.5, 0.5, 0]]"),
       "f:1: /objects/0/quad/corners: the corners, in this order, do not form a convex quad"},
      {Shape(R"("triangle": {"vertices": [[0, 0, 0], [1, 0, 0], [0, 1, 0]], "uv": [[0, 0]]})"),
       "f:1: /objects/0/triangle/uv: expected 3 pairs [u, v], found an array of length 1"},

      // Lights.
      {Light(R"("intensity": 1)"),
       "f:1: /lights/0: missing key; give one of \"point\", \"spot\", \"directional\""},
      {Light(R"("point": {"position": [0, 0, 0]})"),
       "f:1: /lights/0: missing key; give one of \"E0\", \"intensity\""},
      {Light(R"("point": {"position": [0, 0, 0]}, "e0": 1)"),
       "f:1: /lights/0/e0: unknown key; did you mean \"E0\"?"},
      {Light(R"("point": {"position": [0, 0, 0]}, "intensity": 1, "E0": 1)"),
       "f:1: /lights/0/E0: conflicts with \"intensity\"; give one of \"E0\", \"intensity\""},
      {Light(R"("point": {"position": [0, 0, 0]}, "E0": 1)"),
       "f:1: /lights/0/reference: missing key; \"E0\" needs it"},
      {Light(R"("point": {"position": [1, 2, 3]}, "E0": 1, "reference": [1, 2, 3])"),
       "f:1: /lights/0/reference: the reference point is the light's position, where E0 is not "
       "defined"},
      {Light(R"("point": {"position": [1e30, 2, 3]}, "E0": 1, "reference": [1, 2, 3])"),
       "f:1: /lights/0/E0: the intensity would be 1e+60, more than 1e+24"},
      {Light(R"("directional": {"direction": [0, 1, 0]}, "E0": 1, "reference": [1, 2, 3])"),
       "f:1: /lights/0/reference: only \"E0\" of a point light has a reference point"},
      {Light(R"("directional": {"direction": [0, 0, 0]}, "E0": 1)"),
       "f:1: /lights/0/directional/direction: the vector is zero and gives no direction"},
      {Light(R"("point": {"position": [0, 0, 0], "falloff": "linaer"}, "intensity": 1)"),
       "f:1: /lights/0/point/falloff: expected \"inverse-square\", \"linear\", \"constant\" or "
       "[kc, kl, kq]; did you mean \"linear\"?"},
      {Light(R"("point": {"position": [0, 0, 0], "falloff": [0, 0, 0]}, "intensity": 1)"),
       "f:1: /lights/0/point/falloff: one of the terms must be at least 1e-30"},
      {Light(R"("point": {"position": [0, 0, 0]}, "intensity": -1)"),
       "f:1: /lights/0/intensity: expected a number in [0, 1e24], found -1"},

      // Cameras and views.
      {Camera(R"("name": "c", "eye": [0, 0, 0], "lookat": [0, 0, -1])"),
       "f:1: /cameras/0/lookat: unknown key; did you mean \"look_at\"?"},
      {Camera(R"("name": "c", "eye": [0, 0, 0])"), "f:1: /cameras/0/look_at: missing key"},
      {Camera(R"("name": "c", "eye": [1, 2, 3], "look_at": [1, 2, 3])"),
       "f:1: /cameras/0/look_at: the camera looks at its own eye"},
      {Camera(R"("name": "c", "eye": [0, 0, 0], "look_at": [0, 5, 0])"),
       "f:1: /cameras/0/look_at: the view direction is parallel to up"},
      {Camera(R"("name": "c", "eye": [0, 0, 0], "look_at": [0, 5, 0], "up": [0, -2, 0])"),
       "f:1: /cameras/0/up: the view direction is parallel to up"},
      {Camera(R"("name": "c", "eye": [0, 0, 0], "look_at": [0, 0, 1], "fov_y": 180)"),
       "f:1: /cameras/0/fov_y: expected a number in (0, 180), found 180"},
      {Camera(R"("name": "c", "eye": [0, 0, 0], "look_at": [0, 0, 1], "fov_y": 9,)"
              R"("orthographic": {"height": 1})"),
       "f:1: /cameras/0/orthographic: conflicts with \"fov_y\"; give one of \"fov_y\", "
       "\"orthographic\""},
      {Camera(R"("name": "c", "eye": [0, 0, 0], "look_at": [0, 0, 1], "orthographic": {}})"
              R"(, {"name": "c", "eye": [0, 0, 0], "look_at": [0, 0, 1])"),
       "f:1: /cameras/0/orthographic/height: missing key"},
      {Camera("\"name\": \"c\", \"eye\": [0, 0, 0], \"look_at\": [0, 0, 1]},\n"
              "{\"name\": \"c\", \"eye\": [0, 0, 0], \"look_at\": [0, 0, 1]"),
       "f:2: /cameras/1/name: the camera \"c\" exists already, from line 1"},
      {WithCamera(R"("views": {"": ["c"]})"), "f:1: /views/: the name of the view is empty"},
      {WithCamera(R"("views": {"v": []})"), "f:1: /views/v: a view needs at least one camera"},
      {WithCamera(R"("views": {"v": ["c", "c"]})"),
       "f:1: /views/v/1: the view has this camera already"},
      {WithCamera(R"("views": {"v": ["d"]})"), "f:1: /views/v/0: no camera \"d\""},
      {WithCamera(R"("views": [])"), "f:1: /views: expected an object, found an array"},

      // The first in the file wins, and a cause comes before its consequence.
      {WithCamera("\"lights\": 1,\n\"settings\": 1"),
       "f:1: /lights: expected an array, found a number"},
      {WithCamera("\"objects\": [{\"sphere\": {\"center\": [0, 0, 0], \"radius\": 1}, \"material\":"
                  " \"m\"}],\n\"materials\": [{\"nmae\": \"m\"}]"),
       "f:2: /materials/0/nmae: unknown key; did you mean \"name\"?"},
  };
  for (const Row& row : rows) {
    CAPTURE(row.text);
    CHECK(Outcome(row.text) == row.message);
  }
}

TEST_CASE("lines count from any kind of value, and windows line ends count once") {
  CHECK(Outcome("{\r\n\"cameras\": [\r\n1\r\n]}") ==
        "f:3: /cameras/0: expected an object, found a number");
  CHECK(Outcome("{\"cameras\": [\n// one\n/* two\n three */ null\n]}") ==
        "f:4: /cameras/0: expected an object, found null");
  CHECK(Outcome("{\"settings\": {\"size\": [\n1\n,\n0.5\n]}}") ==
        "f:4: /settings/size/1: expected an integer in [1, 65536], found 0.5");
  CHECK(Outcome("{\"settings\"\n:\n{\n\"exposure\"\n:\n\"x\"}}") ==
        "f:4: /settings/exposure: expected a number in (0, 1e6], found a string");
}

TEST_CASE("deep, wide and long texts end in a short message") {
  for (const char* open : {"[", "{\"a\":"}) {
    std::string bomb = "{\"cameras\": ";
    for (int i = 0; i < 1000000; ++i) bomb += open;
    const std::string message = Outcome(bomb);
    CHECK(message.find("nested deeper than 64 levels") != message.npos);
    CHECK(message.size() < 600);
  }
  std::string wide = "{\"cameras\": [";
  for (int i = 0; i < 1000000; ++i) wide += "0,\n";
  CHECK(Outcome(wide + "0]}") == "f:1: /cameras/0: expected an object, found a number");
  std::string members = "{";
  for (int i = 0; i < 300000; ++i) members += fmt::format("\"key{}\": 0,\n", i);
  CHECK(Outcome(members + "\"key7\": 1}") == "f:300001: /key7: duplicate key");
  CHECK(Outcome("{\"" + std::string(1000000, 'x') + "\": 1}").size() < 300);
  CHECK(Outcome("{\"cameras\": " + std::string(1000000, '9') + "}").size() < 300);
  CHECK(Outcome("{\"cameras\": \"" + std::string(1000000, '9')).size() < 300);
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

TEST_CASE("a file that cannot be read is an input error") {
  Result<Scene> missing = ReadSceneJson("no/such/scene.json");
  REQUIRE(!missing.ok());
  CHECK(missing.error().kind == ErrorKind::kInputOutput);
  CHECK(missing.error().message == "no/such/scene.json: cannot open: No such file or directory");
  Result<Scene> folder = ReadSceneJson(SHEAF_SOURCE_DIR);
  REQUIRE(!folder.ok());
  CHECK(folder.error().kind == ErrorKind::kInputOutput);
  CHECK(folder.error().message == SHEAF_SOURCE_DIR ": cannot read: Is a directory");
}

// --- The schema --------------------------------------------------------------------------------

// As much of a JSON Schema validator as the scene's schema needs; an unknown keyword fails the
// test, so that the schema cannot say something that is not checked here.
class SchemaValidator {
 public:
  explicit SchemaValidator(const json& schema) : root_(schema) {}

  bool Validate(const json& value) { return Check(root_, value); }
  const std::set<const json*>& properties_seen() const { return properties_seen_; }

 private:
  static bool HasType(const json& value, const std::string& type) {
    if (type == "object") return value.is_object();
    if (type == "array") return value.is_array();
    if (type == "string") return value.is_string();
    if (type == "boolean") return value.is_boolean();
    if (type == "number") return value.is_number();
    REQUIRE(type == "integer");
    return value.is_number() && value.get<double>() == std::floor(value.get<double>());
  }

  int CountValid(const json& schemas, const json& value) {
    int count = 0;
    for (const json& schema : schemas) count += Check(schema, value) ? 1 : 0;
    return count;
  }

  bool CheckMembers(const json& schema, const json& value) {
    static const json kNothing = json::object();
    const json& known = schema.contains("properties") ? schema["properties"] : kNothing;
    const json* others =
        schema.contains("additionalProperties") ? &schema["additionalProperties"] : nullptr;
    bool valid = true;
    for (const auto& [key, member] : value.items()) {
      if (known.contains(key)) {
        properties_seen_.insert(&known[key]);
        valid &= Check(known[key], member);
      } else if (others) {
        valid &= others->is_boolean() ? others->get<bool>() : Check(*others, member);
      }
      if (schema.contains("propertyNames")) valid &= Check(schema["propertyNames"], json(key));
    }
    return valid;
  }

  bool Check(const json& schema, const json& value) {
    bool valid = true;
    for (const auto& [word, argument] : schema.items()) {
      const bool is_number = value.is_number();
      if (word == "$schema" || word == "title" || word == "description" || word == "default" ||
          word == "$defs" || word == "then" || word == "else" || word == "propertyNames") {
        continue;
      } else if (word == "$ref") {
        valid &= Check(root_.at(json::json_pointer(argument.get<std::string>().substr(1))), value);
      } else if (word == "type") {
        valid &= HasType(value, argument);
      } else if (word == "properties" || word == "additionalProperties") {
        if (word == "properties" && schema.contains("additionalProperties")) continue;
        if (value.is_object()) valid &= CheckMembers(schema, value);
      } else if (word == "required") {
        for (const json& key : argument) valid &= value.is_object() && value.contains(key);
      } else if (word == "items") {
        if (!value.is_array()) continue;
        for (const json& element : value) valid &= Check(argument, element);
      } else if (word == "contains") {
        valid &= !value.is_array() ||
                 std::any_of(value.begin(), value.end(),
                             [&](const json& element) { return Check(argument, element); });
      } else if (word == "minItems") {
        valid &= !value.is_array() || value.size() >= argument.get<std::size_t>();
      } else if (word == "maxItems") {
        valid &= !value.is_array() || value.size() <= argument.get<std::size_t>();
      } else if (word == "uniqueItems") {
        valid &=
            !value.is_array() || std::set<json>(value.begin(), value.end()).size() == value.size();
      } else if (word == "minimum") {
        valid &= !is_number || value >= argument;
      } else if (word == "maximum") {
        valid &= !is_number || value <= argument;
      } else if (word == "exclusiveMinimum") {
        valid &= !is_number || value > argument;
      } else if (word == "exclusiveMaximum") {
        valid &= !is_number || value < argument;
      } else if (word == "enum") {
        valid &= std::find(argument.begin(), argument.end(), value) != argument.end();
      } else if (word == "pattern") {
        // The one pattern in use: no control characters, and perhaps none at all.
        const std::string pattern = argument;
        REQUIRE(pattern.substr(0, pattern.size() - 2) == "^[^\\u0000-\\u001f\\u007f]");
        if (!value.is_string()) continue;
        const std::string text = value;
        valid &= !text.empty() || pattern[pattern.size() - 2] == '*';
        for (char c : text) valid &= static_cast<unsigned char>(c) >= 0x20 && c != 0x7f;
      } else if (word == "anyOf") {
        valid &= CountValid(argument, value) > 0;
      } else if (word == "oneOf") {
        valid &= CountValid(argument, value) == 1;
      } else if (word == "allOf") {
        valid &= CountValid(argument, value) == static_cast<int>(argument.size());
      } else if (word == "not") {
        valid &= !Check(argument, value);
      } else if (word == "if") {
        valid &= Check(schema[Check(argument, value) ? "then" : "else"], value);
      } else {
        FAIL("the schema uses a keyword that this test does not know: ", word);
      }
    }
    return valid;
  }

  const json& root_;
  std::set<const json*> properties_seen_;
};

json LoadSchema() { return json::parse(ReadText(kScenes + "sheaf.schema.json")); }

// Uses every key of the format.
json CompleteScene() {
  return json::parse(R"({
    "$schema": "sheaf.schema.json",
    "settings": {"size": [64, 48], "samples": 4, "max_depth": 5, "background": [0.1, 0.2, 0.3],
                 "ambient": 0.5, "exposure": 0.5, "srgb": true},
    "materials": [
      {"name": "m", "base_colour": {"checker": {"even": 1, "odd": [0, 0, 0], "cells": [2, 3]}},
       "ambient": 0.1, "kd": 0.5, "ks": 0.5, "shininess": 10, "reflect": 0.5,
       "transmit": [0.1, 0.2, 0.3], "ior": 1.5},
      {"name": "plain", "base_colour": [1, 1, 1], "emission": 0.5},
      {"name": "picture", "base_colour": {"texture": {"image": "schema-texture.png",
       "wrap": ["mirror", "clamp"], "filter": "nearest", "srgb": false, "factor": 0.5}}}],
    "objects": [
      {"name": "mesh", "material": "picture",
       "mesh": {"positions": [[0, 0, 0], [1, 0, 0], [0, 1, 0]], "normals": [[0, 0, 1], [0, 0, 1],
                [0, 0, 1]], "uv": [[0, 0], [1, 0], [0, 1]],
                "colours": [[1, 1, 1], [0.5, 0, 0], [0, 0, 1]], "triangles": [[0, 1, 2]]},
       "transform": [{"translate": [1, 2, 3]}, {"rotate": {"axis": [0, 1, 0], "degrees": 30}},
                     {"scale": [1, 2, 3]},
                     {"matrix": [[1, 0, 0, 5], [0, 1, 0, 6], [0, 0, 2, 7]]}]},
      {"include": "schema-part.json", "transform": {"scale": 2}},
      {"name": "a", "sphere": {"center": [0, 0, 0], "radius": 1}, "material": "m"},
      {"name": "b", "quad": {"corners": [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]},
       "material": "m"},
      {"triangle": {"vertices": [[0, 0, 0], [1, 0, 0], [0, 1, 0]],
                    "uv": [[0, 0], [0.5, 0], [0, 2]]}, "material": "plain"}],
    "lights": [
      {"name": "l", "point": {"position": [9, 8, 7], "falloff": "linear"}, "colour": [1, 1, 0.5],
       "E0": 100, "reference": [0, 0, 0], "shadows": false},
      {"point": {"position": [9, 8, 7], "falloff": [1, 2, 3]}, "intensity": 5},
      {"spot": {"position": [9, 8, 7], "direction": [0, -1, 0.5], "inner": 5, "outer": 30,
                "falloff": "constant"}, "intensity": 2},
      {"directional": {"direction": [0, -1, 1]}, "E0": 1},
      {"directional": {"direction": [1, -1, 1]}, "intensity": 1}],
    "cameras": [
      {"name": "p", "eye": [0, 0, 9], "look_at": [0, 0, 0], "up": [0, 1, 0.5], "fov_y": 40},
      {"name": "o", "eye": [0, 0, 9], "look_at": [0, 0, 0], "orthographic": {"height": 3}}],
    "views": {"all": ["p", "o"], "one": ["o"]}})");
}

// What only the reader can know.
bool IsBeyondSchema(const std::string& message) {
  for (const char* part : {": no material \"",
                           ": no camera \"",
                           " exists already, from line ",
                           "gives no direction",
                           "looks at its own eye",
                           "parallel to up",
                           "the quad has no area",
                           "not in one plane",
                           "do not form a convex quad",
                           "where E0 is not defined",
                           "the intensity would be",
                           "one of the terms must be",
                           "cannot open",
                           "cannot read",
                           "lies outside",
                           "must end in",
                           "no name of a file",
                           "a scale of 0",
                           "is singular",
                           "inner must be below",
                           "elements for",
                           "expected an integer in [0, ",
                           "neither a PNG nor"}) {
    if (message.find(part) != message.npos) return true;
  }
  return false;
}

// Every document that differs from `document` in one place.
std::vector<json> Mutations(const json& document) {
  const json values = json::parse(
      R"([null, true, -1, 0, 0.5, 3, 180, 65536, 1e7, 1e40, "", "x", "linear", "a\u0001", [], {},
          [1, 2], [1, 2, 3], ["p"], {"checker": {}}, {"height": 1}])");
  std::vector<json> mutations;
  const json flat_keys = document.flatten();
  std::set<std::string> places{""};
  for (const auto& [pointer, leaf] : flat_keys.items()) {
    for (std::string at = pointer; !at.empty(); at.erase(at.rfind('/'))) places.insert(at);
  }
  for (const std::string& text : places) {
    const json::json_pointer place(text);
    for (const json& value : values) {
      json changed = document;
      changed[place] = value;
      mutations.push_back(changed);
    }
    if (document[place].is_object()) {
      json grown = document;
      grown[place]["zzzz"] = 1;
      mutations.push_back(grown);
      for (const char* key : {"reference", "E0", "intensity", "fov_y", "name", "uv", "sphere"}) {
        grown = document;
        grown[place].emplace(key, 1);
        mutations.push_back(grown);
      }
    }
    if (document[place].is_array()) {
      json grown = document;
      grown[place].push_back(document[place][0]);
      mutations.push_back(grown);
    }
    if (text.empty()) continue;
    const json& parent = document[place.parent_pointer()];
    json shrunk = document;
    if (parent.is_object()) {
      shrunk[place.parent_pointer()].erase(place.back());
      mutations.push_back(shrunk);
      shrunk[place.parent_pointer()][place.back() + "_"] = document[place];
      mutations.push_back(shrunk);
    } else {
      shrunk[place.parent_pointer()].erase(std::stoul(place.back()));
      mutations.push_back(shrunk);
    }
  }
  return mutations;
}

void CollectProperties(const json& schema, std::set<const json*>* properties) {
  if (!schema.is_structured()) return;
  if (schema.is_object() && schema.contains("properties")) {
    for (const json& property : schema["properties"]) properties->insert(&property);
  }
  for (const json& part : schema) CollectProperties(part, properties);
}

TEST_CASE("the schema accepts the shipped scene") {
  const json schema = LoadSchema();
  SchemaValidator validator(schema);
  const json scene = json::parse(ReadText(kScenes + "crystal-ball.json"), nullptr, true, true);
  CHECK(validator.Validate(scene));
}

TEST_CASE("schema and reader know the same keys, types and ranges") {
  const json schema = LoadSchema();
  SchemaValidator validator(schema);
  const json complete = CompleteScene();
  // The files that it names.
  REQUIRE(WritePng({1, 1, {255, 0, 0}}, Transfer::kLinear, "schema-texture.png").ok());
  REQUIRE(WriteFileWhole("schema-part.json",
                         R"({"cameras": [{"name": "p", "eye": [0, 0, 9], "look_at": [0, 0, 0]}]})")
              .ok());
  REQUIRE(Outcome(complete.dump(1)) == "ok");
  REQUIRE(validator.Validate(complete));

  // No key of the schema is missing from the complete scene, which the reader accepts.
  std::set<const json*> properties;
  CollectProperties(schema, &properties);
  CHECK(properties.size() > 50);
  CHECK(validator.properties_seen() == properties);

  // An include may have all the cameras.
  for (const char* text : {R"({"objects": [{"include": "schema-part.json"}]})",
                           R"({"objects": [{"include": "schema-part.json"}], "cameras": []})"}) {
    CHECK(Outcome(text) == "ok");
    CHECK(validator.Validate(json::parse(text)));
  }
  for (const char* text : {"{}", R"({"cameras": []})", R"({"objects": []})"}) {
    CHECK(Outcome(text) != "ok");
    CHECK(!validator.Validate(json::parse(text)));
  }

  int accepted = 0, refused = 0, beyond = 0;
  for (const json& mutation : Mutations(complete)) {
    const std::string text = mutation.dump(1);
    const std::string outcome = Outcome(text);
    const bool valid = validator.Validate(mutation);
    if (outcome == "ok") {
      ++accepted;
    } else if (valid && IsBeyondSchema(outcome)) {
      ++beyond;
      continue;
    } else {
      ++refused;
    }
    if (valid != (outcome == "ok")) {
      CAPTURE(text);
      CAPTURE(valid);
      CHECK(outcome == "");
    }
  }
  // All three happen often, so the comparison means something.
  CHECK(accepted > 200);
  CHECK(refused > 1000);
  CHECK(beyond > 50);
}

// --- Damage ------------------------------------------------------------------------------------

void CheckDamaged(const std::string& text) {
  const Result<Scene> scene = ParseSceneJson(text, "f");
  if (scene.ok()) return;
  const std::string& message = scene.error().message;
  const bool is_one_line = message.find_first_of("\r\n") == message.npos && message.size() < 1000;
  if (scene.error().kind != ErrorKind::kScene || message.rfind("f:", 0) != 0 || !is_one_line ||
      message.find("json.exception") != message.npos) {
    CAPTURE(text);
    CHECK(message == "");
  }
}

TEST_CASE("a scene cut off anywhere is an error") {
  const std::string text = ReadText(kScenes + "crystal-ball.json");
  const std::size_t end = text.rfind('}');
  for (std::size_t size = 0; size < text.size(); ++size) {
    CheckDamaged(text.substr(0, size));
    if (size <= end) CHECK(!ParseSceneJson(text.substr(0, size), "f").ok());
  }
}

TEST_CASE("a scene with damaged bytes is read or refused in one line") {
  const std::string original = ReadText(kScenes + "crystal-ball.json");
  std::mt19937 random(20240607);
  const std::string likely = "{}[]\",:/*\\-+.0123456789eE\n\r\t \0\x7f\xff\xc2\x85";
  for (int round = 0; round < 20000; ++round) {
    std::string text = original;
    const std::size_t edits = 1 + random() % 3;
    for (std::size_t edit = 0; edit < edits; ++edit) {
      const std::size_t at = random() % text.size();
      const char byte =
          random() % 2 ? static_cast<char>(random() % 256) : likely[random() % likely.size()];
      switch (random() % 3) {
        case 0:
          text[at] = byte;
          break;
        case 1:
          text.insert(at, 1, byte);
          break;
        default:
          text.erase(at, 1 + random() % 4);
      }
    }
    CheckDamaged(text);
  }
}

}  // namespace
}  // namespace sheaf
