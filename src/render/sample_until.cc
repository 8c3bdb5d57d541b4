#include "src/render/sample_until.h"

#include <algorithm>

#include "src/scalar/converge.h"

namespace sheaf {

template <typename Real>
void ConvergingMeans<Real>::Reserve(const PixelList<Real>& pixels, std::uint32_t limit,
                                    Real error) {
  all_ = &pixels;
  limit_ = limit;
  error_ = error;
  sums_.Reserve(pixels.count);
  squares_.Reserve(pixels.count);
  wanting_.Reserve(pixels.count);
  positions_.resize(pixels.count);
  samples_.assign(pixels.count, 1);
  is_done_.assign(pixels.count, limit <= 1);
}

template <typename Real>
void ConvergingMeans<Real>::Start(const PixelList<Real>& pixels, const ColourView<Real>& sample,
                                  std::uint32_t limit, Real error) {
  Reserve(pixels, limit, error);
  const auto sums = sums_.output(), squares = squares_.output();
  ForEachField(sums, sample,
               [&](Real* sum, const Real* channel) { std::copy_n(channel, pixels.count, sum); });
  ForEachField(squares, sample, [&](Real* square, const Real* channel) {
    for (std::uint32_t i = 0; i < pixels.count; ++i) square[i] = channel[i] * channel[i];
  });
  Gather();
}

template <typename Real>
void ConvergingMeans<Real>::Resume(const PixelList<Real>& pixels, SampleSums& from,
                                   std::uint32_t limit, Real error) {
  Reserve(pixels, limit, error);
  const auto sums = sums_.output(), squares = squares_.output();
  for (std::uint32_t i = 0; i < pixels.count; ++i) {
    const scalar::PixelSums<Real>& pixel =
        from.at<Real>(static_cast<int>(pixels.x[i]), static_cast<int>(pixels.y[i]));
    sums.r[i] = pixel.sum.x, sums.g[i] = pixel.sum.y, sums.b[i] = pixel.sum.z;
    squares.r[i] = pixel.squares.x, squares.g[i] = pixel.squares.y, squares.b[i] = pixel.squares.z;
    samples_[i] = pixel.samples;
    is_done_[i] = pixel.samples >= limit || pixel.IsConverged(error);
  }
  Gather();
}

template <typename Real>
void ConvergingMeans<Real>::Gather() {
  index_ = limit_;
  for (std::uint32_t i = 0; i < all_->count; ++i) {
    if (!is_done_[i]) index_ = std::min(index_, samples_[i]);
  }
  wanting_.count = 0;
  for (std::uint32_t i = 0; i < all_->count; ++i) {
    if (is_done_[i] || samples_[i] > index_) continue;
    wanting_.x[wanting_.count] = all_->x[i];
    wanting_.y[wanting_.count] = all_->y[i];
    positions_[wanting_.count++] = i;
  }
}

template <typename Real>
void ConvergingMeans<Real>::Add(const ColourView<Real>& sample) {
  const auto sums = sums_.output(), squares = squares_.output();
  ForEachField(sums, sample, [&](Real* sum, const Real* channel) {
    for (std::uint32_t i = 0; i < wanting_.count; ++i) sum[positions_[i]] += channel[i];
  });
  ForEachField(squares, sample, [&](Real* square, const Real* channel) {
    for (std::uint32_t i = 0; i < wanting_.count; ++i) {
      square[positions_[i]] += channel[i] * channel[i];
    }
  });
  ++index_;
  if (index_ < limit_ && !scalar::IsJudgedAt(index_)) return;
  for (std::uint32_t i = 0; i < wanting_.count; ++i) {
    const std::uint32_t at = positions_[i];
    samples_[at] = index_;
    is_done_[at] =
        index_ == limit_ ||
        scalar::IsConverged<Real>({sums.r[at], sums.g[at], sums.b[at]},
                                  {squares.r[at], squares.g[at], squares.b[at]}, index_, error_);
  }
  Gather();
}

template <typename Real>
void ConvergingMeans<Real>::Save(SampleSums& to) const {
  const auto sums = sums_.view(), squares = squares_.view();
  for (std::uint32_t i = 0; i < all_->count; ++i) {
    to.at<Real>(static_cast<int>(all_->x[i]), static_cast<int>(all_->y[i])) = {
        {sums.r[i], sums.g[i], sums.b[i]}, {squares.r[i], squares.g[i], squares.b[i]}, samples_[i]};
  }
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
