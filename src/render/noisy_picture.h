// The planes that the denoiser works on.
#ifndef SHEAF_RENDER_NOISY_PICTURE_H_
#define SHEAF_RENDER_NOISY_PICTURE_H_

#include <cstddef>

#include "sheaf/film.h"
#include "simd/noisy_planes.h"
#include "src/core/aligned_array.h"

namespace sheaf {

// A plane of floats with kFilterMargin columns and kFilterReach rows around it, at least.
class NoisyPlane {
 public:
  void Allocate(int width, int height) {
    width_ = width;
    height_ = height;
    stride_ = width + 2 * kFilterMargin;
    floats_.Allocate(static_cast<std::size_t>(stride_) *
                     static_cast<std::size_t>(height + 2 * kFilterReach));
  }
  std::ptrdiff_t stride() const { return stride_; }
  float* at(int x, int y) { return floats_.data() + index(x, y); }
  const float* at(int x, int y) const { return floats_.data() + index(x, y); }

  // The margin becomes what the nearest pixel of the picture is; or `value`.
  void RepeatEdges();
  void FillMargin(float value);

 private:
  std::ptrdiff_t index(int x, int y) const {
    return (std::ptrdiff_t{y} + kFilterReach) * stride_ + x + kFilterMargin;
  }

  AlignedArray<float> floats_;
  std::ptrdiff_t stride_ = 0;
  int width_ = 0, height_ = 0;
};

// A film apart into the light that falls on surfaces, which is what is noisy, and what guides the
// filter. A pixel that is not finite is no one's neighbour, and nor is the margin: its first guide
// is far from every other.
struct NoisyPicture {
  int width, height;
  NoisyPlane colour[3];  // over the albedo
  NoisyPlane variance, mean_variance;
  NoisyPlane guide[kGuideCount];
  NoisyPlane nearness, nearness_x, nearness_y, nearness_precision;

  NoisyView<float> ViewAt(int x, int y) const;
  bool is_usable(int x, int y) const { return *guide[0].at(x, y) != kApart; }

  // The first guide of what is no neighbour. Beyond it a number is as good as infinite: squares of
  // differences stay finite.
  static constexpr float kApart = 1e15f;
};

// What a channel of the light is multiplied with to be the colour. Dark surfaces count as brighter,
// so that noise of theirs is not taken for light.
inline constexpr float kLeastAlbedo = 0.05f;
inline float NoisyAlbedo(const Film& film, int x, int y, int channel) {
  if (!film.has(Layer::kAlbedo)) return 1;
  const float albedo = film.at(Layer::kAlbedo, x, y)[channel];
  return albedo > kLeastAlbedo ? albedo : kLeastAlbedo;
}

// All planes but the variances, on at most `threads` threads.
NoisyPicture SplitFilm(const Film& film, int threads);

}  // namespace sheaf

#endif  // SHEAF_RENDER_NOISY_PICTURE_H_
