// Distances between floats and between pictures.
#include "src/lab/picture_metrics.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "src/formats/scene_json.h"
#include "src/lab/flip.h"
#include "src/lab/object_at.h"

namespace sheaf {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

Film Filled(int width, int height, float r, float g, float b) {
  Film film(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      float* pixel = film.pixel(x, y);
      pixel[0] = r;
      pixel[1] = g;
      pixel[2] = b;
    }
  }
  return film;
}

TEST_CASE("units in the last place count floats in between") {
  CHECK(UlpDistance(1.0f, 1.0f) == 0);
  CHECK(UlpDistance(1.0f, std::nextafter(1.0f, 2.0f)) == 1);
  CHECK(UlpDistance(-1.0f, std::nextafter(-1.0f, 2.0f)) == 1);
  CHECK(UlpDistance(0.0f, -0.0f) == 1);
  CHECK(UlpDistance(std::numeric_limits<float>::denorm_min(), -0.0f) == 2);
  CHECK(UlpDistance(1.0f, 2.0f) == 1u << 23);
  CHECK(UlpDistance(std::numeric_limits<float>::max(), std::numeric_limits<float>::infinity()) ==
        1);
  CHECK(UlpDistance(kNan, -kNan) == 0);
  CHECK(UlpDistance(kNan, 1.0f) == std::numeric_limits<std::uint32_t>::max());
}

TEST_CASE("the first differing pixel is found, row by row") {
  const Film a = Filled(5, 4, 1, 2, 3);
  Film b = a;
  CHECK(CompareFilms(a, b, 0).pixels == 0);
  b.pixel(4, 1)[2] = std::nextafter(3.0f, 4.0f);
  b.pixel(0, 2)[0] = std::nextafter(std::nextafter(1.0f, 0.0f), 0.0f);
  const FilmDifference any = CompareFilms(a, b, 0);
  CHECK(any.pixels == 2);
  CHECK(any.most_ulps == 2);
  CHECK(any.x == 4);
  CHECK(any.y == 1);
  const FilmDifference more = CompareFilms(a, b, 1);
  CHECK(more.pixels == 1);
  CHECK(more.x == 0);
  CHECK(more.y == 2);
  CHECK(CompareFilms(a, b, 2).pixels == 0);
}

TEST_CASE("NaN equals NaN and nothing else") {
  const Film a = Filled(2, 2, kNan, 0, 0);
  CHECK(MeasurePictures(a, a, Transfer::kLinear).rmse == 0);
  const PictureMetrics metrics = MeasurePictures(a, Filled(2, 2, 0, 0, 0), Transfer::kLinear);
  CHECK(std::isinf(metrics.rmse));
  CHECK(metrics.over == 4);
  CHECK(metrics.mean_flip == 0);  // a display shows both black
}

// What the paper's definition gives where it can be worked out by hand: on uniform pictures the
// filters change nothing and no feature is there, so that only the colour error is left.
TEST_CASE("FLIP of uniform pictures is the colour error alone") {
  const Film black = Filled(40, 40, 0, 0, 0), white = Filled(40, 40, 1, 1, 1);
  CHECK(MeanFlip(black, black) == 0);
  // HyAB of black and white is 100; that of green and blue, with Hunt's effect, 308.6.
  CHECK(MeanFlip(black, white) == doctest::Approx(0.9670).epsilon(1e-3));
  CHECK(MeanFlip(Filled(40, 40, 0, 1, 0), Filled(40, 40, 0, 0, 1)) ==
        doctest::Approx(1).epsilon(1e-6));
  CHECK(MeanFlip(white, black) == doctest::Approx(MeanFlip(black, white)));
}

TEST_CASE("FLIP weighs what is seen: fine noise less than a shift, features more than colour") {
  const Film grey = Filled(64, 64, 0.5f, 0.5f, 0.5f);
  Film checkered = grey, shifted = grey, dot = grey;
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) {
      for (int i = 0; i < 3; ++i) {
        checkered.pixel(x, y)[i] += ((x + y) & 1) ? 0.1f : -0.1f;
        shifted.pixel(x, y)[i] += 0.1f;
      }
    }
  }
  CHECK(MeanFlip(grey, checkered) < MeanFlip(grey, shifted));
  dot.pixel(32, 32)[1] = 1;
  const double dotted = MeanFlip(grey, dot);
  CHECK(dotted > 0);
  CHECK(dotted < 0.05);
}

TEST_CASE("what a pixel shows") {
  const Result<Scene> scene = ReadSceneJson(SHEAF_SOURCE_DIR "/scenes/crystal-ball.json");
  REQUIRE(scene.ok());
  const Camera& front = scene.value().cameras.at(0);
  const auto name = [&](int x, int y) {
    const auto object = ObjectAt(scene.value(), front, 640, 480, x, y);
    return object ? scene.value().objects[*object].name : "background";
  };
  CHECK(name(0, 0) == "background");
  CHECK(name(355, 220) == "glass ball");
  CHECK(name(270, 150) == "red ball");
  CHECK(name(320, 380) == "floor");
}

}  // namespace
}  // namespace sheaf
