// What the command says of itself and of mistakes: help, usage errors, bad scenes, machines.
#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "sheaf/version.h"
#include "tests/run_command.h"

namespace sheaf {
namespace {

using nlohmann::json;

constexpr char kTriangle[] = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

TEST_CASE("help and version go to stdout") {
  const Workspace work;
  for (const auto& arguments : std::vector<std::vector<std::string>>{{"--help"},
                                                                     {"-h"},
                                                                     {"render", "--help"},
                                                                     {"compare", "--help"},
                                                                     {"bench", "--help"},
                                                                     {"stress", "--help"},
                                                                     {"pareto", "--help"},
                                                                     {"info", "--help"}}) {
    const Outcome help = work.Run(arguments);
    CHECK(help.code == 0);
    CHECK(help.err.empty());
    CHECK(Contains(help.out, "Examples:"));
    CHECK(Contains(help.out, "Exit codes:"));
  }
  const Outcome options = work.Run({"render", "--help"});
  for (const char* option : {"--camera", "--views", "-o", "--size", "--spp", "--max-depth",
                             "--target", "--precision", "--threads", "--tile", "--tile-size",
                             "--format", "--crop", "--aov", "--progress", "-q", "--json"}) {
    CHECK_MESSAGE(Contains(options.out, option), std::string(option));
  }
  const Outcome version = work.Run({"--version"});
  CHECK(version.code == 0);
  CHECK(version.out == std::string("sheaf ") + kVersion + "\n");
}

TEST_CASE("without arguments the help goes to stderr, and the code is 2") {
  const Outcome nothing = Workspace().Run({});
  CHECK(nothing.code == 2);
  CHECK(nothing.out.empty());
  CHECK(Contains(nothing.err, "Usage:"));
}

struct Mistake {
  std::vector<std::string> arguments;
  std::string says;
};

// One line on stderr, code 2, no file.
void CheckUsageErrors(const Workspace& work, std::span<const Mistake> mistakes) {
  for (const Mistake& wrong : mistakes) {
    const Outcome outcome = work.Run(wrong.arguments);
    CAPTURE(wrong.arguments.back());
    CAPTURE(outcome.err);
    CHECK(outcome.code == 2);
    CHECK(outcome.out.empty());
    CHECK(outcome.err.starts_with("sheaf: "));
    CHECK(LineCount(outcome.err) == 1);
    CHECK(Contains(outcome.err, wrong.says));
  }
  CHECK(work.Files().empty());
}

TEST_CASE("usage errors of render") {
  const Workspace work;
  const std::string png = work / "a.png";
  const Mistake cases[] = {
      {{"render", "--", kScene, "-o", png}, "unknown option \"-o\""},
      {{"render", kScene, "-o", png, "--camera", "up", "--eye", "0,0,9"},
       "\"front\", which is not"},
      {{"render", kScene, "-o", work / "{camera}.png", "--views", "sides", "--fov", "9"},
       "--fov: m"},
      {{"render"}, "SCENE"},
      {{"render", kScene}, "--output"},
      {{"render", kScene, "-o", png, "--siez", "3x3"}, "did you mean \"--size\"?"},
      {{"render", kScene, "-o", png, "other.json"}, "other.json"},
      {{"render", kScene, "-o", work / "a.jpg"}, ".png"},
      {{"render", kScene, "-o", work / "a"}, ".png"},
      {{"render", kScene, "-o", png, "--size", "0x10"}, "--size"},
      {{"render", kScene, "-o", png, "--size", "10x65537"}, "65536"},
      {{"render", kScene, "-o", png, "--size", "10"}, "--size"},
      {{"render", kScene, "-o", png, "--size", "10x10x"}, "--size"},
      {{"render", kScene, "-o", png, "--size", "10x10", "--size", "9x9"}, "--size"},
      {{"render", kScene, "-o", png, "--spp", "0"}, "--spp"},
      {{"render", kScene, "-o", png, "--spp", "1.5"}, "--spp"},
      {{"render", kScene, "-o", png, "--spp", "99999999999"}, "--spp"},
      {{"render", kScene, "-o", png, "--max-depth", "-1"}, "--max-depth"},
      {{"render", kScene, "-o", png, "--threads", "-1"}, "--threads"},
      {{"render", kScene, "-o", png, "--tile-size", "257"}, "--tile-size"},
      {{"render", kScene, "-o", png, "--tile", "32"}, "not a part like 2/8 (--tile-size is"},
      {{"render", kScene, "-o"}, "-o: no value follows (see"},
      {{"render", kScene, "-o", "--spp", "3"}, "-o: no value follows, but the option --spp"},
      {{"render", kScene, "--spp", "-o", png}, "--spp: no value follows, but the option -o"},
      {{"render", kScene, "-o", png, "--size"}, "--size: no value follows (see"},
      {{"merge", "a.png", "-o"}, "-o: no value follows (see sheaf merge"},
      {{"merge", "-o", "--format", "png"}, "-o: no value follows, but the option --format"},
      {{"convert", kScene, "--bits"}, "--bits: no value follows (see sheaf convert"},
      {{"convert", kScene, "--transfer", "-o", png},
       "--transfer: no value follows, but the option"},
      {{"check", kScene, "--cone-sides"}, "--cone-sides: no value follows (see sheaf check"},
      {{"compare", kScene, "--targets"}, "--targets: no value follows (see sheaf compare"},
      {{"compare", "--fail", "--json", "a.png"}, "--fail: no value follows, but the option --json"},
      {{"diff", "a.png", "b.png", "-o"}, "-o: no value follows (see sheaf diff"},
      {{"bench", "--repetitions"}, "--repetitions: no value follows (see sheaf bench"},
      {{"bench", "--kernels", "--targets"}, "--targets: no value follows (see sheaf bench"},
      {{"pareto", "-o"}, "-o: no value follows (see sheaf pareto"},
      {{"stress", "--replay"}, "--replay: no value follows (see sheaf stress"},
      {{"info", "--fov", "--json"}, "--fov: no value follows, but the option --json"},
      {{"render", kScene, "-o", "-"}, "-o /dev/stdout: needs --format"},
      {{"render", kScene, "-o", "-", "--format", "jpg"}, "--format"},
      {{"render", kScene, "-o", "-", "--format", "png", "--json"}, "both to standard output"},
      {{"render", kScene, "-o", work / "a", "--format", "png", "--aov", "depth"},
       "no layers in it"},
      {{"render", kScene, "-o", work / "a", "--format", "png", "--bits", "32"},
       "32 bits a channel"},
      {{"render", kScene, "-o", png, "--crop", "0,0,10"}, "--crop"},
      {{"render", kScene, "-o", png, "--crop", "-1,0,10,10"}, "--crop"},
      {{"render", kScene, "-o", png, "--crop", "5,5,5,9"}, "--crop"},
      {{"render", kScene, "-o", png, "--size", "9x9", "--crop", "0,0,10,9"}, "9x9"},
      {{"render", kScene, "-o", png, "--precision", "quick"}, "strict"},
      {{"render", kScene, "-o", png, "--precision", "fast", "--target", "scalar"}, "SIMD"},
      {{"render", kScene, "-o", png, "--progress", "bar"}, "plain"},
      {{"render", kScene, "-o", png, "--json", "--json"}, "--json"},
      {{"render", kScene, "-o", png, "--target", "scalr"}, "did you mean \"scalar\"?"},
      {{"render", kScene, "-o", png, "--target", ""}, "usable"},
      {{"render", kScene, "-o", png, "--camera", "frnt"},
       "did you mean \"front\"? (the scene has:"},
      {{"render", kScene, "-o", png, "--camera", "front,front"}, "--camera"},
      {{"render", kScene, "-o", png, "--camera", "front,"}, "--camera"},
      {{"render", kScene, "-o", png, "--camera", "front,up"}, "{camera}"},
      {{"render", kScene, "-o", png, "--views", "sevn"}, "did you mean \"seven\"?"},
      {{"render", kScene, "-o", png, "--views", "seven"}, "{camera}"},
      {{"render", kScene, "-o", work / "{camera}.png", "--views", "seven", "--camera", "up"},
       "--views"},
      {{"render", kScene, "-o", ""}, "--output: the path is empty"},
      {{"render", kScene, "-o", png, "--json="}, "--json=: nothing follows"},
  };
  CheckUsageErrors(work, cases);
}

TEST_CASE("usage errors of the other commands") {
  const Workspace work;
  const std::string png = work / "a.png";
  const Mistake cases[] = {
      {{"rendr"}, "did you mean \"render\"?"},
      {{"help"}, "did you mean \"--help\"?"},
      {{"version"}, "did you mean \"--version\"?"},
      {{"convert", kScene, "-o", work / "a.json", "--bits", "16"}, "--bits: for pictures"},
      {{"convert", kScene, "-o", work / "a.json", "--transfer", "keep"}, "--transfer: for pict"},
      {{"convert", work / "b.pfm", "-o", png, "--eye", "1,2,3"}, "--eye: for scenes"},
      {{"compare", kScene, "--camera", "up", "--look-at", "0,0,9"}, "--look-at: moves"},
      {{"info", kScene, "extra"}, "extra"},
      {{"bench", kScene, "--baseline", ""}, "--baseline: the path is empty"},
      {{"bench", kScene, "--json="}, "--json=: nothing follows"},
      {{"bench", kScene, "--targets", "foo"},
       "--targets: unknown target \"foo\" (usable: all, auto"},
      {{"bench", kScene, "--targets", "auto,all"}, "is there twice"},
      {{"compare", png, png, "--camera", "up"}, "--camera: only where a scene's renderings are"},
      {{"compare", png, png, "--max-ulp", "1"}, "--max-ulp"},
      {{"compare", png, png, "--fov", "30"}, "--fov"},
      {{"compare", kScene, "--fail", "rmse=1"}, "--fail: only where pictures are compared"},
      {{"compare", kScene, "--precision", "fast"}, "by design"},
      {{"pareto", kScene, "-o", ""}, "--output: the path is empty"},
      {{"pareto", kScene, "-o", work / "r", "--reference-spp", "64"}, "above the 64 samples"},
      {{"stress", "on-sphere", "--replay", ""}, "ox,oy,oz"},
      {{"stress", "on-sphere", "--replay", "1,2,3"}, "ox,oy,oz"},
      {{"stress", "clear-glass", "--replay", "0,0,3,0,0,-1,0,1,0"}, "traces no single rays"},
  };
  CheckUsageErrors(work, cases);
}

TEST_CASE("an unknown target lists every usable one") {
  const Workspace work;
  const json targets = json::parse(work.Run({"info", "--json"}).out)["targets"];
  const Outcome outcome = work.Render({"-o", work / "a.png", "--target", "mmx"});
  CHECK(outcome.code == 2);
  for (const std::string name : targets["usable"]) CHECK(Contains(outcome.err, name));
  CHECK(Contains(outcome.err, "auto, scalar"));
}

TEST_CASE("what others call a target leads to its name here") {
  const Workspace work;
  const json targets = json::parse(work.Run({"info", "--json"}).out)["targets"];
  const std::vector<std::string> compiled = targets["compiled"];
  if (std::find(compiled.begin(), compiled.end(), "avx3") == compiled.end()) {
    MESSAGE("skipped: no target of this build has AVX-512");
    return;
  }
  const std::string says = "unknown target \"avx512\"; AVX-512 is called \"avx3\" here";
  CHECK(Contains(work.Render({"-o", work / "a.png", "--target", "avx512"}).err, says));
  CHECK(Contains(work.Run({"bench", kScene, "--targets", "scalar,avx512"}).err, says));
}

TEST_CASE("a file of another kind is named as such, with the endings of scenes") {
  const Workspace work;
  WriteText(work / "a.stl", "solid\n");
  const Outcome unknown = work.Run({"check", work / "a.stl"});
  CHECK(unknown.code == 3);
  CHECK(Contains(unknown.err, "a.stl: of no known format; a scene's name ends in .json, .nff, "));
  CHECK(work.Render({"-q", "-o", work / "a.png"}).code == 0);
  CHECK(Contains(work.Run({"info", work / "a.png"}).err, "a.png: a picture; a scene's name ends"));
  // Scene JSON may have any name.
  WriteText(work / "scene", "\xEF\xBB\xBF // A scene\n" + ReadText(kScene));
  CHECK(work.Run({"check", work / "scene"}).code == 0);
}

TEST_CASE("a bad scene: its own line, code 3") {
  const Workspace work;
  WriteText(work / "bad.json", "this is no JSON\n");
  for (const auto& arguments : std::vector<std::vector<std::string>>{
           {"render", work / "bad.json", "-o", work / "a.png"}, {"info", work / "bad.json"}}) {
    const Outcome outcome = work.Run(arguments);
    CHECK(outcome.code == 3);
    CHECK(outcome.out.empty());
    CHECK(LineCount(outcome.err) == 1);
    CHECK(outcome.err.starts_with((work / "bad.json") + ":1"));
  }
  // What is wrong with the command line comes first.
  CHECK(work.Run({"render", work / "bad.json", "-o", work / "a.jpg"}).code == 2);
  CHECK(work.Run({"render", work / "bad.json", "-o", work / "a.png", "--target", "mmx"}).code == 2);
  CHECK(work.Files() == std::vector<std::string>{"bad.json"});
}

TEST_CASE("what cannot be read or written is code 4, before rendering") {
  const Workspace work;
  const std::string png = work / "a.png";
  for (const auto& arguments : std::vector<std::vector<std::string>>{
           {"render", work / "absent.json", "-o", png},
           {"info", work / "absent.json"},
           {"render", kScene, "-o", work / "absent/a.png"},
           {"render", kScene, "-o", work / "{camera}/a.png"},
           {"render", kScene, "-o", png, "--json=" + (work / "absent/a.json")}}) {
    const Outcome outcome = work.Run(arguments);
    CAPTURE(outcome.err);
    CHECK(outcome.code == 4);
    CHECK(outcome.out.empty());
    CHECK(LineCount(outcome.err) == 1);  // so no frame was begun
  }
  CHECK(work.Files().empty());
}

TEST_CASE("check reads every scene, and says what it would skip") {
  const Workspace work;
  WriteText(work / "bad.obj", "v 0 0\n");
  const Outcome outcome = work.Run({"check", work / "bad.obj", kScene});
  CHECK(outcome.code == 3);
  CHECK(LineCount(outcome.err) == 1);
  CHECK(Contains(outcome.out, "crystal-ball.json: sound: 3 objects"));
  CHECK(Contains(outcome.out, "skipped: "));
  const Outcome listed = work.Run({"check", kScene, "--json"});
  CHECK(listed.code == 0);
  CHECK(json::parse(listed.out)[0]["triangles"] == 2);
}

TEST_CASE("check lists bad scenes too, and the first decides the code") {
  const Workspace work;
  WriteText(work / "bad.obj", "v 0 0\n");
  const Outcome outcome =
      work.Run({"check", kScene, work / "bad.obj", work / "absent.obj", "--json"});
  CHECK(outcome.code == 3);
  CHECK(LineCount(outcome.err) == 2);
  const json scenes = json::parse(outcome.out);
  REQUIRE(scenes.size() == 3);
  CHECK(!scenes[0].contains("error"));
  CHECK(scenes[1] ==
        json{{"path", work / "bad.obj"}, {"error", (work / "bad.obj") + ":1: 2 numbers of 3"}});
  CHECK(scenes[2]["path"] == work / "absent.obj");
  CHECK(work.Run({"check", work / "absent.obj", work / "bad.obj"}).code == 4);

  WriteText(work / "e\x1b[31m.obj", kTriangle);
  const Outcome odd = work.Run({"check", work / "e\x1b[31m.obj"});
  CHECK(
      Contains(odd.out, "e\\u001B[31m.obj: sound: 1 object, 0 spheres, 1 triangle, 3 lights, 1 "));
}

TEST_CASE("what is lost is said once a kind, and is an error with --strict") {
  const Workspace work;
  WriteText(work / "a.mtl", "newmtl red\nKd 1 0 0\n");
  const std::string path = work / "a.obj";
  WriteText(path,
            "mtllib a.mtl\nmtllib b.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl x\nf 1 2 3\n"
            "usemtl y\nf 1 2 3\nusemtl red\nf 1 2 3\n");
  const Outcome listed = work.Run({"check", path});
  CHECK(listed.code == 0);
  CHECK(Contains(listed.out, "a.obj: sound: "));
  CHECK(Contains(listed.out, "b.mtl: cannot open"));
  CHECK(Contains(listed.out,
                 "warning: " + path + ":6: usemtl: no material \"x\", so grey (2 in all)\n"));
  CHECK(LineCount(listed.out) == 4);  // with what is skipped

  const Outcome strict = work.Run({"check", path, kScene, "--strict", "--json"});
  CHECK(strict.code == 3);
  CHECK(strict.err == path + ": 2 warnings, which --strict takes for errors\n");
  const json scenes = json::parse(strict.out);
  REQUIRE(scenes.size() == 2);
  CHECK(scenes[0]["warnings"].size() == 2);
  CHECK(scenes[0].contains("error"));
  CHECK(!scenes[1].contains("error"));
  CHECK(Contains(work.Run({"check", path, "--strict"}).out, "a.obj: not sound: "));

  const Outcome rendered =
      work.Run({"render", path, "--size", "8x8", "-q", "--strict", "-o", work / "a.png"});
  CHECK(rendered.code == 3);
  CHECK(LineCount(rendered.err) == 3);
  CHECK(!std::filesystem::exists(work / "a.png"));
  CHECK(work.Run({"render", path, "--size", "8x8", "-q", "-o", work / "a.png"}).code == 0);
  CHECK(
      work.Run({"render", kScene, "--size", "8x8", "-q", "--strict", "-o", work / "b.png"}).code ==
      0);
}

TEST_CASE("check, info and the statistics of a frame count disks") {
  const Workspace work;
  const std::string path = work / "disks.json";
  WriteText(path, R"({"materials": [{"name": "m"}], "objects": [
      {"disk": {"center": [0, 0, -3], "radius": 1}, "material": "m"},
      {"disk": {"center": [0, 0, -4], "radius": 2}, "material": "m"},
      {"sphere": {"center": [0, 0, -5], "radius": 1}, "material": "m"}],
    "cameras": [{"name": "c", "eye": [0, 0, 0], "look_at": [0, 0, -1]}]})");
  CHECK(Contains(work.Run({"check", path}).out, "3 objects, 1 sphere, 0 triangles, 2 disks, "));
  CHECK(json::parse(work.Run({"check", path, "--json"}).out)[0]["disks"] == 2);
  CHECK(json::parse(work.Run({"check", kScene, "--json"}).out)[0]["disks"] == 0);
  const json scene = json::parse(work.Run({"info", path, "--json"}).out)["scene"];
  CHECK(scene["counts"]["disks"] == 2);
  CHECK(scene["features"][1] == "disks");  // after the spheres, for want of triangles
  CHECK(Contains(work.Run({"info", path}).out, "triangles 0, disks 2, "));
  const Outcome frame =
      work.Run({"render", path, "-q", "--size", "8x8", "-o", work / "a.png", "--json"});
  const json primitives = json::parse(frame.out)["frames"][0]["primitives"];
  CHECK(primitives == json{{"total", 3}, {"spheres", 1}, {"triangles", 0}, {"disks", 2}});
}

TEST_CASE("info: the machine, and a scene") {
  const Workspace work;
  const Outcome text = work.Run({"info"});
  CHECK(text.code == 0);
  CHECK(text.err.empty());
  const json machine = json::parse(work.Run({"info", "--json"}).out);
  CHECK(!machine.contains("scene"));
  CHECK(machine["targets"]["chosen"] == machine["targets"]["usable"][0]);
  CHECK(machine["targets"]["lanes"].get<int>() >= 1);
  CHECK(Contains(text.out, machine["targets"]["chosen"]));
  CHECK(Contains(text.out, kVersion));
  // A build that says that it has OpenEXR writes .exr, and no other build does.
  const bool has_openexr = machine["parts"]["OpenEXR"];
  CHECK(Contains(text.out, has_openexr ? "built in    OpenEXR" : "missing     OpenEXR"));
  CHECK((work.Render({"-q", "-o", work / "a.exr"}).code == 0) == has_openexr);

  const json scene = json::parse(work.Run({"info", kScene, "--json"}).out)["scene"];
  CHECK(scene["counts"]["spheres"] == 2);
  CHECK(scene["counts"]["triangles"] == 2);
  CHECK(scene["counts"]["lights"] == 3);
  CHECK(scene["counts"]["cameras"] == 7);
  CHECK(scene["bounds"]["min"] == json({-5.0, -3.0, -16.0}));
  CHECK(scene["bounds"]["max"] == json({5.0, 2.0, -6.0}));
  CHECK(scene["views"][0]["name"] == "seven");
  const std::vector<std::string> features = scene["features"], skipped = scene["skipped"];
  const auto lists = [](const std::vector<std::string>& names, const char* name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  for (const char* name : {"checker textures", "shadows", "refraction and Fresnel reflection"}) {
    CHECK_MESSAGE(lists(features, name), std::string(name));
  }
  CHECK(lists(skipped, "directional lights"));
  CHECK(lists(skipped, "mirror reflection"));
  const Outcome described = work.Run({"info", kScene});
  CHECK(described.code == 0);
  CHECK(Contains(described.out, "seven: front, up, down, left, right, near, far"));
}

}  // namespace
}  // namespace sheaf
