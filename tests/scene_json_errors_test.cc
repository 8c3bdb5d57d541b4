// The scene reader: every message, and damaged files.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <random>
#include <string>

#include "scene_text.h"
#include "src/formats/scene_json.h"

namespace sheaf::scene_text {
namespace {

struct Row {
  std::string text;
  std::string message;
};

const Row kMistakes[] = {
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
    {Settings(R"({"depth": 5})"), "f:1: /settings/depth: unknown key; did you mean \"max_depth\"?"},
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
    {Shape("\"disk\":\n{\"radius\": 1}"), "f:1: /objects/0/disk/center: missing key"},
    {Shape(R"("disk": {"center": [0, 0, 0]})"), "f:1: /objects/0/disk/radius: missing key"},
    {Shape("\"disk\": {\"center\": [0, 0, 0],\n\"radius\": -1}"),
     "f:2: /objects/0/disk/radius: expected a number in [0, 1e30], found -1"},
    {Shape("\"disk\": {\"center\": [0, 0, 0], \"radius\": 1,\n\"normal\": [0, 0, 0]}"),
     "f:2: /objects/0/disk/normal: the vector is zero and gives no direction"},
    {Shape(R"("disk": {"center": [0, 0, 0], "radius": 1, "normal": 3})"),
     "f:1: /objects/0/disk/normal: expected [x, y, z], found a number"},
    {Shape(R"("disk": {"center": [0, 0, 0], "radius": 1, "normals": [0, 0, 1]})"),
     "f:1: /objects/0/disk/normals: unknown key; did you mean \"normal\"?"},
    {Shape(R"("name": "x")"),
     "f:1: /objects/0: missing key; give one of \"sphere\", \"disk\", \"quad\", \"triangle\", "
     "\"mesh\", "
     "\"include\""},
    {Shape(R"("quad": {}, "sphere": {"center": [0, 0, 0], "radius": 1})"),
     "f:1: /objects/0/sphere: conflicts with \"quad\"; give one of \"sphere\", \"disk\", "
     "\"quad\", "
     "\"triangle\", \"mesh\", \"include\""},
    {Shape(R"("sphere": {"center": [0, 0, 0], "radius": 1}, "quad": {})"),
     "f:1: /objects/0/quad: conflicts with \"sphere\"; give one of \"sphere\", \"disk\", "
     "\"quad\", "
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
     "f:1: /lights/0: missing key; give one of \"point\", \"spot\", \"directional\", "
     "\"rectangle\", \"disk\", \"sphere\""},
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

TEST_CASE("every mistake is named, with its line and path") {
  for (const Row& row : kMistakes) {
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
}  // namespace sheaf::scene_text
