#include "src/render/average_samples.h"

#include <algorithm>

namespace sheaf {

// Colours are never -0: a copy has the bits of a sum that starts at 0.
template <typename Real>
void SampleMeans<Real>::Start(const ColourView<Real>& sample, std::uint32_t count) {
  count_ = count;
  sums_.Reserve(count);
  const auto sums = sums_.output();
  ForEachField(sums, sample,
               [&](Real* sum, const Real* channel) { std::copy_n(channel, count, sum); });
}

template <typename Real>
void SampleMeans<Real>::Add(const ColourView<Real>& sample) {
  const auto sums = sums_.output();
  ForEachField(sums, sample, [&](Real* sum, const Real* channel) {
    for (std::uint32_t i = 0; i < count_; ++i) sum[i] += channel[i];
  });
}

template <typename Real>
void SampleMeans<Real>::Divide(int samples) {
  const auto sums = sums_.output();
  ForEachField(sums, [&](Real* sum) {
    for (std::uint32_t i = 0; i < count_; ++i) sum[i] /= static_cast<Real>(samples);
  });
}

template <typename Real>
void SampleMeans<Real>::AddAt(std::span<const std::uint32_t> positions,
                              const ColourView<Real>& sample) {
  const auto sums = sums_.output();
  ForEachField(sums, sample, [&](Real* sum, const Real* channel) {
    for (std::size_t i = 0; i < positions.size(); ++i) sum[positions[i]] += channel[i];
  });
}

template <typename Real>
void SampleMeans<Real>::DivideAt(std::span<const std::uint32_t> positions, int samples) {
  const auto sums = sums_.output();
  ForEachField(sums, [&](Real* sum) {
    for (const std::uint32_t i : positions) sum[i] /= static_cast<Real>(samples);
  });
}

template class SampleMeans<float>;
template class SampleMeans<double>;

}  // namespace sheaf
