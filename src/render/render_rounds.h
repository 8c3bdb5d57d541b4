// A frame that is given time: rounds of samples with a falling error, until the time is used.
#ifndef SHEAF_RENDER_RENDER_ROUNDS_H_
#define SHEAF_RENDER_RENDER_ROUNDS_H_

#include "sheaf/error.h"
#include "sheaf/render.h"
#include "sheaf/stats.h"
#include "src/render/band_queue.h"
#include "src/render/sample_round.h"
#include "src/render/tile_crew.h"

namespace sheaf {

// The least error that a frame with a budget alone goes on to.
inline constexpr double kLeastGoal = 1e-5;

// The error that a round, from 0, ends at: 1, 0.8, 0.63, 0.5, 0.4, 0.315, 0.25, 0.2, 0.16, 0.125,
// and the same of a tenth. Where a pixel's samples double, its error falls by two or three of them.
double RoundGoal(int round);

// Renders the frame in rounds: each goes on with the samples of the one before, where the error is
// above its goal. The sink gets the picture of the last round that was whole, in one piece: the
// bits that `RenderOptions::error` of its goal gives. `options` were checked. `stats` tells what
// was reached.
Status RenderRounds(const RenderOptions& options, const MakeWorker& make_worker,
                    const TimeUsed& used, const BandSink& sink, RenderStats& stats,
                    RenderProgress& progress);

}  // namespace sheaf

#endif  // SHEAF_RENDER_RENDER_ROUNDS_H_
