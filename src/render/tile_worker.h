// One thread's part in a frame: it renders tile after tile and counts what they took.
#ifndef SHEAF_RENDER_TILE_WORKER_H_
#define SHEAF_RENDER_TILE_WORKER_H_

#include <cstddef>

#include "sheaf/film.h"
#include "sheaf/stats.h"
#include "src/render/phase_clock.h"
#include "src/render/sample_round.h"

namespace sheaf {

class TileWorker {
 public:
  virtual ~TileWorker() = default;

  // Renders the pixels of `tile`, in picture coordinates, into `film`, whose top left pixel is
  // (film_x, film_y).
  virtual void Render(const PixelRect& tile, int film_x, int film_y, Film& film) = 0;

  // The same for a round of a frame: the pixels of `tile` whose error is above the round's goal get
  // samples, which are added to the round's sums. The first round alone writes into `film`.
  virtual void RenderRound(const PixelRect& tile, int film_x, int film_y, Film& film,
                           SampleRound& round) = 0;

  // What its buffers take, in bytes.
  virtual std::size_t buffer_bytes() const { return 0; }

  const RayCounts& rays() const { return rays_; }
  const PhaseClock& clock() const { return clock_; }

 protected:
  explicit TileWorker(const PhaseClock& clock) : clock_(clock) {}

  RayCounts rays_;
  PhaseClock clock_;
};

}  // namespace sheaf

#endif  // SHEAF_RENDER_TILE_WORKER_H_
