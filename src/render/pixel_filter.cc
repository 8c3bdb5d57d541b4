#include "src/render/pixel_filter.h"

#include <algorithm>
#include <array>
#include <numbers>

#include "src/scalar/pow.h"
#include "src/scalar/sin_cos.h"

namespace sheaf {
namespace {

constexpr double kReach = 1.5;  // pixels to each side
constexpr int kCells = 3000;

double GaussianAt(double x) {  // of a standard deviation of 1/2
  return scalar::Exp2<double>(-2 * x * x * std::numbers::log2e);
}

// Harris, "On the Use of Windows for Harmonic Analysis" (Proc. IEEE 66(1), 1978): four terms.
double BlackmanHarrisAt(double x) {
  const double turn = 2 * x / kReach;  // quarter turns
  return 0.35875 + 0.48829 * scalar::SinCosOf(turn).cos + 0.14128 * scalar::SinCosOf(2 * turn).cos +
         0.01168 * scalar::SinCosOf(3 * turn).cos;
}

// The weight before the end of each cell, of all of it.
using Weights = std::array<double, kCells + 1>;

Weights SumWeights(double (*weight_at)(double)) {
  Weights sums{};
  for (int i = 0; i < kCells; ++i) {
    const double x = -kReach + 2 * kReach * (i + 0.5) / kCells;
    sums[static_cast<std::size_t>(i) + 1] = sums[static_cast<std::size_t>(i)] + weight_at(x);
  }
  const double all = sums.back();
  for (double& sum : sums) sum /= all;
  return sums;
}

double PlaceIn(const Weights& sums, double share) {
  const auto above = std::upper_bound(sums.begin() + 1, sums.end() - 1, share);
  const auto cell = static_cast<std::size_t>(above - sums.begin()) - 1;
  const double width = sums[cell + 1] - sums[cell];
  const double part = width > 0 ? (share - sums[cell]) / width : 0.5;
  return 0.5 - kReach + 2 * kReach * (static_cast<double>(cell) + part) / kCells;
}

}  // namespace

double FilterPlace(PixelFilter filter, double share) {
  switch (filter) {
    case PixelFilter::kBox:
      break;
    case PixelFilter::kGaussian: {
      static const Weights kSums = SumWeights(&GaussianAt);
      return PlaceIn(kSums, share);
    }
    case PixelFilter::kBlackmanHarris: {
      static const Weights kSums = SumWeights(&BlackmanHarrisAt);
      return PlaceIn(kSums, share);
    }
  }
  return share;
}

}  // namespace sheaf
