// Files and streams: what is never replaced, interruption, readers that go away.
#include <doctest/doctest.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "src/formats/png.h"
#include "tests/run_command.h"

namespace sheaf {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

TEST_CASE("no output replaces another file of the same run") {
  const Workspace work;
  const std::string scene = work / "scene.json";
  std::filesystem::copy_file(kScene, scene);
  const auto size = std::filesystem::file_size(scene);
  const Outcome over_scene =
      work.Run({"render", scene, "-q", "--size", "8x8", "-o", work / "a.png", "--json=" + scene});
  CHECK(over_scene.code == 2);
  CHECK(std::filesystem::file_size(scene) == size);
  const std::string picture = work / "b.png";
  const Outcome over_picture =
      work.Run({"render", scene, "-q", "--size", "8x8", "-o", picture, "--json=" + picture});
  CHECK(over_picture.code == 2);
  CHECK(!std::filesystem::exists(picture));
  // Two spellings of one path that is not there yet.
  fs::create_directory(work / "in");
  CHECK(work.Run({"render", scene, "-q", "--size", "8x8", "-o", picture,
                  "--json=" + (work / "in/../b.png")})
            .code == 2);
  CHECK(!std::filesystem::exists(picture));
}

// A textured triangle in a.json, which includes b.json; the texture is c-texture-1.png.
void WriteTexturedScene(const Workspace& work) {
  Picture8 image{2, 2, std::vector<std::uint8_t>(12, 200)};
  REQUIRE(WritePng(image, Transfer::kSrgb, work / "c-texture-1.png").ok());
  WriteText(work / "b.json", R"({"materials": [{"name": "m",
      "base_colour": {"texture": {"image": "c-texture-1.png"}}, "ambient": 1}],
      "objects": [{"triangle": {"vertices": [[0, 0, 0], [1, 0, 0], [0, 1, 0]]}, "material": "m"}],
      "cameras": [{"name": "c", "eye": [0, 0, 5], "look_at": [0, 0, 0]}]})");
  WriteText(work / "a.json", R"({"objects": [{"include": "b.json"}]})");
}

TEST_CASE("no output replaces a file that the scene is read from") {
  const Workspace work;
  WriteTexturedScene(work);
  const std::string scene = work / "a.json", texture = work / "c-texture-1.png";
  const std::string included = ReadText(work / "b.json"), pixels = ReadText(texture);
  for (const auto& arguments : std::vector<std::vector<std::string>>{
           {"render", scene, "-q", "--size", "8x8", "-o", texture},
           {"render", scene, "-q", "--size", "8x8", "-o", work / "{camera}-texture-1.png"},
           {"render", scene, "-q", "--size", "8x8", "-o", work / "x.png",
            "--json=" + (work / "b.json")},
           {"convert", scene, "-o", work / "b.json"},
           {"convert", scene, "-o", work / "c.json"}}) {
    const Outcome outcome = work.Run(arguments);
    CAPTURE(outcome.err);
    CHECK(outcome.code == 2);
    CHECK(LineCount(outcome.err) == 1);
    CHECK(Contains(outcome.err, "would replace a file that this run reads"));
  }
  CHECK(ReadText(work / "b.json") == included);
  CHECK(ReadText(texture) == pixels);
  CHECK(work.Files() == std::vector<std::string>{"a.json", "b.json", "c-texture-1.png"});
  CHECK(work.Run({"convert", scene, "-o", work / "d.json"}).code == 0);
  CHECK(ReadText(work / "d-texture-1.png") == pixels);
}

TEST_CASE("a link that leads nowhere yet stays a link") {
  const Workspace work;
  fs::create_directory(work / "in");
  fs::create_symlink("in/b.png", work / "a.png");
  CHECK(work.Render({"-q", "-o", work / "a.png"}).code == 0);
  CHECK(fs::is_symlink(work / "a.png"));
  CHECK(ReadPng(work / "in/b.png").ok());
  fs::create_symlink("none/b.png", work / "c.png");
  CHECK(work.Render({"-q", "-o", work / "c.png"}).code == 4);
}

TEST_CASE("a signal stops the frame: 130 or 143, no new file, the old one untouched") {
  for (const auto& [signal, code] : {std::pair(SIGINT, 130), {SIGTERM, 143}}) {
    const Workspace work;
    WriteText(work / "up.png", "the old picture");
    const Process process =
        work.Start({"render", kScene, "--camera", "up,front", "--size", "2048x2048", "--spp",
                    "4096", "--progress", "plain", "--json", "-o", work / "{camera}.png"});
    // The first line says that the frame has begun, and so that the signal will be caught.
    for (int i = 0; i < 1000 && process.err().empty(); ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    CHECK(work.Files() == std::vector<std::string>{"up.png"});  // not even a temporary
    const auto begin = std::chrono::steady_clock::now();
    process.Signal(signal);
    const Outcome outcome = process.Wait();
    const std::chrono::duration<double> waited = std::chrono::steady_clock::now() - begin;
    CHECK(outcome.code == code);
    CHECK(outcome.out.empty());
    CHECK(Contains(outcome.err, "interrupted"));
    CHECK(!Contains(outcome.err, "wrote"));
    CHECK(waited.count() < 30.0);  // a frame of this size takes minutes
    CHECK(work.Files() == std::vector<std::string>{"up.png"});
    CHECK(ReadText(work / "up.png") == "the old picture");
  }
}

TEST_CASE("a signal stops what consists of many short frames or checks") {
  const Workspace work;
  // POV-Ray has no part in an orthographic camera.
  const std::string scene = work / "ball.json";
  WriteText(scene, R"({"materials": [{"name": "m"}],
                       "objects": [{"sphere": {"center": [0, 0, 0], "radius": 1}, "material": "m"}],
                       "cameras": [{"name": "c", "eye": [0, 0, 5], "look_at": [0, 0, 0],
                                    "orthographic": {"height": 3}}]})");
  std::string threads = "1";
  for (int i = 2; i <= 1000; ++i) threads += "," + std::to_string(i);
  const struct {
    std::vector<std::string> arguments;
    int signal, code;
  } runs[] = {
      {{"bench", scene, "--size", "8x8", "--repetitions", "1000", "--threads", threads,
        "--json=" + (work / "b.json")},
       SIGINT,
       130},
      {{"compare", scene, "--size", "8x8", "--threads", threads}, SIGTERM, 143},
      {{"pareto", scene, "--size", "8x8", "--repetitions", "1000", "-o", work / "r"}, SIGINT, 130},
      {{"stress", "far-leaks", "--thorough"}, SIGINT, 130},
      {{"stress", "far-leaks", "--thorough"}, SIGTERM, 143}};
  for (const auto& run : runs) {
    const Process process = work.Start(run.arguments);
    process.WaitUntilCaught(run.signal);
    process.Signal(run.signal);
    const Outcome outcome = process.Wait();
    CAPTURE(run.arguments.front());
    CHECK(outcome.code == run.code);
    CHECK(!Contains(outcome.out, "x scalar"));
    CHECK(!Contains(outcome.out, "differ from"));
    CHECK(!Contains(outcome.out, "cases failed"));
    CHECK(Contains(outcome.err, "interrupted"));
  }
  CHECK(!fs::exists(work / "b.json"));
  CHECK(fs::is_empty(work / "r"));
}

TEST_CASE("output that does not arrive is code 4") {
  const Workspace work;
  if (!fs::exists("/dev/full")) return;
  for (const auto& arguments : std::vector<std::vector<std::string>>{
           {"info"},
           {"--help"},
           {"render", kScene, "--size", "8x8", "-q", "--json", "-o", work / "a.png"}}) {
    const Process process(arguments, "/dev/full", work / "err");
    CHECK(process.WaitForExit() == 4);
  }
  CHECK(fs::exists(work / "a.png"));
  fs::create_symlink("/dev/full", work / "full.png");
  const Outcome full = work.Render({"-o", work / "full.png"});
  CHECK(full.code == 4);
  CHECK(!Contains(full.err, "wrote"));
}

TEST_CASE("a picture does not depend on stderr") {
  const Workspace work;
  if (!fs::exists("/dev/full")) return;
  const Process process({"render", kScene, "--size", "8x8", "-o", work / "a.png"}, work / "out",
                        "/dev/full");
  CHECK(process.WaitForExit() == 0);
  CHECK(ReadPng(work / "a.png").ok());
}

TEST_CASE("a reader that goes away is code 4, not a signal") {
  const Workspace work;
  const std::string fifo = work / "fifo";
  REQUIRE(mkfifo(fifo.c_str(), 0600) == 0);
  const int reader = open(fifo.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  REQUIRE(reader >= 0);
  const Process process(
      {"render", kScene, "--size", "1024x768", "--spp", "4", "-q", "--json", "-o", work / "a.png"},
      fifo, work / "err");
  close(reader);  // the command has the pipe open, and writes to it once the picture is done
  CHECK(process.WaitForExit() == 4);
  CHECK(Contains(process.err(), "standard output"));
}

// The bytes that a run without any fault may send to a terminal: text, and ends of lines.
bool IsPlain(const std::string& text) {
  return std::none_of(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) < 0x20 && c != '\n') || c == '\x7f';
  });
}

TEST_CASE("control characters in names never reach the terminal") {
  const Workspace work;
  const std::string evil = "e\x1b[31m\x07";
  WriteText(work / (evil + ".obj"), "mtllib gone\x1b.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  WriteText(work / (evil + ".json"), "{\"\x1b[2J\"}");
  for (const auto& arguments : std::vector<std::vector<std::string>>{
           {"render", work / (evil + ".obj"), "--size", "8x8", "-o", work / (evil + ".png")},
           {"render", work / (evil + ".obj"), "-o", work / (evil + "/a.png")},
           {"render", work / (evil + ".obj"), "-o", work / evil},
           {"render", kScene, "-o", work / "a.png", "--camera", evil},
           {"render", kScene, "-o", work / "a.png", "--" + evil},
           {"render", kScene, "-o", work / "a.png", "--progress", evil},
           {"convert", work / evil, "-o", work / "a.png"},
           {"check", work / (evil + ".obj"), work / (evil + ".json")},
           {"check", work / (evil + ".obj"), "--json"},
           {"info", work / (evil + ".obj")}}) {
    const Outcome outcome = work.Run(arguments);
    CAPTURE(arguments[0]);
    CHECK(IsPlain(outcome.out));
    CHECK(IsPlain(outcome.err));
    CHECK(Contains(outcome.out + outcome.err, "\\u001B[31m"));
  }
}

TEST_CASE("a picture goes to standard output, in the format that --format says") {
  const Workspace work;
  for (const std::string format : {"png", "pfm"}) {
    const std::string path = work / ("a." + format);
    REQUIRE(work.Render({"-q", "-o", path}).code == 0);
    for (const std::string output : {"-", "/dev/stdout"}) {
      const Outcome piped = work.Render({"-q", "-o", output, "--format", format});
      CHECK(piped.code == 0);
      CHECK(piped.err.empty());
      CHECK(piped.out == ReadText(path));
    }
    CHECK(work.Render({"-q", "-o", work / "plain", "--format", format}).code == 0);
    CHECK(ReadText(work / "plain") == ReadText(path));
  }
}

TEST_CASE("-q shows errors alone, of a model with a warning too") {
  const Workspace work;
  const std::string model = work / "a.obj";
  WriteText(model, "mtllib gone.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  CHECK(Contains(work.Run({"render", model, "-o", work / "a.png"}).err, "sheaf: warning: "));
  CHECK(work.Run({"render", model, "-o", work / "a.png", "-q"}).err.empty());
}

TEST_CASE("a model is the same by its bare name and by a path") {
  const Workspace work;
  WriteText(work / "a.obj", "mtllib gone.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const std::string here = fs::current_path().string();
  fs::current_path(fs::path(work / "a.obj").parent_path());
  const Outcome bare = work.Run({"render", "a.obj", "-o", work / "bare.png"});
  const Outcome dotted = work.Run({"render", "./a.obj", "-o", work / "dotted.png"});
  fs::current_path(here);
  CHECK(bare.code == 0);
  CHECK(Contains(bare.err, "warning: a.obj:"));
  CHECK(Contains(bare.err, "gone.mtl"));
  CHECK(dotted.code == 0);
  CHECK(!ReadText(work / "bare.png").empty());
}

}  // namespace
}  // namespace sheaf
