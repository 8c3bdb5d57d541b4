// Samples until a pixel's error is small: the same bits everywhere, and the error that was asked
// for.
#include "src/scalar/converge.h"

#include <cmath>

#include "same_bits.h"
#include "sheaf/render.h"
#include "src/render/sample_pattern.h"
#include "test_frames.h"

namespace sheaf {
namespace {

TEST_CASE("frames with an error to reach have the same bits on every target, tile and crop") {
  const Scene scene = SoftScene();
  RenderOptions options;
  options.width = 61;
  options.height = 47;
  options.samples = 100;
  options.error = 0.02;
  for (const Precision precision : {Precision::kStrict, Precision::kDouble}) {
    options.precision = precision;
    CheckSameBits(scene, scene.cameras[0], options);
  }
}

TEST_CASE("the error asked for is reached, with fewer samples where there is little to see") {
  const Scene scene = SoftScene();
  RenderOptions options;
  options.width = 120;
  options.height = 90;
  options.samples = 16384;
  options.error = 0.002;
  const Film converged = RenderOrFail(scene, scene.cameras[0], options);
  std::uint64_t last = 0;
  for (const double error : {0.04, 0.02, 0.01}) {
    options.error = error;
    RenderStats stats;
    const Result<Film> film = Render(scene, scene.cameras[0], options, &stats);
    REQUIRE(film.ok());
    double squares = 0;
    for (std::size_t i = 0; i < film.value().rgb.size(); ++i) {
      const double off =
          static_cast<double>(film.value().rgb[i]) - static_cast<double>(converged.rgb[i]);
      squares += off * off;
    }
    const double rms = std::sqrt(squares / static_cast<double>(film.value().rgb.size()));
    CAPTURE(error);
    CHECK(rms <= error);
    CHECK(stats.rays.primary > last);
    last = stats.rays.primary;
    const std::uint64_t pixels = 120 * 90;
    CHECK(stats.rays.primary >= 16 * pixels);
    CHECK(stats.rays.primary < 400 * pixels);
  }
}

TEST_CASE("a pixel is done when its samples say so") {
  using scalar::IsConverged;
  // All alike: an error of a quarter over n of the mean is left.
  CHECK_FALSE(IsConverged(16.0, 16.0, 16, 0.015));
  CHECK(IsConverged(16.0, 16.0, 16, 0.016));
  CHECK(IsConverged(0.0, 0.0, 16, 1e-9));
  // Half of 64 samples lit: a standard error of 0.5 / sqrt(63).
  CHECK_FALSE(IsConverged(32.0, 32.0, 64, 0.0629));
  CHECK(IsConverged(32.0, 32.0, 64, 0.0631));
  // Bright pixels by their part.
  CHECK(IsConverged(3200.0, 320000.0, 64, 0.127));
  CHECK_FALSE(IsConverged(3200.0, 320000.0, 64, 0.125));
  CHECK(scalar::IsJudgedAt(16));
  CHECK(scalar::IsJudgedAt(1024));
  CHECK_FALSE(scalar::IsJudgedAt(8));
  CHECK_FALSE(scalar::IsJudgedAt(48));
}

TEST_CASE("every beginning of Sobol's pattern is spread evenly") {
  const auto points = SobolPattern(256);
  CHECK(static_cast<float>(points[0].x) == 0.5f);
  CHECK(static_cast<float>(points[0].y) == 0.5f);
  for (const int count : {16, 64, 256}) {
    double x = 0, y = 0;
    std::vector<int> columns(static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) {
      const auto point = points[static_cast<std::size_t>(i)];
      x += point.x / count;
      y += point.y / count;
      ++columns[static_cast<std::size_t>(point.x * count)];
    }
    CHECK(std::abs(x - 0.5) <= 0.5 / count + 1e-9);
    CHECK(std::abs(y - 0.5) <= 0.5 / count + 1e-9);
    for (const int column : columns) CHECK(column == 1);
  }
}

}  // namespace
}  // namespace sheaf
