// The finished picture: linear RGB before any transfer, clamp or quantisation.
#ifndef SHEAF_SCENE_FILM_H_
#define SHEAF_SCENE_FILM_H_

#include <array>
#include <cstddef>
#include <memory>
#include <new>
#include <utility>
#include <vector>

namespace sheaf {

// An allocator that leaves new elements as they are: whoever makes a film writes every pixel of it,
// and clearing it first would cost a tenth of a simple frame.
template <typename T>
struct UninitializedAllocator : std::allocator<T> {
  template <typename U>
  struct rebind {
    using other = UninitializedAllocator<U>;
  };
  template <typename U, typename... Arguments>
  void construct(U* p, Arguments&&... arguments) {
    if constexpr (sizeof...(Arguments) == 0) {
      ::new (static_cast<void*>(p)) U;
    } else {
      ::new (static_cast<void*>(p)) U(std::forward<Arguments>(arguments)...);
    }
  }
};

// A rectangle of pixels, x1 and y1 exclusive; (0, 0) is the top left pixel.
struct PixelRect {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  int width() const { return x1 - x0; }
  int height() const { return y1 - y0; }
};

// Interleaved RGB floats, rows from the top; a new film's hold anything. A crop's film holds the
// crop alone.
struct Film {
  int width = 0, height = 0;
  std::vector<float, UninitializedAllocator<float>> rgb;  // 3 * width * height

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
