#include "src/render/pixel_order.h"

#include <algorithm>
#include <bit>

#include "simd/streams.h"
#include "src/core/even_bits.h"

namespace sheaf {

template <typename Real>
void PixelList<Real>::Reserve(std::uint32_t n) {
  if (StreamCapacity(n) <= x.size()) return;
  x.Allocate(StreamCapacity(n));
  y.Allocate(StreamCapacity(n));
}

template <typename Real>
void PixelOrder<Real>::Arrange(const PixelRect& area) {
  if (area.width() == area_.width() && area.height() == area_.height()) {
    // Only moved.
    const Real right = static_cast<Real>(area.x0 - area_.x0);
    const Real down = static_cast<Real>(area.y0 - area_.y0);
    for (std::uint32_t i = 0; i < pixels_.count; ++i) {
      pixels_.x[i] += right;
      pixels_.y[i] += down;
    }
    area_ = area;
    return;
  }
  area_ = area;
  const auto size = static_cast<std::uint32_t>(area.width() * area.height());
  const auto side =
      std::bit_ceil(static_cast<std::uint32_t>(std::max(area.width(), area.height())));
  pixels_.Reserve(size);
  pixels_.count = 0;
  position_.resize(size);
  for (std::uint32_t code = 0; code < side * side; ++code) {
    const int x = static_cast<int>(EvenBits(code)), y = static_cast<int>(EvenBits(code >> 1));
    if (x >= area.width() || y >= area.height()) continue;
    pixels_.x[pixels_.count] = static_cast<Real>(area.x0 + x);
    pixels_.y[pixels_.count] = static_cast<Real>(area.y0 + y);
    position_[static_cast<std::size_t>(y * area.width() + x)] = pixels_.count++;
  }
}

template struct PixelList<float>;
template struct PixelList<double>;
template class PixelOrder<float>;
template class PixelOrder<double>;

}  // namespace sheaf
