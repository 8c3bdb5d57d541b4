// The command as a user meets it: exit codes, what goes to which stream, files, interruption.
#include <doctest/doctest.h>
#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "sheaf/version.h"
#include "src/formats/pfm.h"
#include "src/formats/png.h"
#include "src/lab/has_program.h"

extern char** environ;

namespace sheaf {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

const std::string kScene = SHEAF_SOURCE_DIR "/scenes/crystal-ball.json";

std::string ReadText(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void WriteText(const std::string& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

bool Contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

std::size_t LineCount(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

struct Outcome {
  int code;  // the exit code; minus the signal where one killed the command
  std::string out, err;
};

// A running `sheaf`. Its streams go to files, which fill no pipe and can be read meanwhile.
class Process {
 public:
  Process(std::vector<std::string> arguments, const std::string& out_path,
          const std::string& err_path)
      : out_path_(out_path), err_path_(err_path) {
    arguments.insert(arguments.begin(), SHEAF_COMMAND);
    std::vector<char*> argv;
    for (std::string& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);

    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    const int flags = O_WRONLY | O_CREAT | O_TRUNC;
    posix_spawn_file_actions_addopen(&actions, 1, out_path.c_str(), flags, 0644);
    posix_spawn_file_actions_addopen(&actions, 2, err_path.c_str(), flags, 0644);
    // A test run in the background may have these ignored, and the command honours that.
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    sigset_t deadly;
    sigemptyset(&deadly);
    sigaddset(&deadly, SIGINT);
    sigaddset(&deadly, SIGTERM);
    posix_spawnattr_setsigdefault(&attributes, &deadly);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF);
    const int failure =
        posix_spawn(&process_, SHEAF_COMMAND, &actions, &attributes, argv.data(), environ);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&actions);
    REQUIRE(failure == 0);
  }

  void Signal(int number) const { kill(process_, number); }

  // Until the command has a handler for it, which the kernel tells; or a while, where it does not.
  void WaitUntilCaught(int number) const {
    const std::string path = "/proc/" + std::to_string(process_) + "/status";
    for (int i = 0; i < 1000; ++i) {
      const std::string status = ReadText(path);
      const std::size_t at = status.find("SigCgt:");
      if (at == std::string::npos) break;
      if (std::stoull(status.substr(at + 7), nullptr, 16) >> (number - 1) & 1) return;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
  }
  std::string err() const { return ReadText(err_path_); }

  int WaitForExit() const {
    int status = 0;
    while (waitpid(process_, &status, 0) < 0 && errno == EINTR) {
    }
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  }

  Outcome Wait() const {
    const int code = WaitForExit();
    return {code, ReadText(out_path_), ReadText(err_path_)};
  }

 private:
  pid_t process_ = 0;
  std::string out_path_, err_path_;
};

// A folder for the pictures and one beside it for the streams; both go away with the test.
class Workspace {
 public:
  Workspace() {
    std::string name = (fs::temp_directory_path() / "sheaf-test-XXXXXX").string();
    REQUIRE(mkdtemp(name.data()) != nullptr);
    root_ = name;
    fs::create_directory(root_ / "files");
  }
  Workspace(const Workspace&) = delete;
  Workspace& operator=(const Workspace&) = delete;
  ~Workspace() { fs::remove_all(root_); }

  std::string operator/(const std::string& name) const { return (root_ / "files" / name).string(); }

  // Names of what lies in the folder, sorted, hidden ones too.
  std::vector<std::string> Files() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(root_ / "files")) {
      names.push_back(entry.path().filename().string());
    }
    std::sort(names.begin(), names.end());
    return names;
  }

  Process Start(const std::vector<std::string>& arguments) const {
    return {arguments, (root_ / "out").string(), (root_ / "err").string()};
  }
  Outcome Run(const std::vector<std::string>& arguments) const { return Start(arguments).Wait(); }

  // `sheaf render SCENE` at a size that takes no time.
  Outcome Render(std::vector<std::string> arguments) const {
    const std::vector<std::string> begin = {"render", kScene, "--size", "32x24"};
    arguments.insert(arguments.begin(), begin.begin(), begin.end());
    return Run(arguments);
  }

 private:
  fs::path root_;
};

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
  for (const char* option :
       {"--camera", "--views", "-o", "--size", "--spp", "--max-depth", "--target", "--precision",
        "--threads", "--tile", "--crop", "--aov", "--progress", "-q", "--json"}) {
    CHECK_MESSAGE(Contains(options.out, option), std::string(option));
  }
  const Outcome version = work.Run({"--version"});
  CHECK(version.code == 0);
  CHECK(version.out == std::string("sheaf ") + kVersion + "\n");
}

TEST_CASE("compare finds no bit that differs between targets and threads") {
  const Workspace work;
  const Outcome all = work.Run(
      {"compare", kScene, "--size", "61x47", "--views", "sides", "--threads", "1,2", "--json"});
  REQUIRE(all.code == 0);
  const json result = json::parse(all.out);
  CHECK(result["reference"] == "scalar, 1 thread");
  REQUIRE(result["runs"].size() >= 2 * (2 + 3));  // both cameras; two targets besides the scalar
  for (const json& run : result["runs"]) CHECK(run["pixels"] == 0);
  CHECK(result["runs"][0]["target"] != "scalar");

  const Outcome text = work.Run({"compare", kScene, "--size", "8x8", "--targets", "scalar,auto"});
  CHECK(text.code == 0);
  CHECK(Contains(text.out, "1 thread: same bits\n"));
  CHECK(Contains(text.out, "0 of 1 renderings differ from scalar, 1 thread\n"));
  for (const auto& wrong :
       std::vector<std::vector<std::string>>{{"compare", kScene, "--targets", "scalar"},
                                             {"compare", kScene, "--targets", "scalar,avx9"},
                                             {"compare", kScene, "--threads", "0"},
                                             {"compare", kScene, "--precision", "fast"},
                                             {"compare", kScene, "--targets", "all,scalar"},
                                             {"compare", kScene, "--fail", "rmse=1"},
                                             {"compare", kScene, "--transfer", "srgb"},
                                             {"compare", kScene, kScene},
                                             {"compare", kScene, "--camera", "frnt"}}) {
    const Outcome outcome = work.Run(wrong);
    CHECK(outcome.code == 2);
    CHECK(LineCount(outcome.err) == 1);
  }
}

TEST_CASE("bench measures every target and judges against an earlier run") {
  const Workspace work;
  const std::string before = work / "before.json";
  const std::vector<std::string> bench = {"bench", kScene, "--size", "64x48", "--repetitions", "5"};
  auto arguments = bench;
  arguments.push_back("--json=" + before);
  const Outcome first = work.Run(arguments);
  REQUIRE(first.code == 0);
  CHECK(Contains(first.out, "range of all"));
  CHECK(!Contains(first.out, "95 % interval"));
  json report = json::parse(ReadText(before));
  REQUIRE(report["rows"].size() >= 3);
  CHECK(report["rows"][0]["target"] == "scalar");
  for (const json& row : report["rows"]) {
    CHECK(row["seconds"].size() == 5);
    const json& rate = row["rays_per_second"];
    CHECK(rate["interval"] == "range");
    CHECK(rate["low"] <= rate["median"]);
    CHECK(rate["median"] <= rate["high"]);
    CHECK(row["rays"] == report["rows"][0]["rays"]);
    CHECK(row["over_scalar"].get<double>() > 0);
  }
  // Against itself made a hundred times as fast, and a hundred times as slow; no clock decides.
  const auto judge = [&](double factor) {
    json changed = report;
    for (json& row : changed["rows"]) {
      std::vector<double> seconds;
      for (int i = 0; i < 9; ++i) seconds.push_back(factor * (1 + 1e-4 * i));
      row["seconds"] = seconds;
    }
    WriteText(before, changed.dump());
    auto again = bench;
    again.insert(again.end(), {"--targets", "auto", "--baseline", before, "--absolute", "--json"});
    return work.Run(again);
  };
  // A row that is too noisy gets no verdict, rightly: then there is nothing to check.
  const auto verdict = [](const Outcome& outcome) {
    return json::parse(outcome.out)["rows"][0]["verdict"].get<std::string>();
  };
  const Outcome slower = judge(1e-6), faster = judge(1e6);
  if (!Contains(verdict(slower), "noisy")) {
    CHECK(Contains(verdict(slower), "slower"));
    CHECK(slower.code == 1);
  }
  if (!Contains(verdict(faster), "noisy")) CHECK(Contains(verdict(faster), "faster"));
  CHECK(faster.code == 0);
  auto few = bench;
  few.insert(few.end(), {"--targets", "auto", "--baseline", before});
  few[5] = "2";
  CHECK(Contains(work.Run(few).out, "too few repetitions"));
  few[5] = "6";
  CHECK(Contains(work.Run(few).out, "95 % interval"));

  // Another frame, as far as the file tells.
  few[5] = "1";
  const auto refuse = [&](const json& changed, const char* says) {
    WriteText(before, changed.dump());
    const Outcome outcome = work.Run(few);
    CHECK(outcome.code == 2);
    CHECK(outcome.out.empty());
    CHECK(Contains(outcome.err, says));
  };
  json changed = report;
  changed["scene"] = "elsewhere/other.json";
  refuse(changed, "its scene is \"other.json\"");
  changed = report;
  for (json& row : changed["rows"]) row["rays"] = 1;
  refuse(changed, "its number of rays is 1");
  // The result replaces nothing that was read.
  WriteText(before, report.dump());
  few.push_back("--json=" + before);
  CHECK(work.Run(few).code == 2);
  CHECK(json::parse(ReadText(before)) == report);
  const std::string scene = work / "scene.json";
  fs::copy_file(kScene, scene);
  CHECK(work.Run({"bench", scene, "--size", "8x8", "--repetitions", "1", "--json=" + scene}).code ==
        2);
  CHECK(ReadText(scene) == ReadText(kScene));
  few.pop_back();

  WriteText(before, "{}");
  few[5] = "1";
  CHECK(work.Run(few).code == 4);
  CHECK(work.Run({"bench", kScene, "--baseline", work / "none"}).code == 4);
  CHECK(work.Run({"bench", kScene, "--targets", "avx9"}).code == 2);
}

TEST_CASE("pareto charts time against error") {
  const Workspace work;
  const Outcome outcome =
      work.Run({"pareto", kScene, "--size", "24x18", "--reference-spp", "65", "--repetitions", "1",
                "--error", "0.05", "--time", "1e9", "-o", work / "report"});
  REQUIRE(outcome.code == 0);
  CHECK(Contains(outcome.out, "cheapest for error 0.05: "));
  const json report = json::parse(ReadText(work / "report/front.json"));
  CHECK(report["reference_samples"] == 65);
  double least = 1, best_on_front = 1;
  int on_front = 0;
  for (const json& point : report["points"]) {
    const double error = point["error"], sampling = point["sampling"];
    if (point["front"]) {
      ++on_front;
      best_on_front = std::min(best_on_front, error);
    }
    if (point["renderer"] == "POV-Ray") {
      CHECK(point["numeric"].is_null());
      // So small a frame takes a few of the milliseconds that it tells.
      const bool is_timed = point["seconds"].is_number();
      if (is_timed) CHECK(point["seconds"].get<double>() >= 0.01);
      if (!is_timed) CHECK(point["front"] == false);
      continue;
    }
    least = std::min(least, error);
    const double numeric = point["numeric"];
    CHECK(point["seconds"].get<double>() > 0);
    // The two parts of an error bound it.
    CHECK(error <= numeric + sampling + 1e-12);
    CHECK(error > 0);  // no setting has the reference's own samples
    if (point["setting"] == "strict, 1 spp, depth 5") CHECK(error > 0.01);
  }
  CHECK(report["points"].size() > 200);
  CHECK(on_front >= 2);
  CHECK(best_on_front <= least);
  const std::string csv = ReadText(work / "report/front.csv");
  CHECK(LineCount(csv) == report["points"].size() + 1);
  if (HasProgram("gnuplot")) {
    CHECK(fs::exists(work / "report/front.svg"));
    CHECK(fs::exists(work / "report/front.png"));
  }
  CHECK(work.Run({"pareto", kScene, "-o", "/proc/none"}).code == 4);
  WriteText(work / "a.png", "no folder");
  const Outcome file = work.Run({"pareto", kScene, "-o", work / "a.png"});
  CHECK(file.code == 4);
  CHECK(Contains(file.err, (work / "a.png") + ": no folder can be made there"));
  CHECK(work.Run({"pareto", kScene, "-o", work / "r", "--error", "-1"}).code == 2);
}

TEST_CASE("stress runs every case, and one ray again") {
  const Workspace work;
  const Outcome list = work.Run({"stress", "--list"});
  CHECK(list.code == 0);
  CHECK(LineCount(list.out) >= 50);
  const Outcome all = work.Run({"stress"});
  CHECK_MESSAGE(all.code == 0, all.out);
  CHECK(LineCount(all.out) == LineCount(list.out) + 1);
  CHECK(Contains(all.out, "0 of "));
  const Outcome replayed =
      work.Run({"stress", "on-sphere", "--replay", "0,0,0x1.8p+1,0,0,-0x1p+0,0,0x1p+9,2147483647"});
  CHECK(replayed.code == 0);
  CHECK(Contains(replayed.out, "primitive 0, t 0x1p+1"));
  CHECK(Contains(work.Run({"stress", "on-spere"}).err, "did you mean \"on-sphere\"?"));
  CHECK(Contains(work.Run({"stress", "--help"}).out, "ox,oy,oz,dx,dy,dz,t_min,t_max,source"));
  CHECK(work.Run({"stress", "--replay", "0,0,3,0,0,-1,0,1,0"}).code == 2);
}

TEST_CASE("compare measures pictures, and --fail decides") {
  const Workspace work;
  Film a(8, 4), b(8, 4);
  std::fill(a.rgb.begin(), a.rgb.end(), 0.5f);
  b.rgb = a.rgb;
  b.pixel(3, 1)[1] = 1.0f;
  REQUIRE(WritePfm(a, work / "a.pfm").ok());
  REQUIRE(WritePfm(b, work / "b.pfm").ok());
  const Outcome measured =
      work.Run({"compare", work / "a.pfm", work / "b.pfm", work / "a.pfm", "--json"});
  REQUIRE(measured.code == 0);
  const json pictures = json::parse(measured.out)["pictures"];
  REQUIRE(pictures.size() == 2);
  CHECK(pictures[0]["rmse"].get<double>() == doctest::Approx(std::sqrt(0.25 / 96)));
  CHECK(pictures[0]["psnr"].get<double>() == doctest::Approx(-10 * std::log10(0.25 / 96)));
  CHECK(pictures[0]["largest"] == 0.5);
  CHECK(pictures[0]["over"].is_number_integer());
  CHECK(pictures[0]["over"] == 1);
  CHECK(pictures[0]["identical"] == false);
  CHECK(pictures[0]["finite"] == true);
  CHECK(pictures[0]["flip"].get<double>() > 0);
  CHECK(pictures[1]["rmse"] == 0);
  CHECK(pictures[1]["flip"] == 0);
  CHECK(pictures[1]["psnr"].is_null());
  CHECK(pictures[1]["identical"] == true);
  const auto judge = [&](const std::string& limits) {
    return work.Run({"compare", work / "a.pfm", work / "b.pfm", "--fail", limits});
  };
  CHECK(judge("over=1,psnr=25").code == 0);
  CHECK(judge("over=0").code == 1);
  CHECK(judge("psnr=26").code == 1);
  CHECK(Contains(judge("over=0").out, "over 1 breaks the limit of 0"));
  CHECK(Contains(judge("rmse=1,over=0,psnr=26").out,
                 "; over 1 breaks the limit of 0, psnr 25.8433 breaks the limit of 26\n"));
  const Outcome several = work.Run(
      {"compare", work / "a.pfm", work / "b.pfm", "--json", "--fail", "largest=0.25,rmse=0"});
  CHECK(json::parse(several.out)["pictures"][0]["broken"].size() == 2);

  // NaN passes no limit, though it equals itself; white against black is 0 dB.
  Film nan = a, black(8, 4), white(8, 4);
  nan.rgb[5] = std::nanf("");
  std::fill(black.rgb.begin(), black.rgb.end(), 0.0f);
  std::fill(white.rgb.begin(), white.rgb.end(), 1.0f);
  REQUIRE(WritePfm(nan, work / "nan.pfm").ok());
  REQUIRE(WritePfm(black, work / "black.pfm").ok());
  REQUIRE(WritePfm(white, work / "white.pfm").ok());
  const Outcome not_finite =
      work.Run({"compare", work / "nan.pfm", work / "nan.pfm", "--fail", "over=100000", "--json"});
  CHECK(not_finite.code == 1);
  const json entry = json::parse(not_finite.out)["pictures"][0];
  CHECK(entry["identical"] == true);
  CHECK(entry["finite"] == false);
  CHECK(work.Run({"compare", work / "a.pfm", work / "nan.pfm"}).code == 0);
  REQUIRE(WritePfm(a, work / "e\x1b[31m.pfm").ok());
  const Outcome odd = work.Run({"compare", work / "a.pfm", work / "e\x1b[31m.pfm"});
  CHECK(odd.code == 0);
  CHECK(!Contains(odd.out, "\x1b"));
  CHECK(
      Contains(work.Run({"compare", work / "black.pfm", work / "white.pfm"}).out, "psnr 0.00 dB"));
  CHECK(judge("psnr").code == 2);
  CHECK(judge("beauty=1").code == 2);
  CHECK(work.Run({"compare", work / "a.pfm"}).code == 2);
  CHECK(work.Run({"compare", work / "a.pfm", work / "none.pfm"}).code == 4);
}

TEST_CASE("--aov heat shows rays and lanes of each tile") {
  const Workspace work;
  const std::string pfm = work / "a.pfm";
  const std::vector<std::string> render = {"render", kScene,  "--size", "50x40", "--tile",
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

// ---- Models, parts, conversions ----

constexpr char kTriangle[] = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

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
  WriteText(work / "a.obj", std::string(kTriangle) + "f 1 2 9\n");
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
  CHECK(Contains(odd.out, "e\\u001B[31m.obj: sound: 1 object, 0 spheres, 1 triangle, 1 light, 1 "));
}

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

TEST_CASE("without arguments the help goes to stderr, and the code is 2") {
  const Outcome nothing = Workspace().Run({});
  CHECK(nothing.code == 2);
  CHECK(nothing.out.empty());
  CHECK(Contains(nothing.err, "Usage:"));
}

TEST_CASE("usage errors: one line on stderr, code 2, no file") {
  const Workspace work;
  const std::string png = work / "a.png";
  const struct {
    std::vector<std::string> arguments;
    std::string says;
  } cases[] = {
      {{"rendr"}, "did you mean \"render\"?"},
      {{"help"}, "did you mean \"--help\"?"},
      {{"version"}, "did you mean \"--version\"?"},
      {{"render", "--", kScene, "-o", png}, "unknown option \"-o\""},
      {{"convert", kScene, "-o", work / "a.json", "--bits", "16"}, "--bits: for pictures"},
      {{"convert", kScene, "-o", work / "a.json", "--transfer", "keep"}, "--transfer: for pict"},
      {{"convert", work / "b.pfm", "-o", png, "--eye", "1,2,3"}, "--eye: for scenes"},
      {{"render", kScene, "-o", png, "--camera", "up", "--eye", "0,0,9"},
       "\"front\", which is not"},
      {{"render", kScene, "-o", work / "{camera}.png", "--views", "sides", "--fov", "9"},
       "--fov: m"},
      {{"compare", kScene, "--camera", "up", "--look-at", "0,0,9"}, "--look-at: moves"},
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
      {{"render", kScene, "-o", png, "--tile", "257"}, "--tile"},
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
      {{"info", kScene, "extra"}, "extra"},
      {{"render", kScene, "-o", ""}, "--output: the path is empty"},
      {{"render", kScene, "-o", png, "--json="}, "--json=: nothing follows"},
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
  for (const auto& wrong : cases) {
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

TEST_CASE("an unknown target lists every usable one") {
  const Workspace work;
  const json targets = json::parse(work.Run({"info", "--json"}).out)["targets"];
  const Outcome outcome = work.Render({"-o", work / "a.png", "--target", "mmx"});
  CHECK(outcome.code == 2);
  for (const std::string name : targets["usable"]) CHECK(Contains(outcome.err, name));
  CHECK(Contains(outcome.err, "auto, scalar"));
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
  REQUIRE(WritePng(image, Transfer::kLinear, work / "c-texture-1.png").ok());
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

}  // namespace
}  // namespace sheaf
