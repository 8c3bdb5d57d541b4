// The random numbers of the sample in work, for rays that are worked on together.
#ifndef SHEAF_RENDER_SAMPLE_SOURCE_H_
#define SHEAF_RENDER_SAMPLE_SOURCE_H_

#include <cstdint>

#include "simd/kernels.h"
#include "simd/streams.h"
#include "src/render/pixel_order.h"
#include "src/stream/stream.h"

namespace sheaf {

// Of a frame that has nothing to draw from, nothing of this is called. `kernels` outlives it.
template <typename Real>
class SampleSource {
 public:
  explicit SampleSource(const Kernels<Real>& kernels) : kernels_(kernels) {}

  // From here on points are those of the sample `index` of these pixels.
  void StartSample(const PixelList<Real>& pixels, std::size_t index);
  // A seed a pixel.
  const std::uint32_t* pixel_seeds() const { return pixel_seeds_.data(); }
  // A point a pixel, until the next call of a function that draws.
  SampleView<Real> DrawForPixels(std::uint32_t dimension);

  // The surfaces that DrawForSurfaces is about: those where rays of these paths arrived.
  void StartSurfaces(const PathView<Real>& paths, const SurfaceView<Real>& surfaces,
                     std::uint32_t count);
  // A point a surface, likewise: the `draw`th of `draws` that make one sample.
  SampleView<Real> DrawForSurfaces(std::uint32_t dimension, std::uint32_t draw = 0,
                                   std::uint32_t draws = 1);

  std::size_t bytes() const {
    return pixel_seeds_.bytes() + surface_seeds_.bytes() + points_.bytes();
  }

 private:
  const Kernels<Real>& kernels_;
  std::uint32_t index_ = 0, pixels_ = 0, surfaces_ = 0;
  AlignedArray<std::uint32_t> pixel_seeds_, surface_seeds_;
  SampleStream<Real> points_;
};

}  // namespace sheaf

#endif  // SHEAF_RENDER_SAMPLE_SOURCE_H_
