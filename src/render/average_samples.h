// The mean of a pixel's samples, added up in the order of the pattern, then divided once.
#ifndef SHEAF_RENDER_AVERAGE_SAMPLES_H_
#define SHEAF_RENDER_AVERAGE_SAMPLES_H_

#include <cstdint>
#include <span>

#include "simd/streams.h"
#include "src/stream/stream.h"

namespace sheaf {

template <typename Real>
class SampleMeans {
 public:
  // The first sample of `count` pixels.
  void Start(const ColourView<Real>& sample, std::uint32_t count);

  // Another sample of every pixel, and the division by `samples` of them.
  void Add(const ColourView<Real>& sample);
  void Divide(int samples);

  // The same for the pixels at `positions` alone.
  void AddAt(std::span<const std::uint32_t> positions, const ColourView<Real>& sample);
  void DivideAt(std::span<const std::uint32_t> positions, int samples);

  ColourView<Real> view() const { return sums_.view(); }
  std::size_t bytes() const { return sums_.bytes(); }

 private:
  ColourStream<Real> sums_;
  std::uint32_t count_ = 0;
};

}  // namespace sheaf

#endif  // SHEAF_RENDER_AVERAGE_SAMPLES_H_
