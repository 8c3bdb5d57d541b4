// The denoiser: kernels against the specification bit by bit, what it leaves alone, what it
// removes.
#include <doctest/doctest.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <vector>

#include "bits.h"
#include "noisy_film.h"
#include "sheaf/render.h"
#include "simd/kernels.h"
#include "src/lab/picture_metrics.h"
#include "src/scalar/filter_noise.h"
#include "src/scalar/median_of_six.h"
#include "targets.h"

namespace sheaf {
namespace {

Film DenoiseOrFail(const Film& film, const DenoiseOptions& options = {}) {
  Result<Film> denoised = Denoise(film, options);
  if (!denoised.ok()) FAIL(denoised.error().message);
  return std::move(denoised).value();
}

bool SameColours(const Film& a, const Film& b) {
  REQUIRE(a.rgb.size() == b.rgb.size());
  return std::memcmp(a.rgb.data(), b.rgb.data(), a.rgb.size() * sizeof(float)) == 0;
}

// All planes of a tile with what lies around it.
template <typename Real>
struct RandomPlanes {
  static constexpr std::ptrdiff_t kStride = kDenoiseColumns + 2 * kFilterMargin + 3;
  static constexpr std::ptrdiff_t kFirst = kFilterReach * kStride + kFilterMargin;
  static constexpr std::size_t kSize = kStride * (kDenoiseRows + 2 * kFilterReach);
  static constexpr std::size_t kPlanes = 15;

  // Guides and depths differ little, so that weights are of every size; some pixels are no
  // neighbours, and some colours have no noise.
  explicit RandomPlanes(std::uint64_t seed) {
    UnitNumbers unit(seed);
    for (std::size_t plane = 0; plane < kPlanes; ++plane) {
      numbers[plane].resize(kSize);
      for (std::size_t i = 0; i < kSize; ++i) {
        const double u = unit();
        const bool is_variance = plane == 3 || plane == 4;
        const double scaled = is_variance ? (u < 0.1 ? 0 : 0.2 * u) : u < 0.02 ? 1e15 : u;
        numbers[plane][i] = static_cast<Real>(plane < 3 ? u : scaled);
      }
    }
    const auto at = [&](std::size_t plane) { return numbers[plane].data() + kFirst; };
    for (std::size_t c = 0; c < 3; ++c) view.colour[c] = at(c);
    view.variance = at(3);
    view.mean_variance = at(4);
    for (std::size_t i = 0; i < kGuideCount; ++i) view.guide[i] = at(5 + i);
    view.nearness = at(11);
    view.nearness_x = at(12);
    view.nearness_y = at(13);
    view.nearness_precision = at(14);
  }

  std::vector<Real> numbers[kPlanes];
  NoisyView<Real> view{};
};

template <typename Real>
struct Planes {
  Planes() {
    for (int i = 0; i < 4; ++i) numbers[i].assign(RandomPlanes<Real>::kSize, Real(-7));
  }
  DenoisedOutput<Real> output() {
    const auto at = [&](int i) { return numbers[i].data() + RandomPlanes<Real>::kFirst; };
    return {{at(0), at(1), at(2)}, at(3)};
  }
  std::vector<Real> numbers[4];
};

TEST_CASE_TEMPLATE("the filter on every target", Real, float, double) {
  const RandomPlanes<Real> planes(1);
  for (const std::uint32_t columns : {1u, 2u, 15u, 16u, 33u, kDenoiseColumns}) {
    for (const std::uint32_t rows : {1u, 3u, kDenoiseRows}) {
      for (int step = 1; step < 1 << kDenoiseLevels; step *= 2) {
        const NoisyTile tile{RandomPlanes<Real>::kStride, columns, rows, step};
        Planes<Real> want;
        scalar::FilterNoise(planes.view, tile, want.output());
        ForEachTarget([&](Target target) {
          Planes<Real> have;
          StrictKernels<Real>(target.id()).filter_noise(planes.view, tile, have.output());
          // What lies beside the tile is left alone too.
          for (int i = 0; i < 4; ++i) {
            int differing = 0;
            for (std::size_t k = 0; k < RandomPlanes<Real>::kSize; ++k) {
              differing += !SameBits(want.numbers[i][k], have.numbers[i][k]);
            }
            REQUIRE(differing == 0);
          }
        });
      }
    }
  }
}

TEST_CASE_TEMPLATE("medians on every target", Real, float, double) {
  for (const std::uint32_t count : {1u, 7u, 16u, 35u}) {
    for (const std::ptrdiff_t step : {1, 64}) {
      std::vector<Real> numbers(64 * 6);
      UnitNumbers unit(count);
      for (Real& number : numbers) number = static_cast<Real>(static_cast<int>(20 * unit()));
      std::vector<Real> want(count);
      for (std::uint32_t i = 0; i < count; ++i) {
        Real six[6];
        for (int k = 0; k < 6; ++k) six[k] = numbers[i + static_cast<std::size_t>(k * step)];
        std::sort(six, six + 6);
        want[i] = (six[2] + six[3]) / 2;
        REQUIRE(scalar::MedianOfSix(&numbers[i], step) == want[i]);
      }
      ForEachTarget([&](Target target) {
        std::vector<Real> medians(PaddedCount(count));
        const Kernels<Real> kernels = StrictKernels<Real>(target.id());
        kernels.find_medians(numbers.data(), step, count, medians.data());
        for (std::uint32_t i = 0; i < count; ++i) REQUIRE(SameBits(want[i], medians[i]));
        std::vector<Real> in_place = numbers;
        kernels.find_medians(in_place.data(), step, count, in_place.data());
        for (std::uint32_t i = 0; i < count; ++i) REQUIRE(SameBits(want[i], in_place[i]));
      });
    }
  }
}

TEST_CASE("the same bits on every target, by any number of threads") {
  for (const auto& [width, height] : {std::pair{150, 70}, {1, 1}, {3, 2}, {63, 17}}) {
    CAPTURE(width);
    const Film noisy = WithNoise(RoomFilm(width, height), 2);
    const Film want = DenoiseOrFail(noisy, {Target::Scalar(), 1});
    if (width > 3) CHECK(!SameColours(noisy, want));
    ForEachTarget([&](Target target) {
      for (const int threads : {1, 2, 7}) {
        CHECK(SameColours(want, DenoiseOrFail(noisy, {target, threads})));
      }
    });
  }
}

TEST_CASE("one colour stays to the bit, whatever the layers say") {
  Film flat = RoomFilm(100, 60);
  for (std::size_t i = 0; i < flat.rgb.size(); ++i) flat.rgb[i] = i % 3 == 0 ? 0.3f : 1.7f;
  CHECK(SameColours(flat, DenoiseOrFail(flat)));
  const Film noisy = WithNoise(RoomFilm(100, 60), 1);
  std::copy(std::begin(noisy.layers), std::end(noisy.layers), std::begin(flat.layers));
  CHECK(SameColours(flat, DenoiseOrFail(flat)));
}

TEST_CASE("a picture without noise stays nearly as it is") {
  const Film room = RoomFilm(150, 100);
  const Film denoised = DenoiseOrFail(room);
  CHECK(RootMeanSquare(room, denoised) < 0.0005);
  for (int i = 0; i < kLayerCount; ++i) CHECK(room.layers[i] == denoised.layers[i]);
}

TEST_CASE("noise gets less by the factors that docs/denoising.md states") {
  const Film room = RoomFilm(200, 150);
  const struct {
    int samples;
    double factor;
  } kCases[] = {{1, 3}, {4, 3}, {16, 3}};
  for (const auto& [samples, factor] : kCases) {
    CAPTURE(samples);
    const Film noisy = WithNoise(room, samples);
    const double before = RootMeanSquare(room, noisy);
    const double after = RootMeanSquare(room, DenoiseOrFail(noisy));
    CAPTURE(before);
    CAPTURE(after);
    CHECK(before / after > factor);
  }
}

// The mean of the red light on row y, columns [x0, x1).
double MeanLight(const Film& film, int y, int x0, int x1) {
  double sum = 0;
  for (int x = x0; x < x1; ++x) {
    sum += static_cast<double>(film.pixel(x, y)[0] / film.at(Layer::kAlbedo, x, y)[0]);
  }
  return sum / (x1 - x0);
}

TEST_CASE("edges of each layer keep their sides apart") {
  // Two halves of which one layer alone tells that they are two; noise as large as their contrast.
  for (const Layer layer : {Layer::kAlbedo, Layer::kNormal, Layer::kDepth}) {
    CAPTURE(LayerName(layer));
    Film film(80, 80, GuideLayers());
    for (int y = 0; y < 80; ++y) {
      for (int x = 0; x < 80; ++x) {
        const bool is_right = x >= 40;
        for (int c = 0; c < 3; ++c) {
          film.at(Layer::kAlbedo, x, y)[c] = layer == Layer::kAlbedo && is_right ? 0.8f : 0.5f;
          film.at(Layer::kNormal, x, y)[c] = 0;
          film.pixel(x, y)[c] = is_right ? 1.0f : 0.25f;
        }
        film.at(Layer::kNormal, x, y)[layer == Layer::kNormal && is_right ? 0 : 2] = 1;
        *film.at(Layer::kDepth, x, y) = layer == Layer::kDepth && is_right ? 4.0f : 3.0f;
      }
    }
    const Film denoised = DenoiseOrFail(WithNoise(film, 1));
    for (int y = 10; y < 70; ++y) {
      for (int x = 34; x < 46; ++x) {
        const float expected = x >= 40 ? 1.0f : 0.25f;
        REQUIRE(denoised.pixel(x, y)[0] == doctest::Approx(expected).epsilon(0.45));
      }
    }
    double left = 0, right = 0;
    for (int y = 10; y < 70; ++y) {
      left += MeanLight(denoised, y, 38, 40) / 60;
      right += MeanLight(denoised, y, 40, 42) / 60;
    }
    const double left_light = 0.25 / 0.5, right_light = layer == Layer::kAlbedo ? 1 / 0.8 : 1 / 0.5;
    CHECK(left == doctest::Approx(left_light).epsilon(0.05));
    CHECK(right == doctest::Approx(right_light).epsilon(0.05));
  }
}

TEST_CASE("numbers that are not finite stay where they are, and reach no neighbour") {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  const Film room = RoomFilm(120, 80);
  const Film noisy = WithNoise(room, 2);
  Film broken = noisy;
  broken.pixel(30, 50)[1] = kNan;
  broken.pixel(60, 60)[0] = kInfinity;
  broken.pixel(61, 60)[2] = -kInfinity;
  broken.pixel(0, 79)[0] = 3e38f;
  broken.at(Layer::kAlbedo, 90, 40)[0] = kNan;
  broken.at(Layer::kNormal, 91, 60)[2] = kInfinity;
  *broken.at(Layer::kDepth, 92, 60) = kNan;
  const Film denoised = DenoiseOrFail(broken);
  const int places[][2] = {{30, 50}, {60, 60}, {61, 60}, {0, 79}, {90, 40}, {91, 60}, {92, 60}};
  for (const auto& [x, y] : places) {
    CHECK(std::memcmp(broken.pixel(x, y), denoised.pixel(x, y), 3 * sizeof(float)) == 0);
  }
  int strange = 0;
  for (int y = 0; y < 80; ++y) {
    for (int x = 0; x < 120; ++x) {
      for (int c = 0; c < 3; ++c) {
        const float value = denoised.pixel(x, y)[c];
        strange += !(value >= 0 && value < 10);
      }
    }
  }
  CHECK(strange == 4);
  ForEachTarget([&](Target target) {
    CHECK(SameColours(denoised, DenoiseOrFail(broken, {target, 2})));
  });
}

TEST_CASE("a single bright pixel is clamped where there is noise, and stays where there is none") {
  const auto brighten = [](Film film) {
    for (int c = 0; c < 3; ++c) film.pixel(100, 75)[c] *= 50;
    return film;
  };
  const Film room = RoomFilm(150, 100), highlight = brighten(room);
  CHECK(DenoiseOrFail(highlight).pixel(100, 75)[0] == highlight.pixel(100, 75)[0]);
  const Film noisy = WithNoise(room, 4);
  const float clean = DenoiseOrFail(noisy).pixel(100, 75)[0];
  CHECK(DenoiseOrFail(brighten(noisy)).pixel(100, 75)[0] < 3 * clean);

  // The layers of a pixel whose first sample saw something else: dark, beside what is bright.
  Film mixed(60, 60, GuideLayers());
  std::fill(mixed.rgb.begin(), mixed.rgb.end(), 0.4f);
  for (auto& layer : mixed.layers) std::fill(layer.begin(), layer.end(), 0.5f);
  mixed = WithNoise(std::move(mixed), 16);
  for (int c = 0; c < 3; ++c) mixed.at(Layer::kAlbedo, 30, 30)[c] = 0.05f;
  CHECK(DenoiseOrFail(mixed).pixel(30, 30)[0] > 0.2f);
}

TEST_CASE("pixels farther away than kDenoiseReach change nothing") {
  const Film noisy = WithNoise(RoomFilm(160, 110), 1);
  Film changed = noisy;
  for (int y = 0; y < 110; ++y) {
    for (int x = 0; x < 160; ++x) {
      if (x <= 80 + kDenoiseReach) continue;
      for (int c = 0; c < 3; ++c) {
        changed.pixel(x, y)[c] = 5 * changed.pixel(x, y)[c] + 1;
        changed.at(Layer::kAlbedo, x, y)[c] = 0.4f;
      }
      *changed.at(Layer::kDepth, x, y) = 3;
    }
  }
  const Film a = DenoiseOrFail(noisy), b = DenoiseOrFail(changed);
  int differing = 0;
  for (int y = 0; y < 110; ++y) {
    differing += std::memcmp(a.pixel(0, y), b.pixel(0, y), 3 * 81 * sizeof(float)) != 0;
  }
  CHECK(differing == 0);
}

TEST_CASE("layers that are missing guide nothing, and brightness changes nothing else") {
  Film noisy = WithNoise(RoomFilm(150, 100), 4);
  const double before = RootMeanSquare(RoomFilm(150, 100), noisy);
  for (auto& layer : noisy.layers) layer.clear();
  CHECK(RootMeanSquare(RoomFilm(150, 100), DenoiseOrFail(noisy)) < before);

  const Film room = WithNoise(RoomFilm(100, 60), 4);
  Film bright = room;
  for (float& value : bright.rgb) value *= 0x1p20f;
  const Film once = DenoiseOrFail(room);
  Film again = DenoiseOrFail(bright);
  for (float& value : again.rgb) value *= 0x1p-20f;
  CHECK(SameColours(once, again));
}

TEST_CASE("options out of range are refused") {
  const Film film = RoomFilm(4, 4);
  CHECK(Denoise(film, {{}, -1}).error().kind == ErrorKind::kUsage);
  CHECK(Denoise(film, {{}, 1025}).error().kind == ErrorKind::kUsage);
  CHECK(Denoise(Film()).ok());
}

}  // namespace
}  // namespace sheaf
