#include "src/render/render_bands.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>

#include "src/core/ceil_divide.h"
#include "src/core/parallel.h"
#include "src/render/tile_cost.h"

namespace sheaf {
namespace {

using Clock = std::chrono::steady_clock;

double SecondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

constexpr int kBandBytes = 512 << 10;
constexpr int kBandTilesPerThread = 32;

// Rows of pixels a band, whole tiles but where the area ends: as many as kBandBytes hold, so that
// the two bands stay in the cache and their pages are touched once a frame (a tenth of the frame's
// time is gone on a fresh film's), but enough tiles that few threads idle at a band's end.
int BandRows(const PixelRect& area, const RenderOptions& options, int threads) {
  const int size = options.tile_size;
  const int columns = CeilDivide(area.width(), size);
  int tile_rows = CeilDivide(options.band_rows, size);
  if (options.band_rows == 0) {
    const int row_bytes = static_cast<int>(3 * sizeof(float)) * area.width();
    const int held = kBandBytes / row_bytes / size;
    tile_rows = std::max({1, held, CeilDivide(kBandTilesPerThread * threads, columns)});
  }
  // Bands of one height, so that the last is no sliver.
  const int all = CeilDivide(area.height(), size);
  return CeilDivide(all, CeilDivide(all, tile_rows)) * size;
}

// Renders the tiles of `band` until all are done or a stop is asked for.
void RenderTiles(const TileCrew& crew, const PixelRect& band, Film& film,
                 RenderProgress& progress) {
  crew.ForEachTile(
      band, progress.stop, [&](TileWorker& worker, const PixelRect& tile, std::uint64_t) {
        const auto render = [&] { worker.Render(tile, band.x0, band.y0, film); };
        if (film.has(Layer::kHeat)) {
          TileCost cost;
          cost.Measure(worker, render);
          StoreHeat(cost, tile, band.x0, band.y0, film);
        } else {
          render();
        }
        progress.pixels_done.fetch_add(
            static_cast<std::uint64_t>(tile.width()) * static_cast<std::uint64_t>(tile.height()),
            std::memory_order_relaxed);
      });
}

}  // namespace

Status RenderBands(const PixelRect& area, const RenderOptions& options,
                   const MakeWorker& make_worker, const BandSink& sink, RenderStats& stats,
                   RenderProgress& progress) {
  const int size = options.tile_size;
  const int wanted = ThreadCount(options.threads);
  const int rows = BandRows(area, options, wanted);
  const TileCrew crew(wanted, TileCount({0, 0, area.width(), rows}, size), size, make_worker);

  BandQueue queue(sink, progress.stop);
  Status status = Done{};
  for (int y = area.y0; y < area.y1 && status; y += rows) {
    const PixelRect band{area.x0, y, area.x1, std::min(y + rows, area.y1)};
    const Clock::time_point start = Clock::now();
    Film& film = queue.Front(band.width(), band.height(), options.layers);
    RenderTiles(crew, band, film, progress);
    stats.wall_seconds += SecondsSince(start);

    status = queue.Wait();
    if (status && progress.stop.load(std::memory_order_relaxed)) {
      status = Error{ErrorKind::kInterrupted, "rendering was interrupted"};
    }
    if (!status) break;
    // Nothing renders beside the last band's sink: it needs no thread of its own.
    if (band.y1 == area.y1) {
      status = queue.PushLast();
    } else {
      queue.Push();
    }
  }
  crew.AddTo(stats);
  return status;
}

}  // namespace sheaf
