// `sheaf submit`: the commands that it prints make the picture of one machine. tests/slurm.sh gives
// its scripts to a real Slurm.
#include <doctest/doctest.h>

#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "tests/run_command.h"

namespace sheaf {
namespace {

std::vector<std::string> Joined(std::vector<std::string> a, const std::vector<std::string>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

std::vector<std::string> LinesOf(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

// Whether a shell runs the lines, each in a shell of its own, as GNU parallel does.
bool RunLines(const std::vector<std::string>& lines, const Workspace& work) {
  for (const std::string& line : lines) {
    WriteText(work / "line.sh", line);
    if (std::system(("sh " + (work / "line.sh") + " 2>/dev/null").c_str()) != 0) return false;
  }
  std::filesystem::remove(work / "line.sh");
  return true;
}

TEST_CASE("a list of parts, in any order, and its merge give the picture of one machine") {
  const Workspace work;
  const std::vector<std::string> options = {"--size", "48x37",        "--spp",      "3",
                                            "--aov",  "depth,normal", "--exposure", "auto",
                                            "--eye",  "-1,2,9",       "--bits",     "16"};
  for (const std::string name : {"it's a", "{camera}"}) {
    const std::string output = work / (name + ".png");
    const auto asked = Joined({"submit", kScene, "-o", output, "--parts", "5"}, options);
    const Outcome parts = work.Run(Joined(asked, {"--list"}));
    CAPTURE(parts.err);
    REQUIRE(parts.code == 0);
    std::vector<std::string> lines = LinesOf(parts.out);
    REQUIRE(lines.size() == 5);
    std::swap(lines.front(), lines.back());
    REQUIRE(RunLines(lines, work));
    const Outcome merge = work.Run(Joined(asked, {"--list=merge"}));
    CHECK(LinesOf(merge.out).size() == 3);  // the picture and two layers
    REQUIRE(RunLines(LinesOf(merge.out), work));
    CHECK(work.Run(Joined(asked, {"--list=all"})).out == parts.out + merge.out);
    const std::vector<std::string> made = work.Files();
    CHECK(made.size() == 3);  // no part is left
    const auto whole = Joined({"render", kScene, "-o", work / "whole.png"}, options);
    REQUIRE(work.Run(whole).code == 0);
    CHECK(ReadText(work / made[1]) == ReadText(work / "whole.normal.png"));
    CHECK(ReadText(work / made[0]) == ReadText(work / "whole.depth.png"));
    CHECK(ReadText(work / made[2]) == ReadText(work / "whole.png"));
    for (const std::string& file : work.Files()) std::filesystem::remove(work / file);
  }
}

TEST_CASE("a sequence is cut into ranges of frames, each of which is there once") {
  const Workspace work;
  const std::vector<std::string> options = {"--size", "16x12", "--turntable", "7"};
  const std::string output = work / "f{frame:2}.png";
  const auto asked = Joined({"submit", kScene, "-o", output, "--parts", "3"}, options);
  const Outcome list = work.Run(Joined(asked, {"--list=all"}));
  REQUIRE(list.code == 0);
  REQUIRE(LinesOf(list.out).size() == 3);
  REQUIRE(RunLines(LinesOf(list.out), work));
  REQUIRE(work.Files().size() == 7);
  REQUIRE(work.Run(Joined({"render", kScene, "-o", work / "one{frame:2}.png"}, options)).code == 0);
  for (int i = 0; i < 7; ++i) {
    const std::string name = "0" + std::to_string(i) + ".png";
    CHECK(ReadText(work / ("f" + name)) == ReadText(work / ("one" + name)));
  }
  // The shell's arithmetic of the job script cuts as the list does.
  const std::string script = work.Run(asked).out;
  const std::size_t from = script.find("--frames=") + 9;
  const std::string frames = script.substr(from, script.find(" -o", from) - from);
  WriteText(work / "cut.sh",
            "for part in 1 2 3; do echo --frames=" + frames + "; done >" + (work / "cut.txt"));
  REQUIRE(std::system(("sh " + (work / "cut.sh")).c_str()) == 0);
  const std::vector<std::string> cut = LinesOf(ReadText(work / "cut.txt"));
  REQUIRE(cut.size() == 3);
  for (std::size_t i = 0; i < 3; ++i) CHECK(Contains(LinesOf(list.out)[i], cut[i] + " "));
}

TEST_CASE("the script for Slurm: an array, a merge that waits for it, options passed on") {
  const Workspace work;
  const Outcome outcome = work.Run({"submit", kScene, "-o", work / "a.exr", "--parts", "64",
                                    "--spp", "9", "--sbatch=--time=2:00:00", "--sbatch=-p",
                                    "--sbatch=-plong way", "--size", "99x99"});
  CAPTURE(outcome.err);
  REQUIRE(outcome.code == 0);
  CHECK(Contains(outcome.out, "--time=2:00:00 -p '-plong way' --array=1-64 --requeue"));
  CHECK(Contains(outcome.out, "--dependency=afterok:\"$parts\""));
  CHECK(Contains(outcome.out, " --size=99x99 --spp=9 --resume "));
  CHECK(work.Files().empty());
}

TEST_CASE("what cannot be submitted is said before anything is") {
  const Workspace work;
  const std::string png = work / "a.png";
  const auto refused = [&](const std::vector<std::string>& more, const std::string& why) {
    const Outcome outcome = work.Run(Joined({"submit", kScene, "--size", "32x24"}, more));
    CAPTURE(outcome.err);
    CHECK(outcome.code == 2);
    CHECK(Contains(outcome.err, why));
    CHECK(outcome.out.empty());
  };
  refused({"-o", png}, "--parts is required");
  refused({"-o", png, "--parts", "25"}, "--parts 25: the picture has 24 rows");
  refused({"-o", png, "--parts", "2", "--tile", "1/2"}, "--tile: sheaf submit makes the parts");
  refused({"-o", png, "--parts", "2", "--crop", "0,0,4,4"}, "--crop: ");
  refused({"-o", "-", "--format", "png", "--parts", "2"}, "-o -: parts need a file");
  refused({"-o", png, "--parts", "2", "--aov", "heat"}, "--aov heat: parts of ");
  refused({"-o", png, "--parts", "2", "--list", "--run"}, "--run, --list: ");
  refused({"-o", png, "--parts", "2", "--sbatch=--array=1-9"}, "gives --array itself");
  refused({"-o", png, "--parts", "2", "--sbatch=long"}, "--sbatch=long: no option");
  refused({"-o", work / "a\nb.png", "--parts", "2"}, "a line may not end within a word");
  refused({"-o", work / "{frame}.png", "--turntable", "3", "--parts", "4"}, "there are 3 frames");
  CHECK(work.Run({"submit", "none.json", "-o", png, "--parts", "2"}).code == 4);
}

TEST_CASE("--run without sbatch, and with one that refuses, is an error of its own") {
  const Workspace work;
  const std::string path = std::getenv("PATH");
  std::filesystem::create_directory(work / "bin");
  for (const char* program : {"sh", "sed"}) {
    std::filesystem::create_symlink("/bin/" + std::string(program),
                                    work / ("bin/" + std::string(program)));
  }
  setenv("PATH", (work / "bin").c_str(), 1);
  const std::vector<std::string> command = {"submit",  kScene, "-o",   work / "a.png",
                                            "--parts", "2",    "--run"};
  const Outcome none = work.Run(command);
  WriteText(work / "bin/sbatch", "#!/bin/sh\necho no such partition >&2\nexit 1\n");
  std::filesystem::permissions(work / "bin/sbatch", std::filesystem::perms::owner_all);
  const Outcome refusing = work.Run(command);
  setenv("PATH", path.c_str(), 1);
  CHECK(none.code == 4);
  CHECK(Contains(none.err, "no sbatch on the PATH"));
  CHECK(refusing.code == 4);
  CHECK(Contains(refusing.err, "no such partition\n"));
  CHECK(Contains(refusing.err, "sbatch took not all of the jobs"));
}

}  // namespace
}  // namespace sheaf
