// The error and the time of a picture by where its scene lies and what its unit of length is.
#ifndef SHEAF_APP_MEASURE_PLACES_H_
#define SHEAF_APP_MEASURE_PLACES_H_

#include <cstdint>
#include <string>
#include <vector>

#include "sheaf/error.h"
#include "sheaf/render.h"
#include "sheaf/scene.h"
#include "src/app/pareto_report.h"
#include "src/app/pareto_request.h"

namespace sheaf {

// One place and precision, one sample a pixel.
struct PlacePoint {
  double moved, scaled;    // the scene is scaled first
  std::string precision;   // or "POV-Ray", where that is installed
  double seconds = 0;      // median of one frame; POV-Ray tells whole milliseconds
  std::uint64_t over = 0;  // pixels more than 1/255 off the scene where it was made, in double
  double error = 0;        // RMSE against that
};

// Every place of the request in strict, fast and double, on the best target, and by POV-Ray where
// it is installed and knows the projection.
Result<std::vector<PlacePoint>> MeasurePlaces(const ParetoRequest& request, const Scene& scene,
                                              const Camera& camera, const RenderOptions& base,
                                              int repetitions);

// Writes STEM-places.csv, .json and, with gnuplot, .svg and .png. Returns the paths.
Result<std::vector<std::string>> WritePlaceReport(const ParetoTitle& title,
                                                  const std::vector<PlacePoint>& points,
                                                  const std::string& stem);

// One line a point.
std::string PlaceText(const PlacePoint& point);

}  // namespace sheaf

#endif  // SHEAF_APP_MEASURE_PLACES_H_
