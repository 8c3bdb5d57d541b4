#include "src/render/tile_cost.h"

#include <algorithm>
#include <array>
#include <chrono>

namespace sheaf {

void TileCost::Measure(const TileWorker& worker, const std::function<void()>& work) {
  using Clock = std::chrono::steady_clock;
  const std::uint64_t rays_before = worker.rays().traced();
  const LaneUse before = worker.clock().all_lane_use();
  const Clock::time_point start = Clock::now();
  work();
  seconds += std::chrono::duration<double>(Clock::now() - start).count();
  const LaneUse now = worker.clock().all_lane_use();
  live += now.live - before.live;
  lanes += now.lanes - before.lanes;
  rays += worker.rays().traced() - rays_before;
}

void StoreHeat(const TileCost& cost, const PixelRect& tile, int film_x, int film_y, Film& film) {
  const double pixels = static_cast<double>(tile.width()) * static_cast<double>(tile.height());
  const double lanes = static_cast<double>(std::max<std::uint64_t>(cost.lanes, 1));
  const std::array<float, 3> heat = {static_cast<float>(1e6 * cost.seconds / pixels),
                                     static_cast<float>(static_cast<double>(cost.live) / lanes),
                                     static_cast<float>(static_cast<double>(cost.rays) / pixels)};
  for (int y = tile.y0; y < tile.y1; ++y) {
    for (int x = tile.x0; x < tile.x1; ++x) {
      std::copy(heat.begin(), heat.end(), film.at(Layer::kHeat, x - film_x, y - film_y));
    }
  }
}

}  // namespace sheaf
