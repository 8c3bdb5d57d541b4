// Adaptive sampling: which pixels of a tile get all their samples.
#ifndef SHEAF_RENDER_FIND_EDGES_H_
#define SHEAF_RENDER_FIND_EDGES_H_

#include <cstdint>
#include <span>
#include <vector>

#include "sheaf/film.h"
#include "src/render/pixel_order.h"
#include "src/stream/first_hit.h"

namespace sheaf {

template <typename Real>
class EdgeFinder {
 public:
  // Finds the pixels of `tile`, a part of the ordered ones, with an edge to a neighbour above,
  // below, left or right. `hits` has what the ordered pixels' first samples saw.
  void Find(const PixelOrder<Real>& order, const PixelRect& tile,
            std::span<const FirstHit<Real>> hits, Real contrast);

  std::size_t bytes() const {
    return pixels_.bytes() + positions_.capacity() * sizeof(std::uint32_t) +
           is_edge_.capacity() / 8;
  }

  const PixelList<Real>& pixels() const { return pixels_; }
  // Of each of pixels() in the order that they were found in.
  std::span<const std::uint32_t> positions() const { return positions_; }

 private:
  PixelList<Real> pixels_;
  std::vector<std::uint32_t> positions_;
  std::vector<bool> is_edge_;  // by position
};

}  // namespace sheaf

#endif  // SHEAF_RENDER_FIND_EDGES_H_
