// Adaptive sampling.
#include <cmath>

#include "same_bits.h"
#include "sheaf/render.h"
#include "test_frames.h"

namespace sheaf {
namespace {

double RootMeanSquare(const Film& a, const Film& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.rgb.size(); ++i) {
    const double difference = double{a.rgb[i]} - double{b.rgb[i]};
    sum += difference * difference;
  }
  return std::sqrt(sum / static_cast<double>(a.rgb.size()));
}

TEST_CASE("adaptive sampling has the same bits on every target") {
  RenderOptions options;
  options.width = 90;
  options.height = 70;
  options.samples = 4;
  for (const double contrast : {0.0, 0.1, 1.0}) {
    options.contrast = contrast;
    CheckSameBits(CrystalBall(), CrystalBall().cameras[0], options);
    const Scene scene = EverythingScene(5);
    for (const Camera& camera : scene.cameras) CheckSameBits(scene, camera, options);
  }
}

TEST_CASE("adaptive sampling spends its rays at edges") {
  const Scene scene = CrystalBall();
  RenderOptions options;
  options.width = 160;
  options.height = 120;
  const Film single = RenderOrFail(scene, scene.cameras[0], options);
  options.samples = 16;
  RenderStats full_stats, stats;
  const Film full = RenderOrFail(scene, scene.cameras[0], options, &full_stats);
  options.contrast = 0.05;
  const Film film = RenderOrFail(scene, scene.cameras[0], options, &stats);
  CHECK(stats.rays.traced() < full_stats.rays.traced() / 2);
  CHECK(RootMeanSquare(film, full) < RootMeanSquare(single, full) / 2);
}

}  // namespace
}  // namespace sheaf
