// The threads of a frame, each with a worker of its own, and the tiles that they share.
#ifndef SHEAF_RENDER_TILE_CREW_H_
#define SHEAF_RENDER_TILE_CREW_H_

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "sheaf/film.h"
#include "sheaf/stats.h"
#include "src/render/tile_worker.h"

namespace sheaf {

using MakeWorker = std::function<std::unique_ptr<TileWorker>()>;

class TileCrew {
 public:
  // Work on a tile, the `index`th of its area by rows. Calls with one worker never overlap.
  using Work = std::function<void(TileWorker& worker, const PixelRect& tile, std::uint64_t index)>;

  // `threads` of them at most, and no more than `tiles`; `tile_size` is of pixels a side.
  TileCrew(int threads, std::int64_t tiles, int tile_size, const MakeWorker& make_worker);

  int threads() const { return static_cast<int>(workers_.size()); }

  // Hands out the tiles of `area` until all are done or a stop is asked for.
  void ForEachTile(const PixelRect& area, const std::atomic<bool>& stop, const Work& work) const;

  // What the workers counted, and how many they are.
  void AddTo(RenderStats& stats) const;

 private:
  const int tile_size_;
  std::vector<std::unique_ptr<TileWorker>> workers_;
};

// How many tiles of `size` pixels a side cover the area.
std::int64_t TileCount(const PixelRect& area, int size);

}  // namespace sheaf

#endif  // SHEAF_RENDER_TILE_CREW_H_
