// Renders a scene through one camera: the entry point of the renderer.
#ifndef SHEAF_SHEAF_RENDER_H_
#define SHEAF_SHEAF_RENDER_H_

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>

#include "sheaf/error.h"
#include "sheaf/film.h"
#include "sheaf/scene.h"
#include "sheaf/stats.h"
#include "sheaf/target.h"

namespace sheaf {

// What a picture is computed in; see docs/numerics.md.
enum class Precision {
  kStrict,  // float, correctly rounded, never fused: the same bits everywhere
  kFast,    // float, fused and approximate: other bits on every target; not on the baseline
  kDouble,  // the same renderer on double lanes
};

inline constexpr Precision kPrecisions[] = {Precision::kStrict, Precision::kFast,
                                            Precision::kDouble};
const char* PrecisionName(Precision precision);  // "strict", "fast" or "double"

enum class Timing { kOff, kOn };

enum class TileCosts { kOff, kOn };

// Whether work that a scene does not need is left out. It changes no bit; tests see to that.
enum class Skips { kOn, kOff };

inline constexpr int kMaxTileSize = 256;
inline constexpr int kMaxThreads = 1024;

struct RenderOptions {
  int width = 640, height = 480;  // of the whole picture, [1, kMaxImageSide]
  int samples = 1;                // a pixel, >= 1
  int max_depth = 5;              // [0, kMaxDepth]
  // A secondary ray that adds at most this part of what it sees is not traced, [0, 1]. Above 0 it
  // trades accuracy for time (docs/numerics.md).
  double min_throughput = 0;
  // Adaptive sampling: where given, a pixel gets more than its first sample only at edges, and
  // colours that differ by more than this are one, [0, 1].
  std::optional<double> contrast;
  std::optional<PixelRect> crop;  // inside the picture; the film holds the crop alone
  Target target{};                  // what computes it; strict bits are the same on all
  Precision precision = Precision::kStrict;
  int threads = 0;     // 0: one a core
  int tile_size = 32;  // pixels a side, [1, kMaxTileSize]; never changes a bit of the picture
  int band_rows = 0;   // of RenderRows: pixel rows a band, up to whole tiles; 0: chosen
  Skips skips = Skips::kOn;
  Timing timing = Timing::kOff;            // whether RenderStats::phase_seconds is filled
  TileCosts tile_costs = TileCosts::kOff;  // whether RenderStats::tiles is
  Layers layers;                           // of the film, besides its colours
};

// Shared with other threads while a frame renders: read the progress, ask for a stop.
enum class RenderStage { kBuilding, kRendering };

struct RenderProgress {
  std::atomic<RenderStage> stage{RenderStage::kBuilding};  // the tree first
  std::atomic<std::uint64_t> pixels_done{0};
  std::atomic<bool> stop{false};
};

// Renders `camera` (one of the scene's or any other). `stats` and `progress` may be null. Fails
// with kUsage where an option is out of range, kInterrupted where progress->stop was set; no film
// then.
Result<Film> Render(const Scene& scene, const Camera& camera, const RenderOptions& options,
                    RenderStats* stats = nullptr, RenderProgress* progress = nullptr);

// Takes the next finished rows from the top, as wide as the picture or crop; `rows` lives as long
// as the call. Calls come in order, one at a time, from any thread.
using RowSink = std::function<Status(const Film& rows)>;

// Renders as Render does, the same bits, in bands of rows that leave memory as they are finished:
// it holds two bands of about 2 MiB, or a row of tiles; while one renders the sink has the other. A
// sink that fails ends the frame: its error is returned, and progress->stop is set.
Status RenderRows(const Scene& scene, const Camera& camera, const RenderOptions& options,
                  const RowSink& sink, RenderStats* stats = nullptr,
                  RenderProgress* progress = nullptr);

}  // namespace sheaf

#endif  // SHEAF_SHEAF_RENDER_H_
