// A whole frame: from a scene to rows of pixels.
#ifndef SHEAF_RENDER_RENDER_FRAME_H_
#define SHEAF_RENDER_RENDER_FRAME_H_

#include <functional>

#include "sheaf/error.h"
#include "sheaf/render.h"
#include "sheaf/scene.h"
#include "src/render/band_queue.h"
#include "src/render/prepare_scene.h"
#include "src/render/sample_round.h"

namespace sheaf {

// Checks the options and renders in the arithmetic that they ask for. `stats` and `progress` may be
// null.
Status RenderFrame(ScenePreparer& scene, const Camera& camera, const RenderOptions& options,
                   Skips skips, const BandSink& sink, RenderStats* stats, RenderProgress* progress);

// The same of a frame with a budget, of which `used` tells the part that is used.
Status RenderWhile(const TimeUsed& used, ScenePreparer& scene, const Camera& camera,
                   const RenderOptions& options, const BandSink& sink, RenderStats& stats,
                   RenderProgress& progress);

// Which pixels of the picture come next; false: none. It may wait.
using AreaSource = std::function<bool(PixelRect* area)>;

// Takes an area's pixels, and may take the film's contents away.
using AreaSink = std::function<Status(const PixelRect& area, Film& pixels)>;

// The same for areas that become known one after another: the scene is compiled once, before the
// first is asked for, and each is rendered with all threads. Where they begin at whole tiles of the
// picture they have its bits in every arithmetic, else in all but the fast one. Times of `stats`
// are without what the source and the sink take.
Status RenderAreas(const Scene& scene, const Camera& camera, const RenderOptions& options,
                   const AreaSource& next, const AreaSink& sink, RenderStats* stats,
                   RenderProgress* progress);

}  // namespace sheaf

#endif  // SHEAF_RENDER_RENDER_FRAME_H_
