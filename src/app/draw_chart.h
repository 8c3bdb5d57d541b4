// Charts by gnuplot, as SVG and PNG.
#ifndef SHEAF_APP_DRAW_CHART_H_
#define SHEAF_APP_DRAW_CHART_H_

#include <string>

#include "sheaf/error.h"

namespace sheaf {

// `text` as gnuplot reads it.
std::string GnuplotString(const std::string& text);

// Runs `setup`, then `plot` once for each of STEM.svg and STEM.png: both appear, or neither.
Status DrawChart(const std::string& setup, const std::string& plot, const std::string& stem);

}  // namespace sheaf

#endif  // SHEAF_APP_DRAW_CHART_H_
