#include "src/render/tile_crew.h"

#include <algorithm>

#include "src/core/ceil_divide.h"
#include "src/core/parallel.h"

namespace sheaf {

std::int64_t TileCount(const PixelRect& area, int size) {
  return std::int64_t{CeilDivide(area.width(), size)} * CeilDivide(area.height(), size);
}

TileCrew::TileCrew(int threads, std::int64_t tiles, int tile_size, const MakeWorker& make_worker)
    : tile_size_(tile_size),
      workers_(static_cast<std::size_t>(std::min<std::int64_t>(threads, tiles))) {
  for (auto& worker : workers_) worker = make_worker();
}

void TileCrew::ForEachTile(const PixelRect& area, const std::atomic<bool>& stop,
                           const Work& work) const {
  const int size = tile_size_;
  const auto columns = static_cast<std::uint64_t>(CeilDivide(area.width(), size));
  const auto tiles = static_cast<std::uint64_t>(TileCount(area, size));
  ParallelFor(threads(), tiles, [&](int chosen, std::uint64_t item) {
    if (stop.load(std::memory_order_relaxed)) return;
    PixelRect tile;
    tile.x0 = area.x0 + static_cast<int>(item % columns) * size;
    tile.y0 = area.y0 + static_cast<int>(item / columns) * size;
    tile.x1 = std::min(tile.x0 + size, area.x1);
    tile.y1 = std::min(tile.y0 + size, area.y1);
    work(*workers_[static_cast<std::size_t>(chosen)], tile, item);
  });
}

void TileCrew::AddTo(RenderStats& stats) const {
  stats.threads = threads();
  for (const auto& worker : workers_) {
    stats.rays += worker->rays();
    stats.buffer_bytes += worker->buffer_bytes();
    for (int i = 0; i < static_cast<int>(Phase::kCount); ++i) {
      const Phase phase = static_cast<Phase>(i);
      stats.phase_seconds[i] += worker->clock().seconds(phase);
      stats.lane_use[i] += worker->clock().lane_use(phase);
    }
  }
}

}  // namespace sheaf
