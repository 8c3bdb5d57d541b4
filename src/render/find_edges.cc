#include "src/render/find_edges.h"

namespace sheaf {
namespace {

template <typename Real>
bool Contains(const PixelRect& rect, Real x, Real y) {
  return x >= static_cast<Real>(rect.x0) && x < static_cast<Real>(rect.x1) &&
         y >= static_cast<Real>(rect.y0) && y < static_cast<Real>(rect.y1);
}

}  // namespace

template <typename Real>
void EdgeFinder<Real>::Find(const PixelOrder<Real>& order, const PixelRect& tile,
                            std::span<const FirstHit<Real>> hits, Real contrast) {
  // Each pair once, from its left or upper pixel.
  is_edge_.assign(hits.size(), false);
  const auto judge = [&](std::uint32_t a, std::uint32_t b) {
    if (is_edge_[a] && is_edge_[b]) return;
    if (!HasEdgeBetween(hits[a], hits[b], contrast)) return;
    is_edge_[a] = is_edge_[b] = true;
  };
  const PixelRect& area = order.area();
  for (int y = area.y0; y < area.y1; ++y) {
    for (int x = area.x0; x < area.x1; ++x) {
      const std::uint32_t here = order.PositionOf(x, y);
      if (x + 1 < area.x1) judge(here, order.PositionOf(x + 1, y));
      if (y + 1 < area.y1) judge(here, order.PositionOf(x, y + 1));
    }
  }
  const PixelList<Real>& all = order.pixels();
  pixels_.Reserve(all.count);
  pixels_.count = 0;
  positions_.clear();
  for (std::uint32_t i = 0; i < all.count; ++i) {
    if (!is_edge_[i] || !Contains(tile, all.x[i], all.y[i])) continue;
    pixels_.x[pixels_.count] = all.x[i];
    pixels_.y[pixels_.count++] = all.y[i];
    positions_.push_back(i);
  }
}

template class EdgeFinder<float>;
template class EdgeFinder<double>;

}  // namespace sheaf
