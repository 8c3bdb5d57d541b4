// The means of samples, of as many for each pixel as its error asks for.
#ifndef SHEAF_RENDER_SAMPLE_UNTIL_H_
#define SHEAF_RENDER_SAMPLE_UNTIL_H_

#include <cstdint>
#include <vector>

#include "simd/streams.h"
#include "src/render/pixel_order.h"
#include "src/stream/stream.h"

namespace sheaf {

// src/scalar/converge.h, for the pixels of a tile.
template <typename Real>
class ConvergingMeans {
 public:
  // The first sample of all pixels.
  void Start(const PixelList<Real>& pixels, const ColourView<Real>& sample);

  // Those that want another one, in their order.
  const PixelList<Real>& pixels() const { return wanting_; }
  // That sample of theirs, after which those are left that still want more.
  void Add(const ColourView<Real>& sample, Real error);

  // Makes sums means.
  void Divide();
  ColourView<Real> view() const { return sums_.view(); }
  std::size_t bytes() const {
    return sums_.bytes() + squares_.bytes() + wanting_.bytes() +
           (positions_.capacity() + samples_.capacity()) * sizeof(std::uint32_t);
  }

 private:
  ColourStream<Real> sums_, squares_;   // by position
  std::vector<std::uint32_t> samples_;  // likewise
  PixelList<Real> wanting_;
  std::vector<std::uint32_t> positions_;  // of those
};

}  // namespace sheaf

#endif  // SHEAF_RENDER_SAMPLE_UNTIL_H_
