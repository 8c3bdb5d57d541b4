// Times a frame on every row of a report.
#ifndef SHEAF_APP_MEASURE_BENCH_H_
#define SHEAF_APP_MEASURE_BENCH_H_

#include "sheaf/error.h"
#include "sheaf/render.h"
#include "sheaf/scene.h"
#include "src/app/bench_report.h"
#include "src/app/progress.h"

namespace sheaf {

// Renders two frames of each row, which also tell its rays: after that the buffers of every row
// have their memory, whichever rows there are.
Status WarmUp(const Scene& scene, const Camera& camera, const RenderOptions& options,
              BenchReport& report);

// Fills the rows. Every repetition takes each of them once, beginning with another one: a drift of
// the clock meets all alike. The machine is calibrated before and after each frame.
Status Measure(const Scene& scene, const Camera& camera, const RenderOptions& options,
               int repetitions, ProgressStyle style, BenchReport& report);

}  // namespace sheaf

#endif  // SHEAF_APP_MEASURE_BENCH_H_
