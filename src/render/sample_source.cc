#include "src/render/sample_source.h"

#include "src/scalar/draw_sample.h"

namespace sheaf {

template <typename Real>
void SampleSource<Real>::StartSample(const PixelList<Real>& pixels, std::size_t index) {
  index_ = static_cast<std::uint32_t>(index);
  pixels_ = pixels.count;
  pixel_seeds_.Reserve(StreamCapacity(pixels_));
  for (std::uint32_t i = 0; i < pixels_; ++i) {
    pixel_seeds_[i] = scalar::PixelSeed(static_cast<std::uint32_t>(pixels.x[i]),
                                        static_cast<std::uint32_t>(pixels.y[i]));
  }
}

template <typename Real>
SampleView<Real> SampleSource<Real>::DrawForPixels(std::uint32_t dimension) {
  points_.Reserve(pixels_);
  kernels_.draw_samples(pixel_seeds_.data(), index_, dimension, pixels_, points_.output());
  return points_.view();
}

template <typename Real>
void SampleSource<Real>::StartSurfaces(const PathView<Real>& paths,
                                       const SurfaceView<Real>& surfaces, std::uint32_t count) {
  surfaces_ = count;
  surface_seeds_.Reserve(StreamCapacity(count));
  for (std::uint32_t i = 0; i < count; ++i) surface_seeds_[i] = paths.seed[surfaces.ray[i]];
}

template <typename Real>
SampleView<Real> SampleSource<Real>::DrawForSurfaces(std::uint32_t dimension, std::uint32_t draw,
                                                     std::uint32_t draws) {
  points_.Reserve(surfaces_);
  kernels_.draw_samples(surface_seeds_.data(), index_ * draws + draw, dimension, surfaces_,
                        points_.output());
  return points_.view();
}

template class SampleSource<float>;
template class SampleSource<double>;

}  // namespace sheaf
