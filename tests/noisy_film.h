// A small picture of a room with a known light, and the noise that random samples would give it.
#ifndef SHEAF_TESTS_NOISY_FILM_H_
#define SHEAF_TESTS_NOISY_FILM_H_

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "sheaf/film.h"

namespace sheaf {

// In [0, 1), by `key` alone.
inline double HashUnit(std::uint64_t key) {
  key += 0x9e3779b97f4a7c15u;
  key = (key ^ (key >> 30)) * 0xbf58476d1ce4e5b9u;
  key = (key ^ (key >> 27)) * 0x94d049bb133111ebu;
  return static_cast<double>((key ^ (key >> 31)) >> 11) * 0x1p-53;
}

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
  for (int y = 0; y < film.height; ++y) {
    for (int x = 0; x < film.width; ++x) {
      if (std::isinf(*film.at(Layer::kDepth, x, y))) continue;
      double sum = 0;
      for (int i = 0; i < samples; ++i) {
        const double u = HashUnit((film.index(x, y) << 8) + static_cast<std::uint64_t>(i));
        sum += 3 * u * u;
      }
      for (int c = 0; c < 3; ++c) film.pixel(x, y)[c] *= static_cast<float>(sum / samples);
    }
  }
  return film;
}

}  // namespace sheaf

#endif  // SHEAF_TESTS_NOISY_FILM_H_
