// The commands that take pictures: merge and convert.
#include <doctest/doctest.h>

#include <filesystem>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "src/formats/pfm.h"
#include "src/formats/png.h"
#include "tests/run_command.h"

namespace sheaf {
namespace {

namespace fs = std::filesystem;

TEST_CASE("a PNG that is empty or cut short says so") {
  const Workspace work;
  REQUIRE(work.Render({"-q", "-o", work / "a.png"}).code == 0);
  const std::string whole = ReadText(work / "a.png");
  for (const std::size_t size : {std::size_t{0}, std::size_t{30}, whole.size() / 2}) {
    WriteText(work / "cut.png", whole.substr(0, size));
    const Outcome outcome = work.Run({"convert", work / "cut.png", "-o", work / "x.png"});
    CHECK(outcome.code == 4);
    CHECK(outcome.err ==
          "sheaf: " + (work / "cut.png") + ": no whole PNG: the file is empty or cut short\n");
  }
}

TEST_CASE("parts of a picture, merged, are the whole to the bit") {
  const Workspace work;
  const auto render = [&](const std::string& name, std::vector<std::string> more) {
    std::vector<std::string> arguments = {"render", kScene,   "-o",   work / name,
                                          "-q",     "--size", "61x47"};
    if (name.ends_with(".exr")) arguments.insert(arguments.end(), {"--aov", "depth,normal,id"});
    arguments.insert(arguments.end(), more.begin(), more.end());
    REQUIRE(work.Run(arguments).code == 0);
  };
  for (const std::string ending : {".png", ".pfm", ".exr"}) {
    CAPTURE(ending);
    std::vector<std::string> merge = {"merge", "--output", work / ("merged" + ending)};
    for (const char* part : {"1", "2", "3"}) {
      render("part" + (part + ending), {"--tile", std::string(part) + "/3"});
      merge.push_back(work / ("part" + (part + ending)));
    }
    REQUIRE(work.Run(merge).code == 0);
    render("whole" + ending, {});
    const Outcome same = work.Run(
        {"compare", work / ("whole" + ending), work / ("merged" + ending), "--fail", "largest=0"});
    CAPTURE(same.out);
    CHECK(same.code == 0);
    // A gap and an overlap.
    merge.pop_back();
    if (ending != ".pfm") CHECK(work.Run(merge).code == 2);
    merge.push_back(merge.back());
    if (ending != ".pfm") CHECK(work.Run(merge).code == 2);
  }
  const std::string part = ReadText(work / "part1.png");
  CHECK(work.Run({"merge", work / "part1.png", work / "part2.png", work / "part3.png", "-o",
                  work / "part1.png"})
            .code == 2);
  CHECK(ReadText(work / "part1.png") == part);
  // Crops know their place as well.
  render("left.png", {"--crop", "0,0,20,47"});
  render("right.png", {"--crop", "20,0,61,47"});
  REQUIRE(work.Run({"merge", work / "right.png", work / "left.png", "-o", work / "m.png"}).code ==
          0);
  CHECK(work.Run({"compare", work / "whole.png", work / "m.png", "--fail", "largest=0"}).code == 0);
  CHECK(work.Run({"render", kScene, "-o", work / "x.png", "--tile", "4/3"}).code == 2);
  CHECK(work.Run({"render", kScene, "-o", work / "x.png", "--tile", "1/2", "--crop", "0,0,1,1"})
            .code == 2);
}

TEST_CASE("merge joins parts of one picture alone") {
  const Workspace work;
  const auto render = [&](const std::string& name, const std::vector<std::string>& more,
                          const std::string& scene = kScene) {
    std::vector<std::string> arguments = {"render", scene,    "-o",   work / name,
                                          "-q",     "--size", "32x24"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    REQUIRE(work.Run(arguments).code == 0);
  };
  fs::create_directory(work / "moved");
  fs::copy_file(kScene, work / "moved/crystal-ball.json");
  fs::copy_file(kScene, work / "other.json");
  for (const std::string ending : {".png", ".exr"}) {
    render("1" + ending, {"--tile", "1/2"});
    render("2" + ending, {"--tile", "2/2"}, work / "moved/crystal-ball.json");
    if (ending == ".png") render("2.png", {"--tile", "2/2", "--aov", "albedo"});
    render("camera" + ending, {"--tile", "2/2", "--camera", "up"});
    render("samples" + ending, {"--tile", "2/2", "--spp", "2"});
    render("eye" + ending, {"--tile", "2/2", "--eye", "0,0,9"});
    render("scene" + ending, {"--tile", "2/2"}, work / "other.json");
    const auto merge = [&](const std::string& name) {
      return work.Run({"merge", work / ("1" + ending), work / name, "-o", work / ("m" + ending)});
    };
    CHECK(merge("2" + ending).code == 0);  // the same scene in another folder
    for (const auto& [name, says] : {std::pair("camera", ": Camera \"up\", and "),
                                     {"samples", ": Settings \"32x24 pixels, 2 s"},
                                     {"eye", ": Settings \"32x24 pixels, "},
                                     {"scene", ": Scene \""}}) {
      const Outcome outcome = merge(name + ending);
      CAPTURE(outcome.err);
      CHECK(outcome.code == 2);
      CHECK(LineCount(outcome.err) == 1);
      CHECK(Contains(outcome.err, "sheaf: " + (work / (name + ending)) + says));
    }
  }
  const Outcome layer =
      work.Run({"merge", work / "1.png", work / "2.albedo.png", "-o", work / "m.png"});
  CHECK(layer.code == 2);
  CHECK(Contains(layer.err, ", layer albedo\", and "));
  const Result<ReadPictureResult> merged = ReadPngFilm(work / "m.png");
  REQUIRE(merged.ok());
  REQUIRE(merged.value().metadata.size() == 3);
  CHECK(merged.value().metadata[0] == std::pair<std::string, std::string>("Scene", kScene));
  CHECK(merged.value().metadata[1].second == "front");

  render("whole.png", {});
  render("left.png", {"--crop", "0,0,9,24"});
  render("a.pfm", {});
  render("b.pfm", {"--crop", "0,0,9,24"});
  const auto refused = [&](const std::string& first, const std::string& second) {
    const Outcome outcome =
        work.Run({"merge", work / first, work / second, "-o", work / ("x" + first)});
    CHECK(outcome.code == 2);
    return outcome.err;
  };
  CHECK(Contains(refused("whole.png", "left.png"), "left.png: pixel (0, 0) is in another part"));
  CHECK(Contains(refused("a.pfm", "1.exr"), "a.pfm: does not say where it belongs, and "));
  CHECK(Contains(refused("1.exr", "a.pfm"), "a.pfm: does not say where it belongs, and "));
  CHECK(Contains(refused("a.pfm", "b.pfm"), "b.pfm: 9 pixels wide, and "));
}

TEST_CASE("convert and merge write to a pipe in the format that is named") {
  const Workspace work;
  REQUIRE(work.Render({"-o", work / "whole.png"}).code == 0);
  REQUIRE(work.Render({"-o", work / "1.png", "--tile", "1/2"}).code == 0);
  REQUIRE(work.Render({"-o", work / "2.png", "--tile", "2/2"}).code == 0);
  REQUIRE(work.Run({"merge", work / "1.png", work / "2.png", "-o", work / "m.png"}).code == 0);
  REQUIRE(work.Run({"convert", work / "whole.png", "-o", work / "c.pfm"}).code == 0);
  const Outcome merged =
      work.Run({"merge", work / "1.png", work / "2.png", "-o", "-", "--format", "png"});
  CHECK(merged.code == 0);
  CHECK(merged.out == ReadText(work / "m.png"));
  const Outcome converted = work.Run({"convert", work / "whole.png", "-o", "-", "--format", "pfm"});
  CHECK(converted.code == 0);
  CHECK(converted.out == ReadText(work / "c.pfm"));
  for (const auto& command :
       std::vector<std::vector<std::string>>{{"merge", work / "1.png", work / "2.png", "-o", "-"},
                                             {"convert", work / "whole.png", "-o", "-"}}) {
    const Outcome outcome = work.Run(command);
    CHECK(outcome.code == 2);
    CHECK(Contains(outcome.err, "-o /dev/stdout: needs --format"));
  }
  const Outcome scene = work.Run({"convert", kScene, "-o", work / "s.json", "--format", "png"});
  CHECK(scene.code == 2);
  CHECK(Contains(scene.err, "--format: for pictures"));
}

TEST_CASE("convert keeps every bit that the format holds") {
  const Workspace work;
  REQUIRE(work.Run({"render", kScene, "-o", work / "a.exr", "-q", "--size", "40x30"}).code == 0);
  REQUIRE(work.Run({"render", kScene, "-o", work / "a.pfm", "-q", "--size", "40x30"}).code == 0);
  REQUIRE(work.Run({"convert", work / "a.exr", "--output", work / "b.pfm"}).code == 0);
  CHECK(ReadText(work / "a.pfm") == ReadText(work / "b.pfm"));
  REQUIRE(work.Run({"convert", work / "a.exr", "-o", work / "a.png", "--bits", "16"}).code == 0);
  CHECK(work.Run({"compare", work / "a.exr", work / "a.png", "--fail", "largest=0.00001"}).code ==
        0);
  REQUIRE(work.Run({"convert", kScene, "-o", work / "a.json"}).code == 0);
  REQUIRE(
      work.Run({"render", work / "a.json", "-o", work / "c.pfm", "-q", "--size", "40x30"}).code ==
      0);
  CHECK(ReadText(work / "a.pfm") == ReadText(work / "c.pfm"));
  // A PNG keeps its depth, and what it says of itself.
  REQUIRE(work.Run({"convert", work / "a.png", "-o", work / "b.png"}).code == 0);
  CHECK(ReadText(work / "a.png") == ReadText(work / "b.png"));
  const Result<ReadPictureResult> kept = ReadPngFilm(work / "b.png");
  REQUIRE(kept.ok());
  CHECK(kept.value().bits == 16);
  CHECK(kept.value().metadata.size() == 3);
  // The largest coordinate is one after a detour by float, too.
  WriteText(work / "huge.obj", "v 0 0 0\nv 1e30 0 0\nv 0 1e30 0\nf 1 2 3\n");
  REQUIRE(work.Run({"convert", work / "huge.obj", "-o", work / "huge.json"}).code == 0);
  CHECK(work.Run({"check", work / "huge.json"}).code == 0);
  CHECK(work.Run({"convert", work / "a.pfm", "-o", work / "x.json"}).code == 2);
  CHECK(work.Run({"convert", work / "a.pfm", "-o", work / "a.pfm"}).code == 2);
  CHECK(work.Run({"convert", work / "none.pfm", "-o", work / "x.png"}).code == 4);
}

TEST_CASE("halves end at 65504, but for what is infinite") {
  const Workspace work;
  Film film(2, 1);
  const float infinite = std::numeric_limits<float>::infinity();
  film.rgb = {1.0f, 1e6f, infinite, -1e6f, 65520.0f, 0.5f};
  REQUIRE(WritePfm(film, work / "a.pfm").ok());
  REQUIRE(work.Run({"convert", work / "a.pfm", "-o", work / "a.exr", "--bits", "16"}).code == 0);
  REQUIRE(work.Run({"convert", work / "a.exr", "-o", work / "b.pfm"}).code == 0);
  const auto expected = {1.0f, 65504.0f, infinite, -65504.0f, 65504.0f, 0.5f};
  const Film read = ReadPfm(work / "b.pfm").value();
  CHECK(std::equal(read.rgb.begin(), read.rgb.end(), expected.begin(), expected.end()));
}

}  // namespace
}  // namespace sheaf
