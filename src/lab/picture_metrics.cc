#include "src/lab/picture_metrics.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "src/lab/flip.h"
#include "src/scene/srgb.h"

namespace sheaf {
namespace {

double Difference(float a, float b) {
  if (a == b || (std::isnan(a) && std::isnan(b))) return 0;
  const double difference = std::abs(static_cast<double>(a) - static_cast<double>(b));
  return std::isnan(difference) ? std::numeric_limits<double>::infinity() : difference;
}

// Maps neighbouring floats to neighbouring integers. -0 is -1, +0 is 0.
std::int64_t Rank(float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  const std::int64_t magnitude = bits & 0x7fffffffu;
  return bits >> 31 ? -magnitude - 1 : magnitude;
}

Film Decoded(Film film) {
  for (float& value : film.rgb) value = static_cast<float>(SrgbDecode(static_cast<double>(value)));
  return film;
}

}  // namespace

PictureMetrics MeasurePictures(const Film& reference, const Film& test, Transfer transfer) {
  PictureMetrics metrics;
  for (std::size_t i = 0; i < reference.rgb.size(); i += 3) {
    double most = 0;
    for (std::size_t channel = 0; channel < 3; ++channel) {
      const double difference = Difference(reference.rgb[i + channel], test.rgb[i + channel]);
      most = std::max(most, difference);
    }
    metrics.largest = std::max(metrics.largest, most);
    // Two bytes that differ by 1 do not count, however their division by 255 was rounded.
    metrics.over += most > 1.0 / 255 + 1e-6;
  }
  metrics.rmse = RootMeanSquare(reference, test);
  metrics.psnr = -20 * std::log10(metrics.rmse);
  metrics.mean_flip = transfer == Transfer::kLinear ? MeanFlip(reference, test)
                                                    : MeanFlip(Decoded(reference), Decoded(test));
  return metrics;
}

double RootMeanSquare(const Film& reference, const Film& test) {
  double sum = 0;
  for (std::size_t i = 0; i < reference.rgb.size(); ++i) {
    const double difference = Difference(reference.rgb[i], test.rgb[i]);
    sum += difference * difference;
  }
  return std::sqrt(sum / static_cast<double>(reference.rgb.size()));
}

std::uint32_t UlpDistance(float a, float b) {
  if (std::isnan(a) || std::isnan(b)) {
    return std::isnan(a) && std::isnan(b) ? 0 : std::numeric_limits<std::uint32_t>::max();
  }
  return static_cast<std::uint32_t>(std::abs(Rank(a) - Rank(b)));
}

FilmDifference CompareFilms(const Film& reference, const Film& test, std::uint32_t allowed_ulps) {
  FilmDifference found;
  for (int y = 0; y < reference.height; ++y) {
    for (int x = 0; x < reference.width; ++x) {
      const float *a = reference.pixel(x, y), *b = test.pixel(x, y);
      std::uint32_t most = 0;
      for (int i = 0; i < 3; ++i) most = std::max(most, UlpDistance(a[i], b[i]));
      found.most_ulps = std::max(found.most_ulps, most);
      if (most <= allowed_ulps) continue;
      if (found.pixels++ == 0) {
        found.x = x;
        found.y = y;
      }
    }
  }
  return found;
}

}  // namespace sheaf
