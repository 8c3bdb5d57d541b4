// The finished picture: linear RGB before any transfer, clamp or quantisation.
#ifndef SHEAF_SCENE_FILM_H_
#define SHEAF_SCENE_FILM_H_

#include <array>
#include <cstddef>
#include <vector>

namespace sheaf {

// A rectangle of pixels, x1 and y1 exclusive; (0, 0) is the top left pixel.
struct PixelRect {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  int width() const { return x1 - x0; }
  int height() const { return y1 - y0; }
};

// Interleaved RGB floats, rows from the top. A crop's film holds the crop alone.
struct Film {
  int width = 0, height = 0;
  std::vector<float> rgb;  // 3 * width * height

  Film() = default;
  Film(int w, int h)
      : width(w), height(h), rgb(3 * static_cast<std::size_t>(w) * static_cast<std::size_t>(h)) {}
  float* pixel(int x, int y) {
    return &rgb[3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                     static_cast<std::size_t>(x))];
  }
  const float* pixel(int x, int y) const { return const_cast<Film*>(this)->pixel(x, y); }
};

}  // namespace sheaf

#endif  // SHEAF_SCENE_FILM_H_
