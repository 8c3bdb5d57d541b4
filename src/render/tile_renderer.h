// Renders one tile at a time, breadth first: the schedule of a frame.
#ifndef SHEAF_RENDER_TILE_RENDERER_H_
#define SHEAF_RENDER_TILE_RENDERER_H_

#include <algorithm>
#include <atomic>
#include <chrono>
#include <type_traits>
#include <vector>

#include "sheaf/render.h"
#include "simd/kernels.h"
#include "simd/shading.h"
#include "simd/streams.h"
#include "src/render/bin_hits.h"
#include "src/render/ray_queue.h"
#include "src/stream/first_hit.h"
#include "src/stream/frame_view.h"
#include "src/stream/stream.h"

namespace sheaf {

// One worker's buffers and statistics. `frame` outlives it.
template <typename Real>
class TileRenderer {
 public:
  // Takes of the options the target, the precision, strict or fast, and the timing. Once `stop` is
  // set a call of Render ends soon, and what it leaves is rubbish.
  TileRenderer(const FrameView<Real>& frame, const RenderOptions& options,
               const std::atomic<bool>& stop)
      : frame_(frame),
        kernels_(KernelsFor(options)),
        binner_(frame.materials.size()),
        timing_(options.timing),
        stop_(stop),
        lanes_(kernels_.report_target().lanes) {}

  // Renders the pixels of `tile`, in picture coordinates, into `film`, whose top left pixel is
  // (film_x, film_y).
  void Render(const PixelRect& tile, int film_x, int film_y, Film& film);

  const RayCounts& rays() const { return rays_; }
  double phase_seconds(Phase phase) const { return seconds_[static_cast<int>(phase)]; }
  const LaneUse& lane_use(Phase phase) const { return lane_use_[static_cast<int>(phase)]; }

 private:
  using Clock = std::chrono::steady_clock;

  // Pixels whose samples are traced together.
  struct PixelList {
    AlignedArray<Real> x, y;  // of each pixel's corner, whole numbers
    std::uint32_t count = 0;

    std::uint32_t capacity() const { return capacity_; }
    void Reserve(std::uint32_t n) {
      if (n <= capacity_) return;
      capacity_ = n;
      x.Allocate(StreamCapacity(n));
      y.Allocate(StreamCapacity(n));
    }

   private:
    std::uint32_t capacity_ = 0;
  };

  static Kernels<Real> KernelsFor(const RenderOptions& options) {
    if constexpr (std::is_same_v<Real, float>) {
      if (options.precision == Precision::kFast) return FastKernels(options.target.id());
    }
    return StrictKernels<Real>(options.target.id());
  }

  void RenderAdaptively(const PixelRect& tile);
  void FindEdges(const PixelRect& tile);
  void OrderPixels(const PixelRect& tile);
  void RenderSample(const PixelList& pixels, std::size_t sample);
  void Generate(const PixelList& pixels, std::size_t sample);
  void TraceAndShade(const RayQueue<Real>& queue, int depth);
  void ShadeBin(const RayQueue<Real>& queue, const HitBin& bin, int depth);
  void ShadeLights(const MaterialData<Real>& material, const SurfaceView<Real>& surfaces,
                   std::uint32_t count);
  // Returns how many surfaces the light reaches.
  std::uint32_t FindShadows(const LightData<Real>& light, const SurfaceView<Real>& surfaces,
                            std::uint32_t count);
  void Spawn(const RayQueue<Real>& queue, const MaterialData<Real>& material,
             const SurfaceView<Real>& surfaces, std::uint32_t count, int depth);
  void FinishSpawn(const RayQueue<Real>& queue, RayQueue<Real>& children, std::uint32_t first,
                   int depth, int spawning_bins);
  void Accumulate(const RayQueue<Real>& queue);
  void AddSample(std::size_t index);
  void AddSampleOfEdges(std::size_t index);
  void RecordFirstHits(const HitBin& bin);
  // Gives the pixels of `tile` the layers of rays that meet nothing.
  void ClearLayers(const PixelRect& tile);
  void RecordLayers(const HitBin& bin, const MaterialData<Real>& material);
  void WritePixels(const PixelRect& tile, int film_x, int film_y, Film& film);
  // The pixel of pixels_ at a place of the picture within ordered_.
  std::uint32_t PixelAt(int x, int y) const {
    return pixel_at_[static_cast<std::size_t>((y - ordered_.y0) * ordered_.width() +
                                              (x - ordered_.x0))];
  }
  void Reserve(std::uint32_t count);
  void StartClock();
  void Charge(Phase phase);
  void Charge(Phase phase, std::uint32_t live, std::uint32_t count);

  const FrameView<Real>& frame_;
  const Kernels<Real> kernels_;
  HitBinner binner_;
  Timing timing_;
  const std::atomic<bool>& stop_;
  RayCounts rays_;
  double seconds_[static_cast<int>(Phase::kCount)] = {};
  LaneUse lane_use_[static_cast<int>(Phase::kCount)] = {};
  std::uint32_t lanes_;
  Clock::time_point clock_;

  PixelRect ordered_;                    // the tile that pixels_ are of
  PixelList pixels_;                     // in Morton order
  std::vector<std::uint32_t> pixel_at_;  // position in pixels_, by row and column of ordered_
  ColourStream<Real> sample_;            // of the list that is being traced
  ColourStream<Real> mean_;              // by pixel of pixels_, where there are several samples
  PixelList edges_;                      // the pixels of pixels_ that get all samples
  std::vector<std::uint32_t> position_of_edge_;  // in pixels_
  std::vector<FirstHit<Real>> first_hits_;       // by pixel of pixels_
  std::vector<bool> is_edge_;                    // by pixel of pixels_
  bool records_first_hits_ = false;
  Film* layered_ = nullptr;  // where the layers of the sample in work go; null: it leaves none
  PixelRect layered_tile_;
  int layered_x_ = 0, layered_y_ = 0;  // the film's top left pixel

  RayQueue<Real> primary_;
  // The rays of this depth and of the next; reflected before refracted wherever their order counts.
  RayQueue<Real> reflected_, refracted_, next_reflected_, next_refracted_;
  ParentOrder<Real> parent_order_;
  int reflecting_bins_ = 0, refracting_bins_ = 0;

  std::uint32_t reserved_ = 0;  // rays that the streams below have room for
  HitStream<Real> hits_;
  SurfaceStream<Real> surfaces_;
  ColourStream<Real> ray_colours_, surface_colours_;
  RayStream<Real> shadow_rays_;
  AlignedArray<std::uint32_t> lit_, surface_of_ray_, occluded_;
};

}  // namespace sheaf

#endif  // SHEAF_RENDER_TILE_RENDERER_H_
