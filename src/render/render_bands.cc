#include "src/render/render_bands.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <vector>

#include "src/core/parallel.h"

namespace sheaf {
namespace {

using Clock = std::chrono::steady_clock;
using Workers = std::vector<std::unique_ptr<TileWorker>>;

double SecondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

int CeilDivide(int a, int b) { return (a + b - 1) / b; }

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

// Renders a tile and gives its pixels, as Layer::kHeat, what it took.
void RenderWithHeat(TileWorker& worker, const PixelRect& tile, int film_x, int film_y, Film& film) {
  const std::uint64_t rays = worker.rays().traced();
  const LaneUse use = worker.clock().all_lane_use();
  const Clock::time_point start = Clock::now();
  worker.Render(tile, film_x, film_y, film);
  const double seconds = SecondsSince(start);
  const LaneUse now = worker.clock().all_lane_use();

  const double pixels = static_cast<double>(tile.width()) * static_cast<double>(tile.height());
  const double lanes = static_cast<double>(std::max<std::uint64_t>(now.lanes - use.lanes, 1));
  const std::array<float, 3> heat = {
      static_cast<float>(1e6 * seconds / pixels),
      static_cast<float>(static_cast<double>(now.live - use.live) / lanes),
      static_cast<float>(static_cast<double>(worker.rays().traced() - rays) / pixels)};
  for (int y = tile.y0; y < tile.y1; ++y) {
    for (int x = tile.x0; x < tile.x1; ++x) {
      std::copy(heat.begin(), heat.end(), film.at(Layer::kHeat, x - film_x, y - film_y));
    }
  }
}

// Hands the tiles of `band` to the workers until all are done or a stop is asked for.
void RenderTiles(const Workers& workers, const PixelRect& band, int tile_size, Film& film,
                 RenderProgress& progress) {
  const auto columns = static_cast<std::uint64_t>(CeilDivide(band.width(), tile_size));
  const auto rows = static_cast<std::uint64_t>(CeilDivide(band.height(), tile_size));
  ParallelFor(
      static_cast<int>(workers.size()), columns * rows, [&](int chosen, std::uint64_t item) {
        if (progress.stop.load(std::memory_order_relaxed)) return;
        PixelRect tile;
        tile.x0 = band.x0 + static_cast<int>(item % columns) * tile_size;
        tile.y0 = band.y0 + static_cast<int>(item / columns) * tile_size;
        tile.x1 = std::min(tile.x0 + tile_size, band.x1);
        tile.y1 = std::min(tile.y0 + tile_size, band.y1);
        TileWorker& worker = *workers[static_cast<std::size_t>(chosen)];
        if (film.has(Layer::kHeat)) {
          RenderWithHeat(worker, tile, band.x0, band.y0, film);
        } else {
          worker.Render(tile, band.x0, band.y0, film);
        }
        progress.pixels_done.fetch_add(
            static_cast<std::uint64_t>(tile.width()) * static_cast<std::uint64_t>(tile.height()),
            std::memory_order_relaxed);
      });
}

void AddCounts(const TileWorker& worker, RenderStats& stats) {
  stats.rays += worker.rays();
  stats.buffer_bytes += worker.buffer_bytes();
  for (int i = 0; i < static_cast<int>(Phase::kCount); ++i) {
    const Phase phase = static_cast<Phase>(i);
    stats.phase_seconds[i] += worker.clock().seconds(phase);
    stats.lane_use[i] += worker.clock().lane_use(phase);
  }
}

}  // namespace

Status RenderBands(const PixelRect& area, const RenderOptions& options,
                   const std::function<std::unique_ptr<TileWorker>()>& make_worker,
                   const BandSink& sink, RenderStats& stats, RenderProgress& progress) {
  const int size = options.tile_size;
  const int wanted = ThreadCount(options.threads);
  const int rows = BandRows(area, options, wanted);
  const std::int64_t tiles = std::int64_t{CeilDivide(area.width(), size)} * CeilDivide(rows, size);
  stats.threads = static_cast<int>(std::min<std::int64_t>(wanted, tiles));
  Workers workers(static_cast<std::size_t>(stats.threads));
  for (auto& worker : workers) worker = make_worker();

  BandQueue queue(sink, progress.stop);
  Status status = Done{};
  for (int y = area.y0; y < area.y1 && status; y += rows) {
    const PixelRect band{area.x0, y, area.x1, std::min(y + rows, area.y1)};
    const Clock::time_point start = Clock::now();
    Film& film = queue.Front(band.width(), band.height(), options.layers);
    RenderTiles(workers, band, size, film, progress);
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
  for (const auto& worker : workers) AddCounts(*worker, stats);
  return status;
}

}  // namespace sheaf
