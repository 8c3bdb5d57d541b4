// A frame as the reports of `sheaf pareto` compare it, and the time that it took.
#ifndef SHEAF_APP_RENDER_TIMED_H_
#define SHEAF_APP_RENDER_TIMED_H_

#include "sheaf/error.h"
#include "sheaf/film.h"
#include "sheaf/render.h"
#include "sheaf/scene.h"

namespace sheaf {

struct TimedFrame {
  Film film;  // clamped as a display shows it
  double seconds;
};

// Fails with kInterrupted too, where Ctrl-C came.
Result<TimedFrame> RenderTimed(const Scene& scene, const Camera& camera,
                               const RenderOptions& options);

}  // namespace sheaf

#endif  // SHEAF_APP_RENDER_TIMED_H_
