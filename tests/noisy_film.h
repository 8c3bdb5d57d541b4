// A small picture of a room with a known light, and the noise that random samples would give it.
#ifndef SHEAF_TESTS_NOISY_FILM_H_
#define SHEAF_TESTS_NOISY_FILM_H_

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

#include "sheaf/film.h"

namespace sheaf {

// Numbers in [0, 1), the same on every machine, which std::uniform_real_distribution's need not be.
class UnitNumbers {
 public:
  explicit UnitNumbers(std::uint64_t seed) : random_(seed) {}
  double operator()() { return static_cast<double>(random_() >> 11) * 0x1p-53; }

 private:
  std::mt19937_64 random_;
};

inline Layers GuideLayers() {
  Layers layers;
  for (const Layer layer : {Layer::kAlbedo, Layer::kNormal, Layer::kDepth}) layers.Add(layer);
  return layers;
}

// Sky above a checkered floor and a wall: edges of depth, of the normal alone and of the albedo
// alone. Light falls off smoothly, and a shadow has a soft edge across the floor.
inline Film RoomFilm(int width, int height) {
  Film film(width, height, GuideLayers());
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const bool is_sky = 5 * y < height;
      const bool is_wall = !is_sky && 2 * y < height;
      const bool is_dark = (x / 12 + y / 12) % 2 == 0;
      const double depth = is_wall ? 10 : 5.0 * height / std::max(y, 1);
      *film.at(Layer::kDepth, x, y) =
          is_sky ? std::numeric_limits<float>::infinity() : static_cast<float>(depth);
      const double along = static_cast<double>(x) / width;
      const double shadow = std::clamp(8 * (along - 0.5), 0.0, 1.0);
      for (int c = 0; c < 3; ++c) {
        const double albedo = is_wall ? 0.7 - 0.1 * c : is_dark ? 0.15 + 0.1 * c : 0.9 - 0.2 * c;
        const double light = is_wall ? 0.6 + 0.3 * along : 0.2 + 0.8 * shadow;
        film.at(Layer::kAlbedo, x, y)[c] = is_sky ? 0 : static_cast<float>(albedo);
        film.at(Layer::kNormal, x, y)[c] = !is_sky && c == (is_wall ? 2 : 1) ? 1.0f : 0.0f;
        film.pixel(x, y)[c] = static_cast<float>(is_sky ? 0.3 + 0.1 * c : albedo * light);
      }
    }
  }
  return film;
}

// The mean of `samples` estimates of what surfaces reflect, each 3 u² times the light.
inline Film WithNoise(Film film, int samples) {
  UnitNumbers unit(static_cast<std::uint64_t>(samples));
  for (int y = 0; y < film.height; ++y) {
    for (int x = 0; x < film.width; ++x) {
      if (std::isinf(*film.at(Layer::kDepth, x, y))) continue;
      double sum = 0;
      for (int i = 0; i < samples; ++i) {
        const double u = unit();
        sum += 3 * u * u;
      }
      for (int c = 0; c < 3; ++c) film.pixel(x, y)[c] *= static_cast<float>(sum / samples);
    }
  }
  return film;
}

}  // namespace sheaf

#endif  // SHEAF_TESTS_NOISY_FILM_H_
