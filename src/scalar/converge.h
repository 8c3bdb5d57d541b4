// Samples until the error of their mean is small: which pixels need no more.
#ifndef SHEAF_SCALAR_CONVERGE_H_
#define SHEAF_SCALAR_CONVERGE_H_

#include <bit>
#include <cstdint>

#include "sheaf/render.h"
#include "src/core/vec3.h"

namespace sheaf::scalar {

// From kLeastErrorSamples on a pixel is judged at powers of two, where Sobol's points are spread
// most evenly.
constexpr bool IsJudgedAt(std::uint32_t samples) {
  return samples >= kLeastErrorSamples && std::has_single_bit(samples);
}

// Whether the error of one channel's mean is at most `error`, of colours above 1 as a part of them:
// by the samples' variance, and by what they cannot have seen. That none of n samples differed does
// not say that no further one will: a quarter of one more like nothing seen is taken for granted.
template <typename Real>
bool IsConverged(Real sum, Real squares, std::uint32_t samples, Real error) {
  const Real n = static_cast<Real>(samples);
  const Real mean = sum / n;
  const Real limit = mean > 1 ? error * mean : error;
  const Real spread = squares / n - mean * mean;
  const Real variance = (spread > 0 ? spread : Real(0)) / (n - 1);
  return variance <= limit * limit && mean <= (4 * n) * limit;
}

template <typename Real>
bool IsConverged(Vec3<Real> sum, Vec3<Real> squares, std::uint32_t samples, Real error) {
  return IsConverged(sum.x, squares.x, samples, error) &&
         IsConverged(sum.y, squares.y, samples, error) &&
         IsConverged(sum.z, squares.z, samples, error);
}

// A pixel's samples so far, added up in their order.
template <typename Real>
struct PixelSums {
  Vec3<Real> sum = {0, 0, 0}, squares = {0, 0, 0};
  std::uint32_t samples = 0;

  void Add(Vec3<Real> colour) {
    sum = sum + colour;
    squares = squares + Vec3<Real>{colour.x * colour.x, colour.y * colour.y, colour.z * colour.z};
    ++samples;
  }
  // Whether `error` is reached, now that they are judged.
  bool IsConverged(Real error) const {
    return IsJudgedAt(samples) && scalar::IsConverged(sum, squares, samples, error);
  }
  Vec3<Real> mean() const { return sum / static_cast<Real>(samples); }
};

}  // namespace sheaf::scalar

#endif  // SHEAF_SCALAR_CONVERGE_H_
