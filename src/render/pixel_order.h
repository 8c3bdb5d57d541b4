// The pixels of a tile in the order in which their rays are traced.
#ifndef SHEAF_RENDER_PIXEL_ORDER_H_
#define SHEAF_RENDER_PIXEL_ORDER_H_

#include <cstdint>
#include <vector>

#include "sheaf/film.h"
#include "src/core/aligned_array.h"

namespace sheaf {

// Pixels whose samples are traced together.
template <typename Real>
struct PixelList {
  AlignedArray<Real> x, y;  // whole numbers, in picture coordinates
  std::uint32_t count = 0;

  // Makes room for `n` pixels; what the list held is lost where there was less.
  void Reserve(std::uint32_t n);
  std::size_t bytes() const { return x.bytes() + y.bytes(); }
};

// All pixels of a rectangle in Morton order, so that any power of two of consecutive rays is a
// square or half of one.
template <typename Real>
class PixelOrder {
 public:
  // Cheap where the last rectangle had the same size.
  void Arrange(const PixelRect& area);

  std::size_t bytes() const {
    return pixels_.bytes() + position_.capacity() * sizeof(std::uint32_t);
  }

  const PixelRect& area() const { return area_; }
  const PixelList<Real>& pixels() const { return pixels_; }
  // Position in pixels() of a pixel of area().
  std::uint32_t PositionOf(int x, int y) const {
    return position_[static_cast<std::size_t>((y - area_.y0) * area_.width() + (x - area_.x0))];
  }

 private:
  PixelRect area_;
  PixelList<Real> pixels_;
  std::vector<std::uint32_t> position_;  // by row and column of area_
};

}  // namespace sheaf

#endif  // SHEAF_RENDER_PIXEL_ORDER_H_
