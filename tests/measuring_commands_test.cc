// The commands that measure: compare, bench, pareto, stress.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "src/formats/pfm.h"
#include "src/formats/png.h"
#include "src/lab/has_program.h"
#include "tests/run_command.h"

namespace sheaf {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

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
  const json report = json::parse(ReadText(before));
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
  const bool is_noisy = Contains(verdict(faster), "noisy");
  if (!is_noisy) CHECK(Contains(verdict(faster), "faster"));
  CHECK(faster.code == (is_noisy ? 5 : 0));
  auto few = bench;
  few.insert(few.end(), {"--targets", "auto", "--baseline", before});
  few[5] = "2";
  const Outcome too_few = work.Run(few);
  CHECK(Contains(too_few.out, "too few repetitions"));
  CHECK(too_few.code == 5);
  few[5] = "6";
  CHECK(Contains(work.Run(few).out, "95 % interval"));
}

TEST_CASE("bench tells what it measured on, and judges on the same processor and build alone") {
  const Workspace work;
  const std::string before = work / "before.json";
  const std::vector<std::string> bench = {"bench",     kScene, "--size",        "64x48",
                                          "--targets", "auto", "--repetitions", "4"};
  auto arguments = bench;
  arguments.push_back("--json=" + before);
  REQUIRE(work.Run(arguments).code == 0);
  const json report = json::parse(ReadText(before));
  for (const char* key : {"processor", "compiler", "flags", "build_type", "affinity", "date"}) {
    CHECK_MESSAGE(report[key].is_string(), std::string(key));
  }
  for (const char* key : {"cores", "load", "other_cores"}) {
    CHECK_MESSAGE(report[key].is_number(), std::string(key));
  }
  // The buffers of a frame are there before a clock starts: it touches hardly a new page.
#ifndef __SANITIZE_ADDRESS__  // its allocator keeps freed memory from being used again
  CHECK(report["rows"][0]["page_faults"].get<int>() < 40);
#endif
  CHECK(report["rows"][0]["calibration"].size() == 4);

  arguments = bench;
  arguments.insert(arguments.end(), {"--baseline", before});
  for (const char* key : {"processor", "compiler", "flags", "build_type", "affinity"}) {
    json changed = report;
    changed[key] = "another";
    WriteText(before, changed.dump());
    const Outcome refused = work.Run(arguments);
    CHECK(refused.code == 2);
    CHECK(Contains(refused.err, "is \"another\", here it is"));
    CHECK(Contains(refused.err, "--force"));
  }
  auto forced = arguments;
  forced.push_back("--force");
  CHECK(Contains(work.Run(forced).out, "against the baseline"));
  // One that was very noisy is no silent baseline.
  CHECK(LineCount(work.Run(bench).err) == 0);
}

TEST_CASE("bench refuses an earlier run of another frame and replaces nothing that it reads") {
  const Workspace work;
  const std::string before = work / "before.json";
  std::vector<std::string> few = {"bench", kScene, "--size", "64x48", "--repetitions", "1"};
  auto first = few;
  first.push_back("--json=" + before);
  REQUIRE(work.Run(first).code == 0);
  const json report = json::parse(ReadText(before));
  few.insert(few.end(), {"--targets", "auto", "--baseline", before});
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
  CHECK(work.Run(few).code == 4);
  CHECK(work.Run({"bench", kScene, "--baseline", work / "none"}).code == 4);
  CHECK(work.Run({"bench", kScene, "--targets", "avx9"}).code == 2);
}

TEST_CASE("diff shows where pictures differ") {
  const Workspace work;
  Film a(4, 3), b(4, 3);
  std::fill(a.rgb.begin(), a.rgb.end(), 0.5f);
  b.rgb = a.rgb;
  b.pixel(2, 1)[0] = 0.75f;
  b.pixel(0, 2)[2] = 0.375f;
  REQUIRE(WritePfm(a, work / "a.pfm").ok());
  REQUIRE(WritePfm(b, work / "b.pfm").ok());
  const auto diff = [&](const std::string& output, const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"diff", work / "a.pfm", work / "b.pfm", "-o",
                                          work / output};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = work.Run(arguments);
    CHECK(outcome.code == 0);
    CHECK(Contains(outcome.out, "b.pfm: largest "));
    return outcome.out;
  };
  const std::string text = diff("d.png", {});
  CHECK(Contains(text, "largest difference 0.25 at (2, 1)"));
  CHECK(Contains(text, "grey is equal, white is +0.25 and more, black -0.25"));
  const Result<Picture8> shown = ReadPng(work / "d.png");
  REQUIRE(shown.ok());
  const auto pixel = [&](int x, int y) { return &shown.value().rgb[3 * (4 * y + x)]; };
  CHECK(int{pixel(0, 0)[0]} == 128);  // equal
  CHECK(int{pixel(2, 1)[0]} == 255);  // the largest, upwards
  CHECK(int{pixel(0, 2)[2]} == 64);   // half as much, downwards
  diff("d.pfm", {"--scale", "2"});
  const Result<Film> numbers = ReadPfm(work / "d.pfm");
  REQUIRE(numbers.ok());
  CHECK(numbers.value().pixel(2, 1)[0] == 0.5f);
  CHECK(numbers.value().pixel(0, 2)[2] == -0.25f);
  diff("e.pfm", {"--show", "absolute"});
  const Result<Film> sizes = ReadPfm(work / "e.pfm");
  REQUIRE(sizes.ok());
  CHECK(sizes.value().pixel(0, 2)[2] == 0.125f);
  CHECK(Contains(diff("f.png", {"--show", "flip"}), "largest FLIP error"));
  const Outcome same = work.Run({"diff", work / "a.pfm", work / "a.pfm", "-o", work / "g.png"});
  CHECK(Contains(same.out, "a.pfm: no difference"));
  CHECK(work.Run({"diff", work / "a.pfm", work / "b.pfm", "-o", work / "a.pfm"}).code == 2);
  REQUIRE(WritePfm(Film(2, 2), work / "small.pfm").ok());
  CHECK(work.Run({"diff", work / "a.pfm", work / "small.pfm", "-o", work / "h.png"}).code == 2);
}

TEST_CASE("compare prints each picture as it comes, with a mean") {
  const Workspace work;
  Film a(4, 3), b(4, 3);
  std::fill(a.rgb.begin(), a.rgb.end(), 0.5f);
  std::fill(b.rgb.begin(), b.rgb.end(), 0.75f);
  REQUIRE(WritePfm(a, work / "a.pfm").ok());
  REQUIRE(WritePfm(b, work / "b.pfm").ok());
  const Outcome two = work.Run({"compare", work / "a.pfm", work / "a.pfm", work / "b.pfm"});
  CHECK(LineCount(two.out) == 2);
  CHECK(Contains(two.out, "(mean so far: rmse 0.125, "));
  // What came before a picture that cannot be read is told.
  const Outcome cut = work.Run({"compare", work / "a.pfm", work / "b.pfm", work / "none.pfm"});
  CHECK(cut.code == 4);
  CHECK(Contains(cut.out, "b.pfm: rmse 0.25"));
  const Outcome listed =
      work.Run({"compare", work / "a.pfm", work / "a.pfm", work / "b.pfm", "--json"});
  CHECK(json::parse(listed.out)["mean"]["rmse"] == 0.125);
}

TEST_CASE("pareto charts error and time against place and scale") {
  const Workspace work;
  const Outcome outcome =
      work.Run({"pareto", kScene, "--size", "32x24", "--repetitions", "1", "--moved", "100,1e6",
                "--scaled", "0.001", "-o", work / "report"});
  REQUIRE(outcome.code == 0);
  CHECK(Contains(outcome.out, "moved by 100 "));
  const json report = json::parse(ReadText(work / "report/front-places.json"));
  // By POV-Ray too, where that is.
  const std::size_t renderers = HasProgram("povray") ? 4 : 3;
  REQUIRE(report["points"].size() == 4 * renderers);
  CHECK(report["points"][2]["precision"] == "double");
  CHECK(report["points"][2]["error"] == 0);  // the reference itself
  for (const json& point : report["points"]) {
    if (point["precision"] == "POV-Ray") {
      if (point["moved"] == 0 && point["scaled"] == 1) CHECK(point["over"].get<int>() <= 5);
      continue;
    }
    CHECK(point["seconds"].get<double>() > 0);
    if (point["precision"] != "fast") CHECK(point["over"].get<int>() <= 5);
  }
  const std::string csv = ReadText(work / "report/front-places.csv");
  CHECK(LineCount(csv) == 1 + 4 * renderers);
  CHECK(Contains(csv, "moved,scaled,precision,seconds,over,error"));
  if (HasProgram("gnuplot")) {
    CHECK(fs::exists(work / "report/front-places.svg"));
    CHECK(fs::exists(work / "report/front-places.png"));
  }
  for (const std::string wrong : {"", "1,", "-1", "x", "nan"}) {
    CHECK(work.Run({"pareto", kScene, "-o", work / "r", "--moved", wrong}).code == 2);
  }
  CHECK(work.Run({"pareto", kScene, "-o", work / "r", "--scaled", "0"}).code == 2);
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

}  // namespace
}  // namespace sheaf
