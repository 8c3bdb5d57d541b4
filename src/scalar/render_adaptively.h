// The pixels of a tile, sampled adaptively.
#ifndef SHEAF_SCALAR_RENDER_ADAPTIVELY_H_
#define SHEAF_SCALAR_RENDER_ADAPTIVELY_H_

#include <vector>

#include "sheaf/film.h"
#include "src/scalar/render_pixel.h"

namespace sheaf::scalar {

// `tile` and the pixels of the picture that touch it: neighbours are judged alike whatever the
// tile.
template <typename Real>
PixelRect WithNeighbours(const FrameView<Real>& frame, const PixelRect& tile) {
  return {std::max(tile.x0 - 1, 0), std::max(tile.y0 - 1, 0), std::min(tile.x1 + 1, frame.width),
          std::min(tile.y1 + 1, frame.height)};
}

// Calls write(x, y, colour, first hit) for every pixel of `tile`: its first sample, or the mean of
// all where an edge lies between it and a neighbour above, below, left or right.
template <typename Real, class Write>
void RenderAdaptively(const FrameView<Real>& frame, const PixelRect& tile,
                      PixelScratch<Real>& scratch, RayCounts& tally, const std::atomic<bool>& stop,
                      Write write) {
  const PixelRect around = WithNeighbours(frame, tile);
  std::vector<FirstHit<Real>> hits(static_cast<std::size_t>(around.width() * around.height()));
  const auto at = [&](int x, int y) -> FirstHit<Real>& {
    return hits[static_cast<std::size_t>((y - around.y0) * around.width() + (x - around.x0))];
  };
  const auto sample = [&](int x, int y, std::size_t i, FirstHit<Real>* first) {
    return RenderSample(frame, x, y, i, scratch, tally, stop, first);
  };
  for (int y = around.y0; y < around.y1; ++y) {
    for (int x = around.x0; x < around.x1 && !stop.load(std::memory_order_relaxed); ++x) {
      at(x, y).colour = sample(x, y, 0, &at(x, y));
    }
  }
  const std::size_t samples = frame.sample_x.size();
  for (int y = tile.y0; y < tile.y1; ++y) {
    for (int x = tile.x0; x < tile.x1 && !stop.load(std::memory_order_relaxed); ++x) {
      const auto has_edge_to = [&](int dx, int dy) {
        const int nx = x + dx, ny = y + dy;
        const bool exists = nx >= around.x0 && ny >= around.y0 && nx < around.x1 && ny < around.y1;
        return exists && HasEdgeBetween(at(x, y), at(nx, ny), frame.contrast);
      };
      Vec3<Real> colour = at(x, y).colour;
      if (has_edge_to(-1, 0) || has_edge_to(1, 0) || has_edge_to(0, -1) || has_edge_to(0, 1)) {
        for (std::size_t i = 1; i < samples; ++i) colour = colour + sample(x, y, i, nullptr);
        colour = colour / static_cast<Real>(samples);
      }
      write(x, y, colour, at(x, y));
    }
  }
}

}  // namespace sheaf::scalar

#endif  // SHEAF_SCALAR_RENDER_ADAPTIVELY_H_
