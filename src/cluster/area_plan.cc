#include "src/cluster/area_plan.h"

#include <algorithm>

namespace sheaf {
namespace {

int CeilDivide(int a, int b) { return (a + b - 1) / b; }

}  // namespace

AreaPlan::AreaPlan(const PixelRect& pixels, int tile_size, int ranks, std::int64_t most_pixels,
                   int share)
    : pixels_(pixels),
      tile_size_(tile_size),
      ranks_(ranks),
      columns_(CeilDivide(pixels.width(), tile_size)),
      share_(share),
      most_tiles_(std::max<std::int64_t>(most_pixels / (std::int64_t{tile_size} * tile_size), 1)),
      end_(std::int64_t{columns_} * CeilDivide(pixels.height(), tile_size)) {}

std::optional<PixelRect> AreaPlan::Next(int threads) {
  if (next_ == end_) return std::nullopt;
  const std::int64_t share = (end_ - next_) / (std::int64_t{share_} * ranks_);
  const std::int64_t least = std::int64_t{kTilesPerThread} * threads;
  const std::int64_t tiles = std::min(std::max(share, least), most_tiles_);
  const std::int64_t row = next_ / columns_, column = next_ % columns_;
  PixelRect area = pixels_;
  area.y0 = pixels_.y0 + static_cast<int>(row) * tile_size_;
  std::int64_t rows = 1;
  if (column == 0 && tiles >= columns_) {
    rows = tiles / columns_;
    next_ = std::min(next_ + rows * columns_, end_);
  } else {
    // What would be left of the row is no area of its own where it is a sliver.
    std::int64_t count = std::min(tiles, columns_ - column);
    if (columns_ - column - count < tiles / 2) count = columns_ - column;
    area.x0 = pixels_.x0 + static_cast<int>(column) * tile_size_;
    area.x1 = std::min(area.x0 + static_cast<int>(count) * tile_size_, pixels_.x1);
    next_ += count;
  }
  area.y1 = std::min(area.y0 + static_cast<int>(rows) * tile_size_, pixels_.y1);
  return area;
}

}  // namespace sheaf
