// `sheaf render`: cameras, parts, layers, models, statistics.
#include <doctest/doctest.h>

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "sheaf/version.h"
#include "src/formats/pfm.h"
#include "src/formats/png.h"
#include "tests/run_command.h"

namespace sheaf {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr char kTriangle[] = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

TEST_CASE("one picture: by default the scene's first camera") {
  const Workspace work;
  const Outcome outcome = work.Render({"-o", work / "a.png"});
  CHECK(outcome.code == 0);
  CHECK(outcome.out.empty());
  CHECK(Contains(outcome.err, "wrote " + (work / "a.png") + "\n"));
  CHECK(work.Files() == std::vector<std::string>{"a.png"});
  const Result<Picture8> picture = ReadPng(work / "a.png");
  REQUIRE(picture.ok());
  CHECK(picture.value().width == 32);
  CHECK(picture.value().height == 24);

  const json info = json::parse(work.Run({"info", kScene, "--json"}).out);
  const std::string first = info["scene"]["cameras"][0]["name"];
  CHECK(work.Render({"-o", work / "b.png", "--camera", first}).code == 0);
  CHECK(ReadText(work / "a.png") == ReadText(work / "b.png"));
}

TEST_CASE("a crop's picture holds the crop") {
  const Workspace work;
  CHECK(work.Render({"-o", work / "whole.pfm"}).code == 0);
  CHECK(work.Render({"-o", work / "crop.pfm", "--crop", "5,7,20,24"}).code == 0);
  const Result<Film> whole = ReadPfm(work / "whole.pfm"), crop = ReadPfm(work / "crop.pfm");
  REQUIRE(whole.ok());
  REQUIRE(crop.ok());
  REQUIRE(crop.value().width == 15);
  REQUIRE(crop.value().height == 17);
  int different = 0;
  for (int y = 0; y < 17; ++y) {
    for (int x = 0; x < 15; ++x) {
      const float* expected = whole.value().pixel(x + 5, y + 7);
      if (!std::equal(expected, expected + 3, crop.value().pixel(x, y))) ++different;
    }
  }
  CHECK(different == 0);
}

TEST_CASE("several cameras: a picture each, {camera} wherever it stands") {
  const Workspace work;
  const Outcome two = work.Render({"--camera", "up,front", "-o", work / "{camera}-{camera}.png"});
  CHECK(two.code == 0);
  CHECK(work.Files() == std::vector<std::string>{"front-front.png", "up-up.png"});
  CHECK(two.err.find("up-up.png") < two.err.find("front-front.png"));

  fs::create_directory(work / "near");
  CHECK(work.Render({"--camera", "near", "-o", work / "{camera}/a.png"}).code == 0);
  CHECK(fs::exists(work / "near/a.png"));

  CHECK(work.Render({"--views", "seven", "-q", "-o", work / "{camera}.png"}).code == 0);
  for (const char* name : {"front", "up", "down", "left", "right", "near", "far"}) {
    CHECK_MESSAGE(fs::exists(work / (std::string(name) + ".png")), std::string(name));
  }
}

TEST_CASE("the target that ran is the one that was asked for") {
  const Workspace work;
  std::vector<std::string> targets =
      json::parse(work.Run({"info", "--json"}).out)["targets"]["usable"];
  REQUIRE(!targets.empty());
  const std::string best = targets.front();
  CHECK(targets.back() == "scalar");
  for (const std::string& target : targets) {
    const Outcome outcome = work.Render({"-q", "--json", "--target", target, "-o", work / "a.png"});
    REQUIRE(outcome.code == 0);
    CHECK(json::parse(outcome.out)["frames"][0]["target"] == target);
  }
  const Outcome automatic = work.Render({"-q", "--json", "-o", work / "a.png"});
  CHECK(json::parse(automatic.out)["frames"][0]["target"] == best);
}

TEST_CASE("statistics on stdout are one JSON object") {
  const Workspace work;
  const Outcome outcome = work.Render({"--camera", "front,near", "--spp", "2", "--threads", "1",
                                       "--json", "-o", work / "{camera}.png"});
  REQUIRE(outcome.code == 0);
  const json statistics = json::parse(outcome.out);
  CHECK(statistics["sheaf"] == kVersion);
  CHECK(statistics["scene"] == kScene);
  REQUIRE(statistics["frames"].size() == 2);
  for (const json& frame : statistics["frames"]) {
    const json& rays = frame["rays"];
    CHECK(frame["picture"] == work / (frame["camera"].get<std::string>() + ".png"));
    CHECK(frame["width"] == 32);
    CHECK(frame["height"] == 24);
    CHECK(frame["samples"] == 2);
    CHECK(frame["threads"] == 1);
    CHECK(frame["precision"] == "strict");
    CHECK(!frame.contains("crop"));
    CHECK(rays["primary"] == 32 * 24 * 2);
    CHECK(rays["traced"].get<std::uint64_t>() ==
          rays["primary"].get<std::uint64_t>() + rays["shadow"].get<std::uint64_t>() +
              rays["reflected"].get<std::uint64_t>() + rays["refracted"].get<std::uint64_t>() -
              rays["beyond_depth"].get<std::uint64_t>());
    CHECK(frame["seconds"]["wall"].get<double>() > 0.0);
    CHECK(frame["seconds"]["phases"].contains("trace"));
    CHECK(frame["rays_per_second"].get<double>() > 0.0);
    CHECK(frame["primitives"]["total"] ==
          frame["primitives"]["spheres"].get<int>() + frame["primitives"]["triangles"].get<int>());
  }
}

TEST_CASE("--json=FILE writes the file and swallows no other argument") {
  const Workspace work;
  const Outcome outcome = work.Run({"render", "--json=" + (work / "a.json"), kScene, "--size",
                                    "32x24", "--crop", "1,2,3,4", "-o", work / "a.png"});
  CHECK(outcome.code == 0);
  CHECK(outcome.out.empty());
  const json statistics = json::parse(ReadText(work / "a.json"));
  CHECK(statistics["frames"][0]["crop"] == json({1, 2, 3, 4}));
  CHECK(work.Run({"render", "--json", kScene, "--size", "32x24", "-o", work / "a.png"}).code == 0);
}

TEST_CASE("stderr: plain lines, only the written files, or nothing") {
  const Workspace work;
  const std::string wrote = "wrote " + (work / "a.png") + "\n";
  const Outcome plain = work.Render({"-o", work / "a.png"});  // stderr is no terminal
  CHECK(LineCount(plain.err) == 3);
  CHECK(plain.err.starts_with("front: rendering 32x24"));
  CHECK(Contains(plain.err, "million rays/s"));
  CHECK(!Contains(plain.err, "\x1b"));
  CHECK(plain.err.ends_with(wrote));
  CHECK(work.Render({"-o", work / "a.png", "--progress", "none"}).err == wrote);
  CHECK(work.Render({"-o", work / "a.png", "-q"}).err.empty());
  CHECK(work.Render({"-o", work / "a.png", "-q", "--progress", "plain"}).err.empty());
}

TEST_CASE("a picture that shows nothing says why") {
  const Workspace work;
  const std::string path = work / "dark.json";
  const auto err = [&](const std::string& eye, const std::string& rest) {
    WriteText(path, R"({"materials": [{"name": "m", "base_colour": [0.5, 0.5, 0.5], "kd": 1}],
        "objects": [{"name": "ball", "sphere": {"center": [0, 0, -5], "radius": 1}, "material": "m"}],
        "cameras": [{"name": "c", "look_at": [0, 0, -9], "eye": )" +
                        eye + "}]" + rest + "}");
    const Outcome outcome =
        work.Run({"render", path, "-o", work / "a.png", "--size", "32x24", "--progress", "none"});
    CHECK(outcome.code == 0);
    return outcome.err;
  };
  const auto light = [](const std::string& intensity) {
    return R"(, "lights": [{"name": "l", "point": {"position": [0, 0, 0]}, "intensity": )" +
           intensity + "}]";
  };
  CHECK(Contains(err("[0, 0, 0]", ""), "nothing lights the scene"));
  CHECK(Contains(err("[0, 0, -5]", light("9")), "\"c\" lies inside object 0 \"ball\""));
  CHECK(Contains(err("[0, 0, -7]", light("9")), "nothing is in view of the camera \"c\""));
  CHECK(Contains(err("[0, 0, 0]", light("1e-9")), "the picture is black: its largest value is "));
  CHECK(!Contains(err("[0, 0, 0]", light("9")), "warning"));
  // A part may be empty, and -q says nothing.
  err("[0, 0, -7]", light("9"));
  CHECK(work.Run({"render", path, "-o", work / "a.png", "-q"}).err.empty());
  CHECK(!Contains(work.Run({"render", path, "-o", work / "a.png", "--tile", "1/2"}).err, "warn"));
}

TEST_CASE("colours that look like bytes are asked about") {
  const Workspace work;
  const std::string path = work / "bytes.json";
  const auto check = [&](const std::string& colour) {
    WriteText(path, R"({"materials": [{"name": "m", "kd": 1, "base_colour": )" + colour + R"(}],
        "objects": [{"sphere": {"center": [0, 0, -5], "radius": 1}, "material": "m"}],
        "cameras": [{"name": "c", "eye": [0, 0, 0], "look_at": [0, 0, -1]}],
        "lights": [{"name": "l", "point": {"position": [0, 0, 0]}, "intensity": 9}]})");
    return work.Run({"check", path}).out;
  };
  CHECK(Contains(check("[255, 128, 0]"),
                 "material \"m\": is the colour 255, 128, 0 meant in 0 to 255? 1 is white here"));
  CHECK(!Contains(check("[1, 1, 0]"), "warning"));
  CHECK(!Contains(check("[2.5, 0.5, 0]"), "warning"));
}

TEST_CASE("layers lie beside a picture, or in it") {
  const Workspace work;
  const std::vector<std::string> layers = {"--aov", "depth,normal,albedo,id,heat", "-q", "--size",
                                           "32x24"};
  for (const char* name : {"a.png", "b.exr"}) {
    std::vector<std::string> arguments = {"render", kScene, "-o", work / name};
    arguments.insert(arguments.end(), layers.begin(), layers.end());
    REQUIRE(work.Run(arguments).code == 0);
  }
  CHECK(work.Files() == std::vector<std::string>{"a.albedo.png", "a.depth.png", "a.heat.png",
                                                 "a.id.png", "a.normal.png", "a.png", "b.exr"});
  CHECK(work.Run({"render", kScene, "-o", work / "c.png", "--aov", "depth,width"}).code == 2);
}

TEST_CASE("--aov heat shows rays and lanes of each tile") {
  const Workspace work;
  const std::string pfm = work / "a.pfm";
  const std::vector<std::string> render = {"render", kScene,  "--size", "50x40", "--tile-size",
                                           "16",     "--aov", "heat",   "-q"};
  auto arguments = render;
  arguments.insert(arguments.end(), {"--crop", "7,3,50,40", "-o", pfm, "--json"});
  const Outcome outcome = work.Run(arguments);
  REQUIRE(outcome.code == 0);
  CHECK(work.Files() == std::vector<std::string>{"a.heat.pfm", "a.pfm"});
  const Result<Film> heat = ReadPfm(work / "a.heat.pfm");
  REQUIRE(heat.ok());
  REQUIRE(heat.value().width == 43);
  REQUIRE(heat.value().height == 37);
  double rays = 0;
  for (std::size_t i = 0; i < heat.value().rgb.size(); i += 3) {
    const float* pixel = &heat.value().rgb[i];
    CHECK(pixel[0] > 0);
    CHECK(pixel[1] > 0);
    CHECK(pixel[1] <= 1);
    rays += static_cast<double>(pixel[2]);
  }
  // Each pixel has its tile's mean, so that the sum is the frame's count.
  const json statistics = json::parse(outcome.out);
  CHECK(rays == doctest::Approx(statistics["frames"][0]["rays"]["traced"].get<double>()));

  arguments = render;
  arguments.insert(arguments.end(), {"-o", work / "a.png", "--json=" + (work / "a.heat.png")});
  const Outcome clash = work.Run(arguments);
  CHECK(clash.code == 2);
  CHECK(Contains(clash.err, "same path"));
}

TEST_CASE("a model alone renders, from where the command line says") {
  const Workspace work;
  WriteText(work / "a.obj", kTriangle);
  const auto render = [&](std::vector<std::string> more) {
    std::vector<std::string> arguments = {"render", work / "a.obj", "-o",   work / "a.pfm",
                                          "-q",     "--size",       "40x30"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = work.Run(arguments);
    CAPTURE(outcome.err);
    REQUIRE(outcome.code == 0);
    return ReadText(work / "a.pfm");
  };
  const std::string usual = render({});
  const std::string moved = render({"--eye", "0,0,3", "--look-at", "0,0,0", "--fov", "20"});
  CHECK(usual != moved);
  CHECK(work.Run({"render", work / "a.obj", "-o", work / "a.pfm", "--eye", "1,2"}).code == 2);
  CHECK(work.Run({"render", work / "a.obj", "-o", work / "a.pfm", "--eye", "0,0,0", "--look-at",
                  "0,0,0"})
            .code == 2);
}

TEST_CASE("--fov is not for an orthographic camera") {
  const Workspace work;
  WriteText(work / "a.json", R"({"cameras": [
      {"name": "flat", "eye": [0, 0, 5], "look_at": [0, 0, 0], "orthographic": {"height": 3}}]})");
  const Outcome outcome =
      work.Run({"render", work / "a.json", "-o", work / "a.png", "--fov", "40"});
  CHECK(outcome.code == 2);
  CHECK(outcome.err == "sheaf: --fov: the scene's first camera, \"flat\", is orthographic\n");
}

TEST_CASE("a bad model is one line and code 3, and leaves no picture") {
  const Workspace work;
  WriteText(work / "a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n# its only face\nf 1 2 9\n");
  const Outcome outcome = work.Run({"render", work / "a.obj", "-o", work / "a.png"});
  CHECK(outcome.code == 3);
  CHECK(outcome.err == (work / "a.obj") + ":5: vertex 9 of 3\n");
  CHECK(work.Files() == std::vector<std::string>{"a.obj"});
}

TEST_CASE("files outside the scene's folder need --allow-outside") {
  const Workspace work;
  WriteText(work / "a.obj", kTriangle);
  fs::create_directory(work / "in");
  WriteText(work / "in/a.json",
            R"({"objects": [{"mesh": "../a.obj"}],
                "cameras": [{"name": "c", "eye": [0, 0, 5], "look_at": [0, 0, 0]}]})");
  const Outcome refused = work.Run({"check", work / "in/a.json"});
  CHECK(refused.code == 3);
  CHECK(Contains(refused.err, ":1: /objects/0/mesh: ../a.obj: lies outside the scene's folder"));
  CHECK(work.Run({"check", work / "in/a.json", "--allow-outside"}).code == 0);
}

}  // namespace
}  // namespace sheaf
