// `sheaf render --frames`: sequences, turntables, cameras on paths.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "model_files.h"
#include "tests/run_command.h"

namespace sheaf {
namespace {

constexpr char kMoving[] = R"({
  "settings": {"size": [32, 24], "background": [0.1, 0.2, 0.3]},
  "materials": [{"name": "m", "base_colour": [0.9, 0.5, 0.2], "kd": 1}],
  "objects": [{"sphere": {"center": [0, 0, 0], "radius": 1}, "material": "m"},
              {"disk": {"center": [1, 1, 0], "radius": 1}, "material": "m"}],
  "lights": [{"name": "l", "point": {"position": [5, 5, 5]}, "intensity": 60}],
  "cameras": [{"name": "still", "eye": [0, 1, 5], "look_at": [0, 0, 0]},
              {"name": "fly", "eye": [0, 1, 5], "look_at": [0, 0, 0],
               "path": [{"frame": 0}, {"frame": 4, "eye": [5, 1, 0], "fov_y": 40},
                        {"frame": 8, "eye": [0, 2, -5]}]}]})";

// A square that slides and turns, without a camera and lights of its own.
std::string MovingGltf() {
  json gltf = SquareGltf();
  gltf["nodes"] = {{{"mesh", 0}}};
  gltf["scenes"] = {{{"nodes", {0}}}};
  const int input = AddFloats(gltf, {0, 1}, "SCALAR", 2);
  gltf["accessors"][static_cast<std::size_t>(input)]["max"] = {1};
  const int output = AddFloats(gltf, {0, 0, 0, 0.5f, 0.25f, 0}, "VEC3", 2);
  gltf["animations"] = {
      {{"samplers", {{{"input", input}, {"output", output}}}},
       {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}}}};
  return gltf.dump();
}

TEST_CASE("each frame is the picture of a run that renders it alone") {
  const Workspace work;
  WriteText(work / "s.json", kMoving);
  WriteText(work / "m.gltf", MovingGltf());
  struct Sequence {
    std::string scene;
    std::vector<std::string> options;
  };
  const std::vector<Sequence> sequences = {{"s.json", {"--camera", "fly"}},
                                           {"s.json", {"--turntable", "6", "--spp", "2"}},
                                           {"m.gltf", {"--fps", "4"}},
                                           {"m.gltf", {"--fps", "4", "--turntable", "5"}}};
  for (const auto& [scene, options] : sequences) {
    std::vector<std::string> all = {"render", work / scene, "--size",
                                    "32x24",  "-q",         "--frames",
                                    "0..3",   "-o",         work / "f{frame:3}.png"};
    all.insert(all.end(), options.begin(), options.end());
    REQUIRE(work.Run(all).code == 0);
    std::string before;
    for (int frame = 0; frame < 4; ++frame) {
      std::vector<std::string> one = {"render",
                                      work / scene,
                                      "--size",
                                      "32x24",
                                      "-q",
                                      "--frames",
                                      std::to_string(frame),
                                      "-o",
                                      work / "one.png",
                                      "--threads",
                                      "1",
                                      "--target",
                                      "scalar"};
      one.insert(one.end(), options.begin(), options.end());
      REQUIRE(work.Run(one).code == 0);
      const std::string picture = ReadText(work / fmt::format("f{:03}.png", frame));
      CHECK(picture == ReadText(work / "one.png"));
      CHECK(picture != before);
      before = picture;
    }
  }
}

TEST_CASE("a sequence keeps the exposure that is metered at its frame 0") {
  const Workspace work;
  // The camera flies to the dark side, until it sees the ball alone.
  json scene = json::parse(kMoving);
  scene["settings"]["background"] = {0, 0, 0};
  scene["lights"][0]["point"]["position"] = {0, 1, 9};
  scene["lights"][0]["intensity"] = 900;
  scene["cameras"][1]["path"][2]["eye"] = {3, 1, -3};
  WriteText(work / "s.json", scene.dump());
  const auto render = [&](std::vector<std::string> options) {
    options.insert(options.begin(), {"render", work / "s.json", "--camera", "fly", "-q"});
    REQUIRE(work.Run(options).code == 0);
  };
  // Frame 0 as `--exposure auto` has it tells by how many stops.
  render({"--frames", "0", "--exposure", "auto", "-o", work / "auto0.png"});
  std::string stops;
  for (int thirds = -30; thirds <= 30 && stops.empty(); ++thirds) {
    const std::string ev = fmt::format("{}", thirds / 3.0);
    render({"--frames", "0", "--exposure", ev, "-o", work / "ev0.png"});
    if (ReadText(work / "ev0.png") == ReadText(work / "auto0.png")) stops = ev;
  }
  REQUIRE(!stops.empty());
  render({"--frames", "7", "--exposure", stops, "-o", work / "ev7.png"});
  render({"--time", fmt::format("{}", 7 / 24.0), "--exposure", "auto", "-o", work / "alone7.png"});
  REQUIRE(ReadText(work / "alone7.png") != ReadText(work / "ev7.png"));
  render({"--frames", "5..7", "--exposure", "auto", "-o", work / "auto{frame}.png"});
  CHECK(ReadText(work / "auto7.png") == ReadText(work / "ev7.png"));
  render({"--frames", "0..7", "--exposure", "auto", "-o", work / "all{frame}.png"});
  CHECK(ReadText(work / "all7.png") == ReadText(work / "ev7.png"));
}

TEST_CASE("frame 0 of a turntable is the picture without one, and so is frame N") {
  const Workspace work;
  WriteText(work / "s.json", kMoving);
  const auto render = [&](std::vector<std::string> options) {
    options.insert(options.begin(), {"render", work / "s.json", "-q"});
    REQUIRE(work.Run(options).code == 0);
  };
  render({"-o", work / "plain.png"});
  render({"--turntable", "3", "-o", work / "t{frame}.png"});
  render({"--turntable", "3", "--frames", "3", "-o", work / "whole.png"});
  CHECK(work.Files() ==
        std::vector<std::string>{"plain.png", "s.json", "t0.png", "t1.png", "t2.png", "whole.png"});
  CHECK(ReadText(work / "t0.png") == ReadText(work / "plain.png"));
  CHECK(ReadText(work / "whole.png") == ReadText(work / "plain.png"));
  CHECK(ReadText(work / "t1.png") != ReadText(work / "plain.png"));
}

TEST_CASE("--time is the moment of a frame, and convert keeps a path") {
  const Workspace work;
  WriteText(work / "s.json", kMoving);
  WriteText(work / "m.gltf", MovingGltf());
  const auto render = [&](const std::string& scene, std::vector<std::string> options) {
    options.insert(options.begin(),
                   {"render", work / scene, "-q", "--size", "32x24", "-o", work / "a.pfm"});
    const Outcome outcome = work.Run(options);
    CAPTURE(outcome.err);
    REQUIRE(outcome.code == 0);
    return ReadText(work / "a.pfm");
  };
  const std::string frame = render("m.gltf", {"--frames", "12"});
  CHECK(frame == render("m.gltf", {"--time", "0.5"}));
  CHECK(frame != render("m.gltf", {}));
  CHECK(render("s.json", {"--camera", "fly", "--time", "0.125"}) ==
        render("s.json", {"--camera", "fly", "--frames", "3"}));
  REQUIRE(work.Run({"convert", work / "s.json", "-o", work / "c.json"}).code == 0);
  CHECK(render("s.json", {"--camera", "fly", "--frames", "3"}) ==
        render("c.json", {"--camera", "fly", "--frames", "3"}));
  REQUIRE(work.Run({"convert", work / "m.gltf", "--time", "0.5", "-o", work / "d.json"}).code == 0);
  CHECK(render("m.gltf", {"--time", "0.5"}) == render("d.json", {}));
}

TEST_CASE("a sequence's statistics, progress and warnings") {
  const Workspace work;
  WriteText(work / "s.json", kMoving);
  const Outcome moving = work.Run({"render", work / "s.json", "--camera", "still,fly", "--frames",
                                   "2..4", "--json", "-o", work / "{camera}-{frame}.png"});
  REQUIRE(moving.code == 0);
  const json statistics = json::parse(moving.out);
  REQUIRE(statistics["frames"].size() == 6);
  CHECK(statistics["frames"][3]["frame"] == 3);
  CHECK(statistics["frames"][3]["camera"] == "fly");
  CHECK(statistics["frames"][3]["picture"] == work / "fly-3.png");
  CHECK(Contains(moving.err, "still, frame 2, 1/6: rendering 32x24"));
  CHECK(Contains(moving.err, "fly, frame 4, 6/6, 0:00 left: rendering"));
  CHECK(!Contains(moving.err, "nothing moves"));
  const Outcome still =
      work.Run({"render", work / "s.json", "--frames", "2..4", "-o", work / "a{frame}.png"});
  CHECK(still.code == 0);
  CHECK(Contains(still.err, "nothing moves"));
}

TEST_CASE("what is wrong with the options of a sequence costs no rendering") {
  const Workspace work;
  WriteText(work / "s.json", kMoving);
  const auto refused = [&](std::vector<std::string> options, const std::string& part) {
    options.insert(options.begin(), {"render", work / "s.json"});
    const Outcome outcome = work.Run(options);
    CAPTURE(outcome.err);
    CHECK(outcome.code == 2);
    CHECK(LineCount(outcome.err) == 1);
    CHECK(Contains(outcome.err, part));
  };
  refused({"--frames", "0..3", "-o", work / "a.png"}, "4 frames need {frame} in the path");
  refused({"--turntable", "9", "-o", work / "a.png"}, "9 frames need {frame} in the path");
  refused({"-o", work / "a{frame}.png"}, "{frame} needs --frames or --turntable");
  refused({"--frames", "0..3", "-o", work / "a{frame:x}.png"}, "{frame:x} needs a width of 1 to 9");
  refused({"--frames", "3..0", "-o", work / "a{frame}.png"}, "--frames");
  refused({"--frames", "1..", "-o", work / "a{frame}.png"}, "a range of frames like 0..47");
  refused({"--frames", "1", "--time", "2", "-o", work / "a.png"}, "--frames, --time");
  refused({"--turntable", "1", "--time", "2", "-o", work / "a.png"}, "--turntable, --time");
  CHECK(work.Files() == std::vector<std::string>{"s.json"});
}

}  // namespace
}  // namespace sheaf
