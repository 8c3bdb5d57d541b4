// The finished picture: linear RGB before any transfer, clamp or quantisation.
#ifndef SHEAF_SHEAF_FILM_H_
#define SHEAF_SHEAF_FILM_H_

#include <array>
#include <cstddef>
#include <memory>
#include <new>
#include <utility>
#include <vector>

#include "sheaf/version.h"

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

// What a picture can hold of each pixel besides its colour: of what the pixel's first sample met.
enum class Layer {
  kDepth,   // distance from the ray's origin; infinite where it met nothing
  kNormal,  // of shading, unit, facing the ray; else 0
  kAlbedo,  // base colour, linear; else 0
  kId,      // one more than the object's number; else 0
  kHeat,    // of the tile: microseconds a pixel, share of live lanes, rays a pixel
  kCount
};
inline constexpr int kLayerCount = static_cast<int>(Layer::kCount);
inline constexpr int kLayerChannels[kLayerCount] = {1, 3, 3, 1, 3};
SHEAF_API const char* LayerName(Layer layer);  // "depth", "normal", "albedo", "id" or "heat"

// A set of layers.
class Layers {
 public:
  bool has(Layer layer) const { return bits_ >> static_cast<int>(layer) & 1u; }
  bool empty() const { return bits_ == 0; }
  void Add(Layer layer) { bits_ |= 1u << static_cast<int>(layer); }
  bool operator==(const Layers&) const = default;

 private:
  unsigned bits_ = 0;
};

// Interleaved RGB floats, rows from the top; a new film's hold anything. A crop's film holds the
// crop alone. A layer that was not asked for is empty.
struct Film {
  int width = 0, height = 0;
  using Floats = std::vector<float, UninitializedAllocator<float>>;
  Floats rgb;                  // 3 * width * height
  Floats layers[kLayerCount];  // kLayerChannels * width * height

  Film() = default;
  explicit Film(int w, int h, Layers wanted = {}) { Resize(w, h, wanted); }
  Film(const Film&) = default;
  Film& operator=(const Film&) = default;
  Film(Film&& other) noexcept { *this = std::move(other); }
  Film& operator=(Film&& other) noexcept {
    width = std::exchange(other.width, 0);
    height = std::exchange(other.height, 0);
    rgb = std::exchange(other.rgb, {});
    for (int i = 0; i < kLayerCount; ++i) layers[i] = std::exchange(other.layers[i], {});
    return *this;
  }
  // What it held is lost, but not its memory.
  void Resize(int w, int h, Layers wanted) {
    width = w;
    height = h;
    rgb.resize(3 * pixel_count());
    for (int i = 0; i < kLayerCount; ++i) {
      if (!wanted.has(static_cast<Layer>(i))) continue;
      layers[i].resize(static_cast<std::size_t>(kLayerChannels[i]) * pixel_count());
    }
  }
  std::size_t pixel_count() const {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  }
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(x);
  }
  float* pixel(int x, int y) { return &rgb[3 * index(x, y)]; }
  const float* pixel(int x, int y) const { return &rgb[3 * index(x, y)]; }

  bool has(Layer layer) const { return !layers[static_cast<int>(layer)].empty(); }
  Layers held_layers() const {
    Layers held;
    for (int i = 0; i < kLayerCount; ++i) {
      if (has(static_cast<Layer>(i))) held.Add(static_cast<Layer>(i));
    }
    return held;
  }
  float* at(Layer layer, int x, int y) {
    const int i = static_cast<int>(layer);
    return &layers[i][static_cast<std::size_t>(kLayerChannels[i]) * index(x, y)];
  }
  const float* at(Layer layer, int x, int y) const {
    return const_cast<Film*>(this)->at(layer, x, y);
  }
};

// The exposure, in stops, that turns the median luminance of what is lit into that of a grey card,
// 0.18, or up to a third of a stop below; 0 where nothing is lit.
SHEAF_API double MeterExposure(const Film& film);

}  // namespace sheaf

#endif  // SHEAF_SHEAF_FILM_H_
