#include "sheaf/render.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "simd/query.h"
#include "simd/shading.h"
#include "simd/tree.h"
#include "src/bvh/build_tree.h"
#include "src/core/parallel.h"
#include "src/core/running_target.h"
#include "src/render/band_queue.h"
#include "src/render/compile_scene.h"
#include "src/render/sample_pattern.h"
#include "src/render/store_layers.h"
#include "src/render/tile_renderer.h"
#include "src/scalar/render_adaptively.h"

namespace sheaf {
namespace {

using Clock = std::chrono::steady_clock;

double SecondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// One worker of the scalar engine: what TileRenderer is to the SIMD engine.
template <typename Real>
class ScalarTileRenderer {
 public:
  ScalarTileRenderer(const FrameView<Real>& frame, const RenderOptions& /*options*/,
                     const std::atomic<bool>& stop)
      : frame_(frame), stop_(stop) {}

  void Render(const PixelRect& tile, int film_x, int film_y, Film& film) {
    const bool has_layers = HasFirstHitLayers(film);
    const auto write = [&](int x, int y, const Vec3<Real>& colour, const FirstHit<Real>& first) {
      if (has_layers) StoreLayers(film, x - film_x, y - film_y, LayersOf(first));
      float* rgb = film.pixel(x - film_x, y - film_y);
      rgb[0] = static_cast<float>(colour.x);
      rgb[1] = static_cast<float>(colour.y);
      rgb[2] = static_cast<float>(colour.z);
    };
    if (frame_.is_adaptive()) {
      scalar::RenderAdaptively(frame_, tile, scratch_, tally_, stop_, write);
      return;
    }
    for (int y = tile.y0; y < tile.y1; ++y) {
      for (int x = tile.x0; x < tile.x1 && !stop_.load(std::memory_order_relaxed); ++x) {
        FirstHit<Real> first;
        const auto colour = scalar::RenderPixel(frame_, x, y, scratch_, tally_, stop_,
                                                has_layers ? &first : nullptr);
        write(x, y, colour, first);
      }
    }
  }

  const RayCounts& rays() const { return tally_; }
  double phase_seconds(Phase /*phase*/) const { return 0; }
  LaneUse lane_use(Phase /*phase*/) const { return {}; }

 private:
  FirstHitLayers LayersOf(const FirstHit<Real>& first) const {
    if (first.primitive == kNoPrimitive) return {};
    return MakeLayers(first.t, first.normal, first.albedo,
                      frame_.object_of_primitive[first.primitive]);
  }

  const FrameView<Real>& frame_;
  scalar::PixelScratch<Real> scratch_;
  RayCounts tally_;
  const std::atomic<bool>& stop_;
};

int CeilDivide(int a, int b) { return (a + b - 1) / b; }

constexpr int kBandBytes = 2 << 20;
constexpr int kBandTilesPerThread = 8;

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

// One thread's renderer, and what its tiles took, where that is asked for.
template <typename Renderer>
struct Worker {
  Renderer renderer;
  std::vector<TileCost> tiles;

  LaneUse lane_use() const {
    LaneUse sum;
    for (int i = 0; i < static_cast<int>(Phase::kCount); ++i) {
      sum += renderer.lane_use(static_cast<Phase>(i));
    }
    return sum;
  }

  void RenderWithCost(const PixelRect& tile, int film_x, int film_y, Film& film) {
    const std::uint64_t rays = renderer.rays().traced();
    const LaneUse use = lane_use();
    const Clock::time_point start = Clock::now();
    renderer.Render(tile, film_x, film_y, film);
    const double seconds = SecondsSince(start);
    const LaneUse now = lane_use();
    tiles.push_back({tile,
                     renderer.rays().traced() - rays,
                     {now.batches - use.batches, now.live - use.live, now.lanes - use.lanes},
                     seconds});
    if (!film.has(Layer::kHeat)) return;
    const std::array<float, 3> heat = HeatOf(tiles.back());
    for (int y = tile.y0; y < tile.y1; ++y) {
      for (int x = tile.x0; x < tile.x1; ++x) {
        std::copy(heat.begin(), heat.end(), film.at(Layer::kHeat, x - film_x, y - film_y));
      }
    }
  }
};

// Hands the tiles of `band` to the workers until all are done or a stop is asked for.
template <typename Renderer>
void RenderTiles(const std::vector<std::unique_ptr<Worker<Renderer>>>& workers,
                 const PixelRect& band, const RenderOptions& options, Film& film,
                 RenderProgress& progress) {
  const int size = options.tile_size;
  const auto columns = static_cast<std::uint64_t>(CeilDivide(band.width(), size));
  const auto rows = static_cast<std::uint64_t>(CeilDivide(band.height(), size));
  ParallelFor(
      static_cast<int>(workers.size()), columns * rows, [&](int worker, std::uint64_t item) {
        if (progress.stop.load(std::memory_order_relaxed)) return;
        PixelRect tile;
        tile.x0 = band.x0 + static_cast<int>(item % columns) * size;
        tile.y0 = band.y0 + static_cast<int>(item / columns) * size;
        tile.x1 = std::min(tile.x0 + size, band.x1);
        tile.y1 = std::min(tile.y0 + size, band.y1);
        Worker<Renderer>& chosen = *workers[static_cast<std::size_t>(worker)];
        if (options.tile_costs == TileCosts::kOn || options.layers.has(Layer::kHeat)) {
          chosen.RenderWithCost(tile, band.x0, band.y0, film);
        } else {
          chosen.renderer.Render(tile, band.x0, band.y0, film);
        }
        progress.pixels_done.fetch_add(
            static_cast<std::uint64_t>(tile.width()) * static_cast<std::uint64_t>(tile.height()),
            std::memory_order_relaxed);
      });
}

// Renders `area` band by band; the sink has one band while the next renders.
template <typename Renderer, typename Real>
Status RenderBands(const FrameView<Real>& frame, const PixelRect& area,
                   const RenderOptions& options, const BandSink& sink, RenderStats& stats,
                   RenderProgress& progress) {
  const int size = options.tile_size;
  const int wanted = ThreadCount(options.threads);
  const int rows = BandRows(area, options, wanted);
  const std::int64_t tiles = std::int64_t{CeilDivide(area.width(), size)} * CeilDivide(rows, size);
  stats.threads = static_cast<int>(std::min<std::int64_t>(wanted, tiles));
  std::vector<std::unique_ptr<Worker<Renderer>>> workers(static_cast<std::size_t>(stats.threads));
  for (auto& worker : workers) {
    worker.reset(new Worker<Renderer>{Renderer(frame, options, progress.stop), {}});
  }

  BandQueue queue(sink, progress.stop);
  Status status = Done{};
  for (int y = area.y0; y < area.y1 && status; y += rows) {
    const PixelRect band{area.x0, y, area.x1, std::min(y + rows, area.y1)};
    const Clock::time_point start = Clock::now();
    Film& film = queue.Front(band.width(), band.height(), options.layers);
    RenderTiles(workers, band, options, film, progress);
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
  for (const auto& worker : workers) {
    const Renderer& renderer = worker->renderer;
    stats.rays += renderer.rays();
    stats.tiles.insert(stats.tiles.end(), worker->tiles.begin(), worker->tiles.end());
    for (int phase = 0; phase < static_cast<int>(Phase::kCount); ++phase) {
      stats.phase_seconds[phase] += renderer.phase_seconds(static_cast<Phase>(phase));
      stats.lane_use[phase] += renderer.lane_use(static_cast<Phase>(phase));
    }
  }
  return status;
}

std::uint64_t TriangleCount(const Scene& scene) {
  std::uint64_t count = 0;
  for (const Object& object : scene.objects) {
    if (const auto* mesh = std::get_if<Mesh>(&object.shape)) count += mesh->triangles.size();
  }
  return count;
}

template <typename Real>
Status RenderIn(const Scene& scene, const Camera& camera, const RenderOptions& options,
                const BandSink& sink, RenderStats& stats, RenderProgress& progress) {
  const PixelRect area = options.crop.value_or(PixelRect{0, 0, options.width, options.height});
  const Clock::time_point start = Clock::now();
  if (TriangleCount(scene) > kMaxTreePrimitives) {
    return Error{ErrorKind::kScene, fmt::format("{} triangles, at most {} are possible",
                                                TriangleCount(scene), kMaxTreePrimitives)};
  }
  CompiledScene<Real> compiled = CompileScene<Real>(scene);
  if (options.skips == Skips::kOff) {
    for (MaterialData<Real>& material : compiled.materials) material.needs = kNeedsAll;
  }
  const Result<Tree<Real>> tree = BuildTree<Real>(compiled.geometry(), options.threads);
  if (!tree) return Error{ErrorKind::kScene, tree.error().message};
  std::vector<Real> sample_x, sample_y;
  for (const glm::dvec2& point : SamplePattern(options.samples)) {
    sample_x.push_back(static_cast<Real>(point.x));
    sample_y.push_back(static_cast<Real>(point.y));
  }
  FrameView<Real> frame{compiled.geometry(),
                        tree.value().view(),
                        compiled.primitives,
                        compiled.object_of_primitive,
                        compiled.materials,
                        compiled.textures,
                        compiled.lights,
                        sample_x,
                        sample_y,
                        CompileCamera<Real>(camera, options.width, options.height),
                        {compiled.background[0], compiled.background[1], compiled.background[2]},
                        options.max_depth,
                        options.width,
                        options.height,
                        static_cast<Real>(options.contrast.value_or(std::nan(""))),
                        static_cast<Real>(options.min_throughput)};
  if (options.skips == Skips::kOff) frame.tree.skips_boxes = frame.tree.node_count == 0;
  stats.compile_seconds = SecondsSince(start);
  progress.stage.store(RenderStage::kRendering, std::memory_order_relaxed);
  stats.spheres = compiled.sphere_count;
  stats.triangles = compiled.triangle_count;
  stats.primitives = compiled.sphere_count + compiled.triangle_count;
  stats.target = RunningTarget(options.target);

  return options.target.is_scalar()
             ? RenderBands<ScalarTileRenderer<Real>>(frame, area, options, sink, stats, progress)
             : RenderBands<TileRenderer<Real>>(frame, area, options, sink, stats, progress);
}

// What is wrong with the options, or nothing.
std::string Complaint(const RenderOptions& options) {
  const auto out_of_range = [](const char* what, int low, int high) {
    return fmt::format("{} must lie in [{}, {}]", what, low, high);
  };
  const auto within = [](int value, int low, int high) { return low <= value && value <= high; };
  if (!within(options.width, 1, kMaxImageSide)) return out_of_range("width", 1, kMaxImageSide);
  if (!within(options.height, 1, kMaxImageSide)) return out_of_range("height", 1, kMaxImageSide);
  if (!within(options.samples, 1, kMaxSamples)) return out_of_range("samples", 1, kMaxSamples);
  if (!within(options.tile_size, 1, kMaxTileSize))
    return out_of_range("tile size", 1, kMaxTileSize);
  if (!within(options.band_rows, 0, kMaxImageSide))
    return out_of_range("band rows", 0, kMaxImageSide);
  if (!within(options.threads, 0, kMaxThreads)) return out_of_range("threads", 0, kMaxThreads);
  if (!within(options.max_depth, 0, kMaxDepth)) return out_of_range("max depth", 0, kMaxDepth);
  if (!(options.min_throughput >= 0 && options.min_throughput <= 1))
    return "min weight must lie in [0, 1]";
  if (options.contrast && !(*options.contrast >= 0 && *options.contrast <= 1)) {
    return "contrast must lie in [0, 1]";
  }
  if (options.precision == Precision::kFast && options.target.is_scalar()) {
    return "fast precision needs a SIMD target";
  }
  if (options.crop) {
    const PixelRect& crop = *options.crop;
    if (crop.x0 < 0 || crop.y0 < 0 || crop.x1 > options.width || crop.y1 > options.height ||
        crop.width() <= 0 || crop.height() <= 0) {
      return "crop must be a non-empty rectangle inside the picture";
    }
  }
  return {};
}

// Checks the options and renders in the arithmetic that they ask for.
Status RenderToSink(const Scene& scene, const Camera& camera, const RenderOptions& options,
                    const BandSink& sink, RenderStats* stats, RenderProgress* progress) {
  if (const std::string complaint = Complaint(options); !complaint.empty()) {
    return Error{ErrorKind::kUsage, complaint};
  }
  RenderStats ignored_stats;
  RenderProgress ignored_progress;
  RenderStats& kept_stats = stats ? *stats : ignored_stats;
  RenderProgress& kept_progress = progress ? *progress : ignored_progress;
  kept_stats = {};
  switch (options.precision) {
    case Precision::kDouble:
      return RenderIn<double>(scene, camera, options, sink, kept_stats, kept_progress);
    case Precision::kStrict:
    case Precision::kFast:
      break;
  }
  return RenderIn<float>(scene, camera, options, sink, kept_stats, kept_progress);
}

}  // namespace

const char* PrecisionName(Precision precision) {
  static constexpr const char* kNames[] = {"strict", "fast", "double"};
  return kNames[static_cast<int>(precision)];
}

std::array<float, 3> HeatOf(const TileCost& cost) {
  const double pixels =
      static_cast<double>(cost.tile.width()) * static_cast<double>(cost.tile.height());
  const double lanes = static_cast<double>(std::max<std::uint64_t>(cost.lane_use.lanes, 1));
  return {static_cast<float>(1e6 * cost.seconds / pixels),
          static_cast<float>(static_cast<double>(cost.lane_use.live) / lanes),
          static_cast<float>(static_cast<double>(cost.rays) / pixels)};
}

const char* PhaseName(Phase phase) {
  static constexpr const char* kNames[] = {"generate", "trace",  "bin",   "surface",
                                           "shade",    "shadow", "spawn", "accumulate"};
  return kNames[static_cast<int>(phase)];
}

Result<Film> Render(const Scene& scene, const Camera& camera, const RenderOptions& options,
                    RenderStats* stats, RenderProgress* progress) {
  RenderOptions one_band = options;
  one_band.band_rows = kMaxImageSide;
  Film film;
  const BandSink keep = [&film](Film& band) {
    film = std::move(band);
    return Status(Done{});
  };
  const Status rendered = RenderToSink(scene, camera, one_band, keep, stats, progress);
  if (!rendered) return rendered.error();
  return film;
}

Status RenderRows(const Scene& scene, const Camera& camera, const RenderOptions& options,
                  const RowSink& sink, RenderStats* stats, RenderProgress* progress) {
  return RenderToSink(scene, camera, options, sink, stats, progress);
}

}  // namespace sheaf
