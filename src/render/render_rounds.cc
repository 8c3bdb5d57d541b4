#include "src/render/render_rounds.h"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <vector>

#include "src/core/parallel.h"
#include "src/render/check_options.h"
#include "src/render/tile_cost.h"

namespace sheaf {
namespace {

using Clock = std::chrono::steady_clock;

// The picture that is in work, and what its tiles took.
struct Canvas {
  const PixelRect area;
  Film film;
  std::vector<TileCost> costs;  // by tile, where the film has Layer::kHeat
};

void RenderRound(const TileCrew& crew, SampleRound& round, const TimeUsed& used, Canvas& canvas,
                 RenderProgress& progress) {
  const PixelRect& area = canvas.area;
  const auto pixels = static_cast<double>(canvas.film.pixel_count());
  const auto render = [&](TileWorker& worker, const PixelRect& tile, std::uint64_t index) {
    const auto refine = [&] { worker.RenderRound(tile, area.x0, area.y0, canvas.film, round); };
    if (canvas.costs.empty()) {
      refine();
    } else {
      TileCost& cost = canvas.costs[index];
      cost.Measure(worker, refine);
      if (!round.is_cut()) StoreHeat(cost, tile, area.x0, area.y0, canvas.film);
    }
    // The work ends with the time, not with a number of pixels.
    progress.pixels_done.store(static_cast<std::uint64_t>(pixels * std::min(used(), 1.0)),
                               std::memory_order_relaxed);
  };
  crew.ForEachTile(area, progress.stop, render);
}

}  // namespace

double RoundGoal(int round) {
  // Renard's preferred numbers, as whole ones: one division makes the double next to the decimal.
  constexpr double kGoals[] = {1000, 800, 630, 500, 400, 315, 250, 200, 160, 125};
  double divisor = 1000;
  for (; round >= 10; round -= 10) divisor *= 10;
  return kGoals[round] / divisor;
}

Status RenderRounds(const RenderOptions& options, const MakeWorker& make_worker,
                    const TimeUsed& used, const BandSink& sink, RenderStats& stats,
                    RenderProgress& progress) {
  const PixelRect area = AreaOf(options);
  const std::int64_t tiles = TileCount(area, options.tile_size);
  const TileCrew crew(ThreadCount(options.threads), tiles, options.tile_size, make_worker);
  Canvas canvas{area, Film(area.width(), area.height(), options.layers), {}};
  if (canvas.film.has(Layer::kHeat)) canvas.costs.resize(static_cast<std::size_t>(tiles));
  SampleSums sums(area, options.precision);
  const std::uint64_t most =
      canvas.film.pixel_count() * static_cast<std::uint64_t>(options.samples);

  for (int i = 0; i == 0 || used() < 1; ++i) {
    const double goal = std::max(RoundGoal(i), *options.error);
    const auto kind = i == 0 ? SampleRound::Kind::kFirst : SampleRound::Kind::kLater;
    SampleRound round(kind, goal, used, sums);
    const Clock::time_point start = Clock::now();
    RenderRound(crew, round, used, canvas, progress);
    stats.wall_seconds += std::chrono::duration<double>(Clock::now() - start).count();
    if (progress.stop.load(std::memory_order_relaxed)) {
      crew.AddTo(stats);
      return Error{ErrorKind::kInterrupted, "rendering was interrupted"};
    }
    if (round.is_cut()) break;
    sums.WriteMeans(canvas.film);
    stats.reached = {i + 1, goal, sums.samples()};
    if (goal == *options.error || stats.reached.samples == most) break;
  }
  crew.AddTo(stats);
  progress.pixels_done.store(canvas.film.pixel_count(), std::memory_order_relaxed);
  const Status taken = sink(canvas.film);
  if (!taken) progress.stop.store(true, std::memory_order_relaxed);
  return taken;
}

}  // namespace sheaf
