// What `sheaf pareto` found, as a table, JSON and a chart.
#ifndef SHEAF_APP_PARETO_REPORT_H_
#define SHEAF_APP_PARETO_REPORT_H_

#include <optional>
#include <string>
#include <vector>

#include "sheaf/error.h"
#include "sheaf/render.h"

namespace sheaf {

// One setting and what it gave. Errors are RMSE over all channels of linear light, clamped to [0,
// 1].
struct ParetoPoint {
  std::string renderer;   // a target, or "POV-Ray"
  std::string precision;  // "strict", "fast" or "double"; empty for a peer
  std::string setting;    // e.g. "strict, 4 spp, adaptive 0.05"
  // Median of one frame; none where the peer's clock is too coarse for it.
  std::optional<double> seconds;
  double error = 0;  // against the converged picture
  // Against the same samples in double; none for a peer, whose are unknown.
  std::optional<double> numeric;
  double sampling = 0;  // of the same samples in double against the converged picture
  bool is_on_front = false;
};

// Marks the points that no other beats in time without losing in error, of those with a time.
void MarkFront(std::vector<ParetoPoint>& points);

// The cheapest point of an error up to `error`, the best that takes up to `seconds`; null if none.
const ParetoPoint* CheapestFor(const std::vector<ParetoPoint>& points, double error);
const ParetoPoint* BestFor(const std::vector<ParetoPoint>& points, double seconds);

// One line a point that has a time: renderer, setting, milliseconds, errors.
std::string PointText(const ParetoPoint& point);

// What the points have in common.
struct ParetoTitle {
  std::string scene, camera;
  int width, height, reference_samples, threads, repetitions;
};

// Writes STEM.csv, STEM.json and, with gnuplot, STEM.svg and STEM.png. Returns the paths.
Result<std::vector<std::string>> WriteParetoReport(const ParetoTitle& title,
                                                   const std::vector<ParetoPoint>& points,
                                                   const std::string& stem);

}  // namespace sheaf

#endif  // SHEAF_APP_PARETO_REPORT_H_
