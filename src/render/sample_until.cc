#include "src/render/sample_until.h"

#include <algorithm>
#include <numeric>

#include "src/scalar/converge.h"

namespace sheaf {

template <typename Real>
void ConvergingMeans<Real>::Start(const PixelList<Real>& pixels, const ColourView<Real>& sample) {
  const std::uint32_t count = pixels.count;
  wanting_.Reserve(count);
  wanting_.count = count;
  std::copy_n(pixels.x.data(), count, wanting_.x.data());
  std::copy_n(pixels.y.data(), count, wanting_.y.data());
  positions_.resize(count);
  std::iota(positions_.begin(), positions_.end(), 0u);
  samples_.assign(count, 1);
  sums_.Reserve(count);
  squares_.Reserve(count);
  const auto sums = sums_.output(), squares = squares_.output();
  ForEachField(sums, sample,
               [&](Real* sum, const Real* channel) { std::copy_n(channel, count, sum); });
  ForEachField(squares, sample, [&](Real* square, const Real* channel) {
    for (std::uint32_t i = 0; i < count; ++i) square[i] = channel[i] * channel[i];
  });
}

template <typename Real>
void ConvergingMeans<Real>::Add(const ColourView<Real>& sample, Real error) {
  const auto sums = sums_.output(), squares = squares_.output();
  ForEachField(sums, sample, [&](Real* sum, const Real* channel) {
    for (std::uint32_t i = 0; i < wanting_.count; ++i) sum[positions_[i]] += channel[i];
  });
  ForEachField(squares, sample, [&](Real* square, const Real* channel) {
    for (std::uint32_t i = 0; i < wanting_.count; ++i) {
      square[positions_[i]] += channel[i] * channel[i];
    }
  });
  std::uint32_t left = 0;
  for (std::uint32_t i = 0; i < wanting_.count; ++i) {
    const std::uint32_t at = positions_[i], samples = ++samples_[at];
    if (scalar::IsJudgedAt(samples) &&
        scalar::IsConverged<Real>({sums.r[at], sums.g[at], sums.b[at]},
                                  {squares.r[at], squares.g[at], squares.b[at]}, samples, error)) {
      continue;
    }
    wanting_.x[left] = wanting_.x[i];
    wanting_.y[left] = wanting_.y[i];
    positions_[left++] = at;
  }
  wanting_.count = left;
}

template <typename Real>
void ConvergingMeans<Real>::Divide() {
  const auto sums = sums_.output();
  ForEachField(sums, [&](Real* sum) {
    for (std::size_t i = 0; i < samples_.size(); ++i) sum[i] /= static_cast<Real>(samples_[i]);
  });
}

template class ConvergingMeans<float>;
template class ConvergingMeans<double>;

}  // namespace sheaf
