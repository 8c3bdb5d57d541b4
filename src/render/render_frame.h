// A whole frame: from a scene to rows of pixels.
#ifndef SHEAF_RENDER_RENDER_FRAME_H_
#define SHEAF_RENDER_RENDER_FRAME_H_

#include "sheaf/error.h"
#include "sheaf/render.h"
#include "sheaf/scene.h"
#include "src/render/band_queue.h"

namespace sheaf {

// Whether work that a scene does not need is left out. It changes no bit; tests see to that.
enum class Skips { kOn, kOff };

// Checks the options and renders in the arithmetic that they ask for. `stats` and `progress` may be
// null.
Status RenderFrame(const Scene& scene, const Camera& camera, const RenderOptions& options,
                   Skips skips, const BandSink& sink, RenderStats* stats, RenderProgress* progress);

}  // namespace sheaf

#endif  // SHEAF_RENDER_RENDER_FRAME_H_
