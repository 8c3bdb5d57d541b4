// Options out of range and stops.
#include <chrono>
#include <thread>

#include "sheaf/render.h"
#include "test_frames.h"

namespace sheaf {
namespace {

TEST_CASE("options out of range are refused") {
  const Scene scene = CrystalBall();
  const auto refused = [&](RenderOptions options) {
    const Result<Film> film = Render(scene, scene.cameras[0], options);
    return !film.ok() && film.error().kind == ErrorKind::kUsage;
  };
  RenderOptions options;
  CHECK(!refused(options));
  options.width = 0;
  CHECK(refused(options));
  options = {};
  options.tile_size = kMaxTileSize + 1;
  CHECK(refused(options));
  options = {};
  options.crop = PixelRect{0, 0, 641, 10};
  CHECK(refused(options));
  options.crop = PixelRect{5, 5, 5, 10};
  CHECK(refused(options));

  const auto rows_refused = [&](int band_rows) {
    RenderOptions bands;
    bands.width = bands.height = 8;
    bands.band_rows = band_rows;
    const RowSink ignore = [](const Film&) { return Status(Done{}); };
    const Status status = RenderRows(scene, scene.cameras[0], bands, ignore);
    return !status && status.error().kind == ErrorKind::kUsage;
  };
  CHECK(rows_refused(-1));
  CHECK(rows_refused(kMaxImageSide + 1));
  CHECK(!rows_refused(kMaxImageSide));
}

TEST_CASE("a stop during a pixel ends it") {
  const Scene scene = CrystalBall();
  for (const Target target : {Target::Scalar(), Target()}) {
    RenderOptions options;
    options.target = target;
    options.samples = kMaxSamples;  // hours, if it were not stopped
    options.threads = 1;
    RenderProgress progress;
    std::thread stopper([&] {
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
      progress.stop = true;
    });
    const Result<Film> film = Render(scene, scene.cameras[0], options, nullptr, &progress);
    stopper.join();
    CHECK(!film.ok());
  }
}

TEST_CASE("a stop that was asked for gives no film") {
  const Scene scene = CrystalBall();
  RenderProgress progress;
  progress.stop = true;
  const Result<Film> film = Render(scene, scene.cameras[0], {}, nullptr, &progress);
  REQUIRE(!film.ok());
  CHECK(film.error().kind == ErrorKind::kInterrupted);
}

}  // namespace
}  // namespace sheaf
