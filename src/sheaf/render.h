// Renders a scene through one camera: the entry point of the renderer.
//
// Errors are returned as values (sheaf/error.h). Where memory runs out std::bad_alloc is thrown,
// and what a sink throws is passed on. Any number of frames may render at once, also of one scene,
// as long as each has statistics and progress of its own and nothing changes the scene meanwhile.
#ifndef SHEAF_SHEAF_RENDER_H_
#define SHEAF_SHEAF_RENDER_H_

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>

#include "sheaf/error.h"
#include "sheaf/film.h"
#include "sheaf/scene.h"
#include "sheaf/stats.h"
#include "sheaf/target.h"
#include "sheaf/version.h"

namespace sheaf {

// What a picture is computed in; see docs/numerics.md.
enum class Precision {
  kStrict,  // float, correctly rounded, never fused: the same bits everywhere
  kFast,    // float, fused and approximate: other bits on every target; not on the baseline
  kDouble,  // the same renderer on double lanes: the same bits everywhere
};

// Every precision, in the order of the enumeration.
inline constexpr Precision kPrecisions[] = {Precision::kStrict, Precision::kFast,
                                            Precision::kDouble};

// "strict", "fast" or "double".
SHEAF_API const char* PrecisionName(Precision precision);

// Whether RenderStats::phase_seconds is filled. It costs a look at the clock a phase and batch.
enum class Timing { kOff, kOn };

// The largest RenderOptions::tile_size and RenderOptions::threads.
inline constexpr int kMaxTileSize = 256;
inline constexpr int kMaxThreads = 1024;

// Where an option holds this, the scene's own setting (Settings in sheaf/scene.h) is used.
inline constexpr int kFromScene = -1;

// Fewer samples tell nothing of their error.
inline constexpr int kLeastErrorSamples = 16;

// How a frame is rendered. As it is made it asks for the picture that the scene's settings
// describe, on all cores.
struct RenderOptions {
  // Of the whole picture in pixels, each in [1, kMaxImageSide], or kFromScene.
  int width = kFromScene, height = kFromScene;
  // A pixel, in [1, kMaxSamples], or kFromScene.
  int samples = kFromScene;
  // Of the rays that are traced, primary rays having depth 0: in [0, kMaxDepth], or kFromScene.
  int max_depth = kFromScene;
  // A secondary ray that adds at most this part of what it sees is not traced, in [0, 1]. Above 0
  // it trades accuracy for time (docs/numerics.md).
  double min_throughput = 0;
  // Adaptive sampling: where given, a pixel gets more than its first sample only at edges, and
  // colours that differ by more than this are one, in [0, 1]. The scene's where samples are.
  std::optional<double> contrast;
  // Where given, in (0, 1]: a pixel gets samples until the standard error of its mean, by its
  // samples' variance, is at most this in each channel, or as a part of a channel above 1; it gets
  // kLeastErrorSamples at least and `samples`, which are no fewer, at most. Not together with
  // `contrast`. The scene's where samples are.
  std::optional<double> error;
  // Where given, above 0: seconds, from the call on. The frame is rendered in rounds, each of which
  // goes on until a smaller error is reached everywhere, and the picture is that of the last round
  // that was whole: the bits that `error` would give, which RenderStats::reached tells. The first
  // takes kLeastErrorSamples a pixel whatever time they need. Done earlier where `error`, or else
  // 0.00001, is reached, or all pixels have all samples: `samples`, kMaxSamples if kFromScene. Not
  // together with `contrast`, the scene's of which do not count. It takes 28 bytes a pixel more, 52
  // in double, and RenderRows hands over the whole picture at once.
  std::optional<double> budget;
  // How light is followed; absent: the scene's.
  std::optional<Integrator> integrator;
  // The pixels to render, a rectangle inside the picture that is not empty. The film holds them
  // alone; their bits are those of the whole picture.
  std::optional<PixelRect> crop;
  // What computes it. It never changes a bit of the picture but in fast arithmetic.
  Target target{};
  Precision precision = Precision::kStrict;
  // At most so many threads render, in [1, kMaxThreads]; 0: one a core that the process may use.
  // oneTBB's limit in this process, one a core unless the host sets another, is kept to. It never
  // changes a bit of the picture.
  int threads = 0;
  // Pixels a side of the squares that threads take, in [1, kMaxTileSize]. It never changes a bit of
  // the picture.
  int tile_size = 32;
  // Of RenderRows: pixel rows a band, in [1, kMaxImageSide], rounded up to whole tiles; 0: chosen.
  int band_rows = 0;
  // Whether phases are timed.
  Timing timing = Timing::kOff;
  // What the film holds besides its colours.
  Layers layers;
};

// What a frame is at: its tree is built first, then its pixels are rendered.
enum class RenderStage { kBuilding, kRendering };

// Shared with other threads while a frame renders: they read how far it is, and may ask it to stop.
// For one frame; it outlives the call.
struct RenderProgress {
  std::atomic<RenderStage> stage{RenderStage::kBuilding};
  std::atomic<std::uint64_t> pixels_done{0};  // of those of the picture or crop
  std::atomic<bool> stop{false};              // set it, and the frame ends within a pixel or so
};

// Renders what `camera`, one of the scene's or any other, sees of `scene`. Returns the picture, or
// its crop, in linear light. `stats` is overwritten, `progress` read and written; both may be null.
// Fails with kUsage where an option is out of range, with kScene where the scene or the camera
// breaks a rule of sheaf/scene.h (Validate says which) or the scene has too many primitives, with
// kInterrupted where progress->stop was set. Blocks until the frame is done or has failed.
SHEAF_API Result<Film> Render(const Scene& scene, const Camera& camera,
                              const RenderOptions& options = {}, RenderStats* stats = nullptr,
                              RenderProgress* progress = nullptr);

// Takes the next finished rows from the top, as wide as the picture or crop; `rows` lives as long
// as the call. Calls come in order, one at a time, from any thread.
using RowSink = std::function<Status(const Film& rows)>;

// Renders as Render does, the same bits and errors, in bands of rows that leave memory as they are
// finished: it holds two bands of about 512 KiB, or a row of tiles; while one renders the sink has
// the other. A sink that fails ends the frame: its error is returned, and progress->stop is set.
SHEAF_API Status RenderRows(const Scene& scene, const Camera& camera, const RenderOptions& options,
                            const RowSink& sink, RenderStats* stats = nullptr,
                            RenderProgress* progress = nullptr);

// Renders picture after picture of one scene. What it makes of the scene, such as its trees and
// tables, it keeps for the next picture, so that only the first waits for it; a camera far from the
// origin, another integrator, or the other one of float and double make it anew. Its pictures have
// the bits that the functions above give. It holds the last one of each arithmetic in memory. Any
// number of threads may render by one Renderer at once.
class Renderer {
 public:
  // The scene outlives the Renderer, and nothing changes it meanwhile: make a new one where it
  // moves. Nothing is done before the first picture.
  SHEAF_API explicit Renderer(const Scene& scene);
  SHEAF_API ~Renderer();
  // One that was moved from can only be given another or destroyed.
  SHEAF_API Renderer(Renderer&&) noexcept;
  SHEAF_API Renderer& operator=(Renderer&&) noexcept;

  SHEAF_API const Scene& scene() const;

  // What sheaf::Render does.
  SHEAF_API Result<Film> Render(const Camera& camera, const RenderOptions& options = {},
                                RenderStats* stats = nullptr,
                                RenderProgress* progress = nullptr) const;
  // What sheaf::RenderRows does.
  SHEAF_API Status RenderRows(const Camera& camera, const RenderOptions& options,
                              const RowSink& sink, RenderStats* stats = nullptr,
                              RenderProgress* progress = nullptr) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// ---- Denoising ----

// A denoised pixel depends on those at most so many pixels away across and down, so that a crop
// with so many pixels around it has the bits of the whole picture.
inline constexpr int kDenoiseReach = 44;

// Which filter denoises.
enum class DenoiseFilter {
  kSheaf,  // the library's own, with the same bits everywhere
  kOidn,   // Intel's Open Image Denoise, where the library was built with it; neither `target` nor
           // kDenoiseReach is of it, and its bits are its own
};

// How a film is denoised.
struct DenoiseOptions {
  // What computes it. It never changes a bit of the film.
  Target target{};
  // At most so many threads, in [1, kMaxThreads]; 0: one a core that the process may use. It never
  // changes a bit of the film.
  int threads = 0;
  DenoiseFilter filter = DenoiseFilter::kSheaf;
};

// The film with less noise of the kind that random samples leave, which differs from pixel to pixel
// (docs/denoising.md). Of its layers albedo, normal and depth tell surfaces apart, whichever it
// has; none of them changes. What has no noise stays nearly as it is, a film of one colour to the
// bit. Pixels with a number that is not finite, or beyond 1e15, keep theirs, and are left out of
// all others. It takes about 100 bytes a pixel meanwhile. kUsage where `threads` is out of range,
// or the build lacks the filter. Any number of films may be denoised at once.
SHEAF_API Result<Film> Denoise(const Film& film, const DenoiseOptions& options = {});

}  // namespace sheaf

#endif  // SHEAF_SHEAF_RENDER_H_
