#include "src/app/render_timed.h"

#include <algorithm>
#include <utility>

#include "src/app/interrupt.h"
#include "src/app/progress.h"

namespace sheaf {
namespace {

// A highlight far above white would outweigh every visible error.
Film PictureOf(Film film) {
  for (float& value : film.rgb) value = value > 0 ? std::min(value, 1.0f) : 0.0f;
  return film;
}

}  // namespace

Result<TimedFrame> RenderTimed(const Scene& scene, const Camera& camera,
                               const RenderOptions& options) {
  FrameWatch watch(ProgressStyle::kNone, camera.name, options, 1);
  RenderStats stats;
  Result<Film> film = Render(scene, camera, options, &stats, watch.progress());
  if (!film) return film.error();
  // The watch wakes ten times a second; a frame may be shorter.
  if (const Status going = CheckInterrupted(); !going) return going.error();
  return TimedFrame{PictureOf(std::move(film).value()), stats.wall_seconds};
}

}  // namespace sheaf
