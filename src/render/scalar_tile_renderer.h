// Renders tiles by src/scalar, one ray at a time: what TileRenderer is to the SIMD targets.
#ifndef SHEAF_RENDER_SCALAR_TILE_RENDERER_H_
#define SHEAF_RENDER_SCALAR_TILE_RENDERER_H_

#include <atomic>

#include "src/render/tile_worker.h"
#include "src/scalar/render_pixel.h"
#include "src/stream/frame_view.h"

namespace sheaf {

// Keeps no time by phase. `frame` outlives it.
template <typename Real>
class ScalarTileRenderer : public TileWorker {
 public:
  // Once `stop` is set a call of Render ends soon, and what it leaves is rubbish.
  ScalarTileRenderer(const FrameView<Real>& frame, const std::atomic<bool>& stop)
      : TileWorker(PhaseClock(Timing::kOff, 1)), frame_(frame), stop_(stop) {}

  void Render(const PixelRect& tile, int film_x, int film_y, Film& film) override;
  void RenderRound(const PixelRect& tile, int film_x, int film_y, Film& film,
                   SampleRound& round) override;

 private:
  // The layers, where the film has any, and the colour of a pixel.
  void Write(int x, int y, const Vec3<Real>& colour, const FirstHit<Real>& first, Film& film) const;

  const FrameView<Real>& frame_;
  const std::atomic<bool>& stop_;
  scalar::PixelScratch<Real> scratch_;
};

}  // namespace sheaf

#endif  // SHEAF_RENDER_SCALAR_TILE_RENDERER_H_
