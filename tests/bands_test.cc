// RenderRows: bands have the bits of the whole picture; sinks that wait, fail, stop and throw.
#include <oneapi/tbb/global_control.h>

#include <algorithm>
#include <chrono>
#include <new>
#include <thread>
#include <tuple>

#include "same_bits.h"
#include "sheaf/render.h"
#include "targets.h"
#include "test_frames.h"

namespace sheaf {
namespace {

// Threads that the tests ask for run, on any number of cores.
const oneapi::tbb::global_control kThreads(oneapi::tbb::global_control::max_allowed_parallelism, 5);

// The film that RenderRows hands over, checked for the heights of its bands.
Film RenderInBands(const Scene& scene, const Camera& camera, const RenderOptions& options,
                   int band_height, RenderStats& stats) {
  const PixelRect area = options.crop.value_or(PixelRect{0, 0, options.width, options.height});
  Film film(area.width(), area.height());
  int next_row = 0;
  RenderProgress progress;
  const RowSink append = [&](const Film& rows) {
    CHECK(rows.width == film.width);
    CHECK(rows.height == std::min(band_height, film.height - next_row));
    CHECK(rows.rgb.size() == 3 * static_cast<std::size_t>(rows.width * rows.height));
    std::copy(rows.rgb.begin(), rows.rgb.end(), film.pixel(0, next_row));
    next_row += rows.height;
    return Status(Done{});
  };
  REQUIRE(RenderRows(scene, camera, options, append, &stats, &progress).ok());
  CHECK(next_row == film.height);
  CHECK(progress.pixels_done == static_cast<std::uint64_t>(film.width * film.height));
  return film;
}

void CheckBands(const Scene& scene, RenderOptions options) {
  struct Case {
    int tile_size, band_rows, band_height;  // what is asked for, what comes
  };
  // 90 rows are 3 rows of tiles of 32, 13 of 7 and 90 of 1.
  const Case cases[] = {{32, 1, 32}, {32, 32, 32}, {32, 33, 64}, {32, 0, 96}, {7, 1, 7},
                        {7, 15, 21}, {64, 1, 64},  {1, 1, 1},    {1, 13, 13}, {32, 65536, 96}};
  RenderStats whole_stats;
  const Film whole = RenderOrFail(scene, scene.cameras[0], options, &whole_stats);
  for (const Case& bands : cases) {
    for (const int threads : {1, 2, 5}) {
      CAPTURE(bands.tile_size);
      CAPTURE(bands.band_rows);
      CAPTURE(threads);
      options.tile_size = bands.tile_size;
      options.band_rows = bands.band_rows;
      options.threads = threads;
      RenderStats stats;
      const Film film = RenderInBands(scene, scene.cameras[0], options, bands.band_height, stats);
      CHECK(PixelsThatDiffer(film, whole) == 0);
      CHECK(stats.rays.primary == whole_stats.rays.primary);
      CHECK(stats.rays.shadow == whole_stats.rays.shadow);
      CHECK(stats.rays.reflected == whole_stats.rays.reflected);
      CHECK(stats.rays.refracted == whole_stats.rays.refracted);
      CHECK(stats.rays.beyond_depth == whole_stats.rays.beyond_depth);
      CHECK(stats.threads <= threads);
      CHECK(stats.wall_seconds > 0.0);
    }
  }
}

TEST_CASE("bands of any height have the same bits as the whole picture") {
  const Scene scene = EverythingScene(5);
  RenderOptions options;
  options.width = 51;
  options.height = 90;
  options.samples = 2;
  for (const Precision precision : {Precision::kStrict, Precision::kDouble}) {
    options.precision = precision;
    options.target = Target::Scalar();
    CheckBands(scene, options);
    options.target = Target();
    ForEachTarget([&](Target target) {
      options.target = target;
      CheckBands(scene, options);
    });
  }
}

TEST_CASE("bands of a crop have the same bits as the crop") {
  const Scene scene = EverythingScene(6);
  RenderOptions options;
  options.width = 200;
  options.height = 150;
  for (const PixelRect& crop : {PixelRect{13, 50, 44, 140}, PixelRect{199, 60, 200, 150}}) {
    options.crop = crop;
    options.target = Target::Scalar();
    CheckBands(scene, options);
    options.target = Target();
    CheckBands(scene, options);
  }
}

TEST_CASE("a band is small beside a large picture and the whole of a small one") {
  Scene scene;
  const Camera camera{"c", {0, 0, 5}, {0, 0, 0}, {0, 1, 0}, Perspective{}};
  RenderOptions options;
  options.max_depth = 0;
  for (const auto& [width, height, largest] :
       {std::tuple(1280, 960, 64), {8192, 1024, 32}, {65536, 70, 32}, {1, 65536, 32768}}) {
    options.width = width;
    options.height = height;
    options.threads = 2;
    int highest = 0;
    const RowSink measure = [&](const Film& rows) {
      highest = std::max(highest, rows.height);
      return Status(Done{});
    };
    REQUIRE(RenderRows(scene, camera, options, measure).ok());
    CAPTURE(width);
    CHECK(highest <= largest);
    CHECK(highest >= std::min(height, largest) * 3 / 4);
  }
}

TEST_CASE("a sink has a band while the next renders") {
  const Scene scene = CrystalBall();
  RenderOptions options;
  options.band_rows = 32;
  RenderProgress progress;
  const std::uint64_t band_pixels = 32 * 640;
  bool overlapped = false;
  int calls = 0;
  const RowSink wait_for_more = [&](const Film&) {
    // The first band does not come back before pixels of the second are there.
    for (int i = 0; calls == 0 && i < 10000 && !overlapped; ++i) {
      overlapped = progress.pixels_done > band_pixels;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    ++calls;
    return Status(Done{});
  };
  REQUIRE(RenderRows(scene, scene.cameras[0], options, wait_for_more, nullptr, &progress).ok());
  CHECK(overlapped);
  CHECK(calls == 15);
}

TEST_CASE("a sink that fails ends the frame with its error") {
  const Scene scene = CrystalBall();
  for (const int failing_call : {1, 2, 14, 15}) {
    RenderOptions options;
    options.band_rows = 32;
    RenderProgress progress;
    int calls = 0;
    const RowSink fail = [&](const Film&) {
      if (++calls < failing_call) return Status(Done{});
      return Status(Error{ErrorKind::kInputOutput, "the disk is full"});
    };
    const Status status = RenderRows(scene, scene.cameras[0], options, fail, nullptr, &progress);
    REQUIRE(!status.ok());
    CHECK(status.error().kind == ErrorKind::kInputOutput);
    CHECK(status.error().message == "the disk is full");
    CHECK(calls == failing_call);
    CHECK(progress.stop);
    // The band in work at most.
    CHECK(progress.pixels_done <= static_cast<std::uint64_t>(failing_call + 1) * 32 * 640);
  }
}

TEST_CASE("after a stop no more rows are handed over") {
  const Scene scene = CrystalBall();
  RenderOptions options;
  options.band_rows = 32;
  RenderProgress progress;
  int calls = 0;
  const RowSink stop = [&](const Film&) {
    ++calls;
    progress.stop = true;
    return Status(Done{});
  };
  const Status status = RenderRows(scene, scene.cameras[0], options, stop, nullptr, &progress);
  REQUIRE(!status.ok());
  CHECK(status.error().kind == ErrorKind::kInterrupted);
  CHECK(calls == 1);
}

TEST_CASE("what a sink throws is thrown") {
  const Scene scene = CrystalBall();
  RenderOptions options;
  for (const int band_rows : {32, 480}) {
    options.band_rows = band_rows;
    const RowSink full = [](const Film&) -> Status { throw std::bad_alloc(); };
    CHECK_THROWS_AS((void)RenderRows(scene, scene.cameras[0], options, full), std::bad_alloc);
  }
}

}  // namespace
}  // namespace sheaf
