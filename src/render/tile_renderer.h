// Renders one tile at a time, breadth first: the schedule of a frame.
#ifndef SHEAF_RENDER_TILE_RENDERER_H_
#define SHEAF_RENDER_TILE_RENDERER_H_

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>

#include "sheaf/render.h"
#include "simd/kernels.h"
#include "simd/shading.h"
#include "simd/streams.h"
#include "src/render/average_samples.h"
#include "src/render/bin_hits.h"
#include "src/render/find_edges.h"
#include "src/render/held_rays.h"
#include "src/render/instanced_hits.h"
#include "src/render/pixel_order.h"
#include "src/render/ray_queue.h"
#include "src/render/record_first_hits.h"
#include "src/render/sample_source.h"
#include "src/render/sample_until.h"
#include "src/render/shade_lights.h"
#include "src/render/tile_worker.h"
#include "src/stream/frame_view.h"
#include "src/stream/stream.h"

namespace sheaf {

// One worker's buffers and statistics. `frame` outlives it.
template <typename Real>
class TileRenderer : public TileWorker {
 public:
  // Takes of the options the target, the precision, strict or fast, the timing and the layers. Once
  // `stop` is set a call of Render ends soon, and what it leaves is rubbish.
  TileRenderer(const FrameView<Real>& frame, const RenderOptions& options,
               const std::atomic<bool>& stop);

  void Render(const PixelRect& tile, int film_x, int film_y, Film& film) override;
  void RenderRound(const PixelRect& tile, int film_x, int film_y, Film& film,
                   SampleRound& round) override;
  std::size_t buffer_bytes() const override;

 private:
  TileRenderer(const FrameView<Real>& frame, const Kernels<Real>& kernels,
               const RenderOptions& options, const std::atomic<bool>& stop);

  // Leaves the pixels' colours in sample_. Tells `recorder`, unless that is null, what their
  // primary rays hit.
  void RenderSample(const PixelList<Real>& pixels, std::size_t sample,
                    FirstHitRecorder<Real>* recorder);
  // The secondary rays that the primary ones sent on, and theirs, to the end.
  void FollowRays(std::uint32_t pixels);
  // Rays of this depth, whose children make the next.
  void ShadeDepth(int depth, std::uint32_t most);
  void GeneratePrimary(const PixelList<Real>& pixels, std::size_t sample);
  // Leaves hits_ and the bins. Returns the batch with each ray as what it hits sees it.
  RayBatch<Real> Trace(const RayBatch<Real>& batch);
  // What was traced last, rays of this depth; `seen` is what Trace returned.
  void Shade(const RayBatch<Real>& batch, const RayBatch<Real>& seen, int depth,
             ColourStream<Real>& colours, FirstHitRecorder<Real>* recorder);
  // By which facets surfaces send rays on and, of paths, which of these are followed.
  void ChooseRays(const PathView<Real>& parents, int depth, const MaterialData<Real>& material,
                  const SurfaceView<Real>& surfaces, std::uint32_t count);
  void Spawn(const PathView<Real>& parents, const MaterialData<Real>& material,
             const SurfaceView<Real>& surfaces, std::uint32_t count);
  RayQueue<Real>& next(ChildKind kind) { return next_queues_[static_cast<std::size_t>(kind)]; }
  void RefineEdges(const PixelRect& tile);
  void RefineAll();
  // Where they are not, they get samples until is_over().
  template <class IsOver>
  void RefineUntilConverged(IsOver is_over);
  // Of the samples of the ordered pixels.
  ColourView<Real> means() const;
  void WritePixels(const PixelRect& tile, int film_x, int film_y, Film& film);
  std::uint32_t sample_count() const { return static_cast<std::uint32_t>(frame_.sample_x.size()); }
  bool IsStopped() const { return stop_.load(std::memory_order_relaxed); }

  const FrameView<Real>& frame_;
  const Kernels<Real> kernels_;
  const std::atomic<bool>& stop_;
  const std::uint64_t surface_fields_, texel_fields_,
      path_fields_;  // that the frame's materials read
  HitBinner binner_;
  InstancedHits<Real> instanced_;
  SampleSource<Real> samples_;
  LightShader<Real> lights_;

  PixelOrder<Real> order_;             // of the tile, or of it and its neighbours
  ColourStream<Real> sample_;          // by pixel of the list that is traced
  SampleMeans<Real> means_;            // by ordered pixel, where there are several samples
  ConvergingMeans<Real> converging_;   // likewise, where their number is not settled
  FirstHitRecorder<Real> first_hits_;  // by ordered pixel
  EdgeFinder<Real> edges_;

  PrimaryRays<Real> primary_;
  // The rays of this depth and of the next, by kind.
  RayQueue<Real> queue_sets_[2][kChildKinds];
  std::span<RayQueue<Real>, kChildKinds> queues_{queue_sets_[0]}, next_queues_{queue_sets_[1]};
  HeldRays<Real> held_;
  ParentOrder<Real> parent_order_;

  HitStream<Real> hits_;
  SurfaceStream<Real> surfaces_;
  TexelStream<Real> texels_;  // of the bin in work
  ColourStream<Real> ray_colours_, surface_colours_;
};

}  // namespace sheaf

#endif  // SHEAF_RENDER_TILE_RENDERER_H_
