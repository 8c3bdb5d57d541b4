// Frames that are given time: whatever round it ends in, the picture is that of the error reached.
#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>

#include "run_command.h"
#include "same_bits.h"
#include "sheaf/render.h"
#include "src/formats/pfm.h"
#include "src/render/render_frame.h"
#include "src/render/render_rounds.h"
#include "test_frames.h"

namespace sheaf {
namespace {

RenderOptions SmallFrame() {
  RenderOptions options;
  options.width = 41;
  options.height = 33;
  options.samples = 500;  // no power of two: some pixels get all
  options.budget = 1;
  return options;
}

// Renders until the clock has been asked so many times.
struct Timed {
  Film film;
  RenderStats stats;
};
Timed RenderFor(std::uint64_t looks, const Scene& scene, const RenderOptions& options) {
  Timed timed;
  std::atomic<std::uint64_t> count{0};
  const TimeUsed used = [&] { return count.fetch_add(1) < looks ? 0.0 : 1.0; };
  const BandSink keep = [&](Film& film) {
    timed.film = std::move(film);
    return Status(Done{});
  };
  ScenePreparer preparer(scene);
  RenderProgress progress;
  const Status rendered =
      RenderWhile(used, preparer, scene.cameras[0], options, keep, timed.stats, progress);
  if (!rendered) FAIL(rendered.error().message);
  CHECK(progress.pixels_done == timed.film.pixel_count());
  return timed;
}

// What --error alone makes of the goal that was reached.
RenderOptions SameByError(RenderOptions options, const RenderStats& stats) {
  options.budget.reset();
  options.error = stats.reached.error;
  return options;
}

constexpr std::uint64_t kForever = std::numeric_limits<std::uint64_t>::max();

TEST_CASE("goals fall by about a fifth and are the doubles next to their decimals") {
  CHECK(RoundGoal(0) == 1.0);
  CHECK(RoundGoal(5) == 0.315);
  CHECK(RoundGoal(10) == 0.1);
  CHECK(RoundGoal(19) == 0.0125);
  CHECK(RoundGoal(22) == 0.0063);
  CHECK(RoundGoal(50) == kLeastGoal);
  for (int i = 0; i < 50; ++i) {
    CHECK(RoundGoal(i + 1) < 0.81 * RoundGoal(i));
    CHECK(RoundGoal(i + 1) > 0.77 * RoundGoal(i));
  }
}

TEST_CASE("whenever the time ends, the picture has the bits of the error reached") {
  const Scene scene = SoftScene();
  RenderOptions options = SmallFrame();
  const auto check = [&] {
    int last = 0;
    for (const std::uint64_t looks : {0u, 1u, 60u, 400u, 1500u, 4000u}) {
      CAPTURE(looks);
      const Timed timed = RenderFor(looks, scene, options);
      const int rounds = timed.stats.reached.rounds;
      CHECK(rounds >= std::max(last, 1));
      last = rounds;
      CHECK(timed.stats.reached.error == RoundGoal(rounds - 1));
      const Film film = RenderOrFail(scene, scene.cameras[0], SameByError(options, timed.stats));
      CHECK(PixelsThatDiffer(timed.film, film) == 0);
      CHECK(timed.stats.reached.samples >= 16 * film.pixel_count());
      CHECK(timed.stats.reached.samples <= timed.stats.rays.primary);
    }
    CHECK(last > 10);
  };
  options.threads = 1;
  ForEachTarget([&](Target target) {
    options.target = target;
    check();
  });
  options.target = {};
  options.threads = 2;
  options.tile_size = 7;
  check();
  options.precision = Precision::kDouble;
  check();
}

TEST_CASE("the scalar baseline goes on likewise") {
  const Scene scene = SoftScene();
  RenderOptions options = SmallFrame();
  options.target = Target::Scalar();
  for (const std::uint64_t looks : {0u, 3000u, 9000u}) {
    const Timed timed = RenderFor(looks, scene, options);
    CHECK((looks == 0) == (timed.stats.reached.rounds == 1));
    const RenderOptions same = SameByError(options, timed.stats);
    CHECK(PixelsThatDiffer(timed.film, RenderOrFail(scene, scene.cameras[0], same)) == 0);
  }
}

TEST_CASE("the time may end within a round, whose work does not show") {
  const Scene scene = SoftScene();
  RenderOptions options = SmallFrame();
  options.threads = 1;
  bool was_cut = false;
  for (std::uint64_t looks = 100; looks < 130; ++looks) {
    const Timed timed = RenderFor(looks, scene, options);
    was_cut = was_cut || timed.stats.rays.primary > timed.stats.reached.samples;
    const RenderOptions same = SameByError(options, timed.stats);
    CHECK(PixelsThatDiffer(timed.film, RenderOrFail(scene, scene.cameras[0], same)) == 0);
  }
  CHECK(was_cut);
}

TEST_CASE("an error ends the work before the time does, and no ray was traced twice") {
  const Scene scene = SoftScene();
  RenderOptions options = SmallFrame();
  options.error = 0.03;  // no round's goal
  const Timed timed = RenderFor(kForever, scene, options);
  CHECK(timed.stats.reached.error == 0.03);
  RenderStats stats;
  const Film film =
      RenderOrFail(scene, scene.cameras[0], SameByError(options, timed.stats), &stats);
  CHECK(PixelsThatDiffer(timed.film, film) == 0);
  CHECK(timed.stats.rays.primary == stats.rays.primary);
  CHECK(timed.stats.rays.shadow == stats.rays.shadow);
  CHECK(timed.stats.reached.samples == stats.rays.primary);
  CHECK(stats.reached.rounds == 0);
}

TEST_CASE("the work ends where all pixels have all samples") {
  const Scene scene = SoftScene();
  RenderOptions options = SmallFrame();
  options.samples = 40;
  const Timed timed = RenderFor(kForever, scene, options);
  CHECK(timed.stats.reached.samples == 40u * timed.film.pixel_count());
  const Film film = RenderOrFail(scene, scene.cameras[0], SameByError(options, timed.stats));
  CHECK(PixelsThatDiffer(timed.film, film) == 0);
}

TEST_CASE("a crop has the pixels of the whole, and layers are those of the first samples") {
  const Scene scene = SoftScene();
  RenderOptions options = SmallFrame();
  options.error = 0.05;
  for (const Layer layer :
       {Layer::kDepth, Layer::kNormal, Layer::kAlbedo, Layer::kId, Layer::kHeat}) {
    options.layers.Add(layer);
  }
  options.crop = PixelRect{5, 9, 38, 30};
  for (const Target& target : {Target(), Target::Scalar()}) {
    options.target = target;
    const Timed timed = RenderFor(kForever, scene, options);
    const Film film = RenderOrFail(scene, scene.cameras[0], SameByError(options, timed.stats));
    CHECK(PixelsThatDiffer(timed.film, film) == 0);
    for (int i = 0; i < kLayerCount; ++i) {
      const Film::Floats &layer = timed.film.layers[i], &same = film.layers[i];
      REQUIRE(layer.size() == same.size());
      if (static_cast<Layer>(i) == Layer::kHeat) continue;  // seconds
      CHECK(std::memcmp(layer.data(), same.data(), layer.size() * sizeof(float)) == 0);
    }
    // Rays a pixel of the tile are those of all rounds.
    const int x = 3, y = 4;
    CHECK(timed.film.at(Layer::kHeat, x, y)[2] == film.at(Layer::kHeat, x, y)[2]);
  }
}

TEST_CASE("budgets that cannot be are refused, and a stop ends the frame") {
  const Scene scene = SoftScene();
  RenderOptions options = SmallFrame();
  const auto refuse = [&](const char* message) {
    const Result<Film> film = Render(scene, scene.cameras[0], options);
    REQUIRE_FALSE(film.ok());
    CHECK(film.error().kind == ErrorKind::kUsage);
    CHECK(film.error().message == message);
  };
  for (const double budget : {0.0, -1.0, std::numeric_limits<double>::infinity(),
                              std::numeric_limits<double>::quiet_NaN()}) {
    options.budget = budget;
    refuse("budget must be a number of seconds above 0");
  }
  options.budget = 1;
  options.samples = 15;
  refuse("a budget needs 16 samples or more");
  options.samples = 16;
  options.contrast = 0.1;
  refuse("contrast and budget exclude each other");
  options.contrast.reset();
  RenderProgress progress;
  progress.stop = true;
  const Result<Film> stopped = Render(scene, scene.cameras[0], options, nullptr, &progress);
  REQUIRE_FALSE(stopped.ok());
  CHECK(stopped.error().kind == ErrorKind::kInterrupted);
}

TEST_CASE("the command renders for a while, and says what it reached") {
  const Workspace work;
  const std::string scene = SHEAF_SOURCE_DIR "/scenes/soft-light.json";
  const Outcome timed = work.Run({"render", scene, "--size", "40x30", "--budget", "0.05", "-o",
                                  work / "a.pfm", "--aov", "depth", "--json"});
  CHECK(timed.code == 0);
  const auto frame = nlohmann::json::parse(timed.out)["frames"][0];
  CHECK(frame["budget"] == 0.05);
  CHECK(frame["reached"]["rounds"] >= 1);
  CHECK(frame["reached"]["samples"] >= 16 * 40 * 30);
  const double error = frame["reached"]["error"];
  CHECK(Contains(timed.err, "samples a pixel\nwrote "));
  const Outcome same =
      work.Run({"render", scene, "--size", "40x30", "--error", frame["reached"]["error"].dump(),
                "--spp", "65536", "-o", work / "b.pfm"});
  CHECK(same.code == 0);
  CHECK(error <= 1);
  CHECK(ReadText(work / "a.pfm") == ReadText(work / "b.pfm"));
}

TEST_CASE("what a budget does not go with is refused in one line") {
  const Workspace work;
  const auto refuse = [&](const std::vector<std::string>& more, const std::string& message) {
    std::vector<std::string> words = {"--budget", "1", "-o", work / "{frame}.png"};
    words.insert(words.end(), more.begin(), more.end());
    const Outcome outcome = work.Render(words);
    CHECK(outcome.code == 2);
    CHECK(outcome.err == "sheaf: " + message + "\n");
  };
  const std::string stills =
      "--budget: for stills, as the frames of a sequence would differ in their error; --error "
      "gives all the same";
  refuse({"--frames", "0..3"}, stills);
  refuse({"--turntable", "4"}, stills);
  refuse({"--adaptive", "0.1"}, "--budget: not together with --adaptive");
  refuse({"--resume"}, "--budget, --resume: no part of a picture is done before all is");
  const Outcome none = work.Render({"--budget", "0", "-o", work / "a.png"});
  CHECK(none.code == 2);
  CHECK(Contains(none.err, "--budget: \"0\" is not a number above 0"));
  const Outcome parts =
      work.Run({"submit", kScene, "-o", work / "a.pfm", "--parts", "2", "--budget", "1"});
  CHECK(parts.code == 2);
  CHECK(parts.err ==
        "sheaf: --budget: parts would differ in their error; --error gives all the same\n");
  CHECK(work.Files().empty());
}

}  // namespace
}  // namespace sheaf
