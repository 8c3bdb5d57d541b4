// `sheaf render --resume`: the bits of a run that was never killed, whatever it left behind.
#include <doctest/doctest.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "random_scene.h"
#include "tests/run_command.h"

namespace sheaf {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

std::vector<std::string> Joined(std::vector<std::string> a, const std::vector<std::string>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

// Runs the command and kills it after a random time, until one run ends by itself. Returns that
// run's outcome; `kills` counts the others.
Outcome RunWithKills(const Workspace& work, const std::vector<std::string>& command,
                     double most_seconds, int* kills) {
  static Random random(5);
  for (;;) {
    const Process process = work.Start(command);
    // Later and later, so that it ends on a slow machine too.
    const double seconds = Uniform(random, 0, most_seconds * (1 + 0.25 * *kills));
    std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
    process.Signal(SIGKILL);
    Outcome outcome = process.Wait();
    if (outcome.code != -SIGKILL) return outcome;
    ++*kills;
  }
}

// Of a picture with many bands that takes about a second.
std::vector<std::string> Slow(const std::string& output) {
  return {"render", kScene, "--size",    "512x1024", "--spp", "16",
          "-o",     output, "--threads", "1",        "--json"};
}

TEST_CASE("a picture that was killed again and again has the bits of one that was not") {
  const Workspace work;
  REQUIRE(work.Run(Slow(work / "whole.png")).code == 0);
  int resumed = 0, kills = 0;
  for (int round = 0; round < 4; ++round) {
    const Outcome last =
        RunWithKills(work, Joined(Slow(work / "a.png"), {"--resume"}), 0.5, &kills);
    CAPTURE(last.err);
    REQUIRE(last.code == 0);
    CHECK(ReadText(work / "a.png") == ReadText(work / "whole.png"));
    resumed += json::parse(last.out)["frames"][0].value("resumed_rows", 0) > 0;
    CHECK(work.Files() == std::vector<std::string>{"a.png", "whole.png"});  // no journal
    fs::remove(work / "a.png");
  }
  CHECK(kills >= 4);
  CHECK(resumed >= 1);
}

// Lets `command` write some of its journal, and kills it.
void LeaveJournal(const Workspace& work, const std::vector<std::string>& command,
                  const std::string& journal, std::uintmax_t bytes) {
  const Process process = work.Start(command);
  std::error_code ignored;
  for (int i = 0; i < 20000; ++i) {
    const std::uintmax_t size = fs::file_size(journal, ignored);
    if (!ignored && size >= bytes) break;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  process.Signal(SIGKILL);
  REQUIRE(process.Wait().code == -SIGKILL);
  REQUIRE(fs::file_size(journal) >= bytes);
}

TEST_CASE("what a journal holds besides whole bands of this work changes no bit") {
  const Workspace work;
  const std::string journal = work / ".a.png.sheaf-journal";
  const auto command = Joined(Slow(work / "a.png"), {"--resume"});
  REQUIRE(work.Run(Slow(work / "whole.png")).code == 0);
  const std::string whole = ReadText(work / "whole.png");
  constexpr std::uintmax_t kTwoBands = 2 << 20;
  const auto finish = [&](const std::vector<std::string>& last_command) {
    const Outcome outcome = work.Run(last_command);
    CAPTURE(outcome.err);
    REQUIRE(outcome.code == 0);
    CHECK(!fs::exists(journal));
    return outcome;
  };
  const auto resumed_rows = [](const Outcome& outcome) {
    return json::parse(outcome.out)["frames"][0].value("resumed_rows", 0);
  };

  LeaveJournal(work, command, journal, kTwoBands);
  CHECK(!fs::exists(work / "a.png"));
  Outcome outcome = finish(command);
  const int rows = resumed_rows(outcome);
  CHECK(rows >= 256);
  CHECK(Contains(outcome.err, "goes on after"));
  CHECK(ReadText(work / "a.png") == whole);

  // A torn end, garbage behind it, and a byte that is wrong in the first band.
  LeaveJournal(work, command, journal, kTwoBands);
  fs::resize_file(journal, fs::file_size(journal) - 1000);
  std::ofstream(journal, std::ios::app) << std::string(5000, 'x');
  outcome = finish(command);
  CHECK(resumed_rows(outcome) > 0);
  CHECK(ReadText(work / "a.png") == whole);
  LeaveJournal(work, command, journal, kTwoBands);
  std::string bytes = ReadText(journal);
  bytes[5000] = static_cast<char>(bytes[5000] ^ 1);
  WriteText(journal, bytes);
  outcome = finish(command);
  CHECK(resumed_rows(outcome) == 0);
  CHECK(ReadText(work / "a.png") == whole);

  // A journal of another version.
  LeaveJournal(work, command, journal, kTwoBands);
  bytes = ReadText(journal);
  REQUIRE(bytes.starts_with("SHEAFJ2\n"));
  WriteText(journal, "SHEAFJ1\n" + bytes.substr(8));
  outcome = finish(command);
  CHECK(Contains(outcome.err, "begun anew"));
  CHECK(resumed_rows(outcome) == 0);
  CHECK(ReadText(work / "a.png") == whole);

  // Other options: their bits, and a warning. Threads and the report are no other work.
  LeaveJournal(work, command, journal, kTwoBands);
  outcome = finish({"render", kScene, "--size", "512x1024", "-o", work / "a.png", "--resume"});
  CHECK(Contains(outcome.err, "of another scene, or other options; begun anew"));
  CHECK(work.Run({"render", kScene, "--size", "512x1024", "-o", work / "other.png"}).code == 0);
  CHECK(ReadText(work / "a.png") == ReadText(work / "other.png"));
  LeaveJournal(work, command, journal, kTwoBands);
  outcome = finish({"render", kScene, "--size", "512x1024", "--spp", "16", "-o", work / "a.png",
                    "--resume", "--threads", "2", "--json", "-q"});
  CHECK(resumed_rows(outcome) > 0);
  CHECK(ReadText(work / "a.png") == whole);
}

TEST_CASE("a journal of a scene that has changed since is begun anew") {
  const Workspace work;
  const std::string scene = work / "s.json";
  WriteText(scene, ReadText(kScene));
  const std::vector<std::string> command = {
      "render",        scene,   "--size",       "256x1024", "--spp",        "30",        "--crop",
      "0,40,256,1000", "--aov", "depth,normal", "-o",       work / "a.pfm", "--threads", "1",
      "--resume",      "--json"};
  const std::string pfm_journal = work / ".a.pfm.sheaf-journal";
  // A band is 192 rows of 256 pixels of 28 bytes: 1.4 MB. Less may be one that is half written.
  constexpr std::uintmax_t kTwoBands = 3 << 20;
  std::vector<std::string> plain = command;
  plain[11] = work / "plain.pfm";
  plain.erase(plain.end() - 2);
  REQUIRE(work.Run(plain).code == 0);
  LeaveJournal(work, command, pfm_journal, kTwoBands);
  const Outcome outcome = work.Run(command);
  CAPTURE(outcome.err);
  REQUIRE(outcome.code == 0);
  CHECK(json::parse(outcome.out)["frames"][0].value("resumed_rows", 0) > 0);
  for (const char* layer : {"", ".depth", ".normal"}) {
    CHECK(ReadText(work / ("a" + std::string(layer) + ".pfm")) ==
          ReadText(work / ("plain" + std::string(layer) + ".pfm")));
  }
  LeaveJournal(work, command, pfm_journal, kTwoBands);
  WriteText(scene, ReadText(kScene) + "\n// changed\n");
  const Outcome changed = work.Run(command);
  CHECK(changed.code == 0);
  CHECK(Contains(changed.err, "begun anew"));
}

TEST_CASE("a sequence keeps what is finished, and what is still as it was") {
  const Workspace work;
  const auto sequence = [&](const std::string& pattern) {
    return std::vector<std::string>{"render",  kScene,  "--turntable", "6",         "--size",
                                    "160x320", "--spp", "60",          "--threads", "1",
                                    "--json",  "-o",    work / pattern};
  };
  REQUIRE(work.Run(sequence("whole{frame}.png")).code == 0);
  const auto command = Joined(sequence("a{frame}.png"), {"--resume"});
  int kills = 0;
  const Outcome last = RunWithKills(work, command, 0.3, &kills);
  CAPTURE(last.err);
  REQUIRE(last.code == 0);
  CHECK(json::parse(last.out)["frames"].size() == 6);
  const auto check_all = [&] {
    for (int i = 0; i < 6; ++i) {
      const std::string name = std::to_string(i) + ".png";
      CHECK(ReadText(work / ("a" + name)) == ReadText(work / ("whole" + name)));
    }
    std::string names;
    for (const std::string& name : work.Files()) names += name + " ";
    CAPTURE(names);
    CHECK(work.Files().size() == 12);  // no journals
  };
  check_all();

  // Killed when the third picture is there; then the second is replaced by something else.
  for (int i = 0; i < 6; ++i) fs::remove(work / ("a" + std::to_string(i) + ".png"));
  const Process process = work.Start(command);
  for (int i = 0; i < 20000 && !fs::exists(work / "a2.png"); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  process.Signal(SIGKILL);
  REQUIRE(process.Wait().code == -SIGKILL);
  WriteText(work / "a1.png", ReadText(work / "whole4.png"));
  const Outcome again = work.Run(command);
  CAPTURE(again.err);
  REQUIRE(again.code == 0);
  const json frames = json::parse(again.out)["frames"];
  CHECK(frames[0]["kept"] == true);
  CHECK(frames[0]["frame"] == 0);
  CHECK(!frames[1].contains("kept"));
  CHECK(Contains(again.err, "kept " + (work / "a0.png")));
  check_all();

  // Without the option nothing is kept, and nothing is left.
  CHECK(!Contains(work.Run(sequence("a{frame}.png")).err, "kept"));
  check_all();
}

TEST_CASE("a texture that is not there keeps nobody from going on") {
  const Workspace work;
  WriteText(work / "a.obj",
            "mtllib a.mtl\nusemtl m\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nf 1/1 2/1 3/1\n");
  WriteText(work / "a.mtl", "newmtl m\nmap_Kd missing.png\n");
  const Outcome outcome =
      work.Run({"render", work / "a.obj", "--resume", "--size", "32x24", "-o", work / "a.png"});
  CAPTURE(outcome.err);
  CHECK(outcome.code == 0);
  CHECK(Contains(outcome.err, "missing.png"));
}

TEST_CASE("--resume is refused where there is nothing to go on with") {
  const Workspace work;
  const Outcome stream = work.Run({"render", kScene, "-o", "-", "--format", "pfm", "--resume"});
  CHECK(stream.code == 2);
  CHECK(Contains(stream.err, "--resume: /dev/stdout is no file"));
  const auto command = Joined(Slow(work / "a.png"), {"--resume"});
  const Process first = work.Start(command);
  for (int i = 0; i < 20000 && !fs::exists(work / ".a.png.sheaf-journal"); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  const Outcome second = work.Run(command);
  CHECK(second.code == 4);
  CHECK(Contains(second.err, "another run is at this picture"));
  first.Signal(SIGINT);
  const Outcome interrupted = first.Wait();
  CHECK(interrupted.code == 130);
  CHECK(Contains(interrupted.err, "a.png was not written; --resume goes on with it"));
}

}  // namespace
}  // namespace sheaf
