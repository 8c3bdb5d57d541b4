// The mean of a checker over a footprint.
#ifndef SHEAF_SCALAR_FILTER_CHECKER_H_
#define SHEAF_SCALAR_FILTER_CHECKER_H_

#include <cmath>

#include "simd/checker_terms.h"

namespace sheaf::scalar {

// The mean over [x - width / 2, x + width / 2] of the square wave that is 1 in [0, 1), -1 in [1,
// 2), and so on. A width of NaN counts as infinite.
template <typename Real>
Real MeanOfSquareWave(Real x, Real width) {
  const Real many = kManyCells;
  const Real w = width < many ? width : many;
  if (w > 1) {
    // The difference of two values of the wave's integral, a triangle wave.
    const auto integral = [](Real at) {
      const Real within = at - 2 * std::floor(at / 2);
      return 1 - std::abs(within - 1);
    };
    const Real half = w / 2;
    return (integral(x + half) - integral(x - half)) / w;
  }
  // At most one edge lies within the box. By the distance to it nothing cancels, however small the
  // box.
  const Real cell = std::floor(x), within = x - cell;
  const Real twice = 2 * (within < Real(0.5) ? within : 1 - within);
  const Real mean = twice < w ? twice / w : Real(1);
  return cell != 2 * std::floor(cell / 2) ? -mean : mean;
}

// The share of the even cells in a footprint of `width_u` by `width_v` cells: Quilez, "Filtering
// the Checkerboard Pattern".
template <typename Real>
Real EvenShare(Real u, Real v, Real width_u, Real width_v) {
  const Real mean = MeanOfSquareWave(u, width_u) * MeanOfSquareWave(v, width_v);
  return Real(0.5) + Real(0.5) * mean;
}

}  // namespace sheaf::scalar

#endif  // SHEAF_SCALAR_FILTER_CHECKER_H_
