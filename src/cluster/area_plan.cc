#include "src/cluster/area_plan.h"

#include <algorithm>
#include <cassert>

#include "src/core/ceil_divide.h"

namespace sheaf {

AreaPlan::AreaPlan(const PixelRect& pixels, int tile_size, int ranks, std::int64_t most_pixels,
                   int share)
    : pixels_(pixels),
      tile_size_(tile_size),
      ranks_(ranks),
      columns_(CeilDivide(pixels.width(), tile_size)),
      share_(share),
      most_tiles_(std::max<std::int64_t>(most_pixels / (std::int64_t{tile_size} * tile_size), 1)),
      end_(std::int64_t{columns_} * CeilDivide(pixels.height(), tile_size)),
      left_(end_) {}

void AreaPlan::LeaveOut(const PixelRect& area) {
  assert((area.x0 - pixels_.x0) % tile_size_ == 0 && (area.y0 - pixels_.y0) % tile_size_ == 0);
  left_out_.resize(static_cast<std::size_t>(end_), false);
  for (int y = area.y0; y < area.y1; y += tile_size_) {
    const std::int64_t row = std::int64_t{(y - pixels_.y0) / tile_size_} * columns_;
    for (int x = area.x0; x < area.x1; x += tile_size_) {
      left_out_[static_cast<std::size_t>(row + (x - pixels_.x0) / tile_size_)] = true;
      --left_;
    }
  }
}

std::int64_t AreaPlan::RunFrom(std::int64_t tile) const {
  const std::int64_t most = columns_ - tile % columns_;
  if (left_out_.empty()) return most;
  const auto from = left_out_.begin() + tile;
  return std::find(from, from + most, true) - from;
}

std::optional<PixelRect> AreaPlan::Next(int threads) {
  while (next_ < end_ && RunFrom(next_) == 0) ++next_;
  if (next_ == end_) return std::nullopt;
  const std::int64_t share = left_ / (std::int64_t{share_} * ranks_);
  const std::int64_t least = std::int64_t{kTilesPerThread} * threads;
  const std::int64_t tiles = std::min(std::max(share, least), most_tiles_);
  const std::int64_t row = next_ / columns_, column = next_ % columns_, run = RunFrom(next_);
  PixelRect area = pixels_;
  area.y0 = pixels_.y0 + static_cast<int>(row) * tile_size_;
  std::int64_t count = columns_, rows = 1;
  if (run == columns_ && tiles >= columns_) {
    const auto is_whole = [&](std::int64_t tile) {
      return tile < end_ && RunFrom(tile) == columns_;
    };
    while (rows < tiles / columns_ && is_whole(next_ + rows * columns_)) ++rows;
  } else {
    // What would be left of the run is no area of its own where it is a sliver.
    count = std::min(tiles, run);
    if (run - count < tiles / 2) count = run;
    area.x0 = pixels_.x0 + static_cast<int>(column) * tile_size_;
    area.x1 = std::min(area.x0 + static_cast<int>(count) * tile_size_, pixels_.x1);
  }
  next_ += rows * count;
  left_ -= rows * count;
  area.y1 = std::min(area.y0 + static_cast<int>(rows) * tile_size_, pixels_.y1);
  return area;
}

}  // namespace sheaf
