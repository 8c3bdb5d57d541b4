// Renders a camera with every setting that trades time for error.
#ifndef SHEAF_APP_MEASURE_PARETO_H_
#define SHEAF_APP_MEASURE_PARETO_H_

#include <vector>

#include "sheaf/error.h"
#include "sheaf/render.h"
#include "sheaf/scene.h"
#include "src/app/pareto_report.h"
#include "src/app/pareto_request.h"

namespace sheaf {

// One point a setting, and one a setting of POV-Ray where that is installed; the front is marked.
// `base` has what the settings share.
Result<std::vector<ParetoPoint>> MeasureCamera(const ParetoRequest& request, const Scene& scene,
                                               const Camera& camera, const RenderOptions& base,
                                               int repetitions);

}  // namespace sheaf

#endif  // SHEAF_APP_MEASURE_PARETO_H_
