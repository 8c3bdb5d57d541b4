// What a tile took: Layer::kHeat.
#ifndef SHEAF_RENDER_TILE_COST_H_
#define SHEAF_RENDER_TILE_COST_H_

#include <cstdint>
#include <functional>

#include "sheaf/film.h"
#include "src/render/tile_worker.h"

namespace sheaf {

struct TileCost {
  double seconds = 0;
  std::uint64_t live = 0, lanes = 0, rays = 0;

  // Calls `work`, and adds what it took.
  void Measure(const TileWorker& worker, const std::function<void()>& work);
};

// Gives it to the tile's pixels; the film's top left pixel is (film_x, film_y).
void StoreHeat(const TileCost& cost, const PixelRect& tile, int film_x, int film_y, Film& film);

}  // namespace sheaf

#endif  // SHEAF_RENDER_TILE_COST_H_
