// Hands a frame's tiles to threads, and its finished rows to a sink.
#ifndef SHEAF_RENDER_RENDER_BANDS_H_
#define SHEAF_RENDER_RENDER_BANDS_H_

#include "sheaf/error.h"
#include "sheaf/film.h"
#include "sheaf/render.h"
#include "sheaf/stats.h"
#include "src/render/band_queue.h"
#include "src/render/tile_crew.h"

namespace sheaf {

// Renders `area` of the picture band by band; the sink has one band while the next renders. Each of
// the threads gets a worker of its own from `make_worker`, which is called before any ray is
// traced. Fills of `stats` the threads, the time and what the workers counted.
Status RenderBands(const PixelRect& area, const RenderOptions& options,
                   const MakeWorker& make_worker, const BandSink& sink, RenderStats& stats,
                   RenderProgress& progress);

}  // namespace sheaf

#endif  // SHEAF_RENDER_RENDER_BANDS_H_
