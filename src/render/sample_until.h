// The means of samples, of as many for each pixel as its error asks for.
#ifndef SHEAF_RENDER_SAMPLE_UNTIL_H_
#define SHEAF_RENDER_SAMPLE_UNTIL_H_

#include <cstdint>
#include <vector>

#include "simd/streams.h"
#include "src/render/pixel_order.h"
#include "src/render/sample_round.h"
#include "src/stream/stream.h"

namespace sheaf {

// src/scalar/converge.h, for the pixels of a tile.
template <typename Real>
class ConvergingMeans {
 public:
  // The first sample of all pixels. They get `limit` at most, and no more than it takes until their
  // error is at most `error`. The list outlives them.
  void Start(const PixelList<Real>& pixels, const ColourView<Real>& sample, std::uint32_t limit,
             Real error);
  // The same for pixels that go on with the samples that they have.
  void Resume(const PixelList<Real>& pixels, SampleSums& from, std::uint32_t limit, Real error);

  // Those that want the sample of number index() now, in their order; none: all have enough.
  const PixelList<Real>& pixels() const { return wanting_; }
  std::uint32_t index() const { return index_; }
  // That sample of theirs.
  void Add(const ColourView<Real>& sample);

  // Leaves the pixels' sums and numbers of samples, all that Resume needs.
  void Save(SampleSums& to) const;

  // Makes sums means.
  void Divide();
  ColourView<Real> view() const { return sums_.view(); }
  std::size_t bytes() const {
    return sums_.bytes() + squares_.bytes() + wanting_.bytes() +
           (positions_.capacity() + samples_.capacity()) * sizeof(std::uint32_t) +
           is_done_.capacity();
  }

 private:
  void Reserve(const PixelList<Real>& pixels, std::uint32_t limit, Real error);
  // Finds the pixels that want the next sample, where any does of those that have the fewest.
  void Gather();

  const PixelList<Real>* all_ = nullptr;
  std::uint32_t limit_ = 0, index_ = 0;
  Real error_ = 0;
  ColourStream<Real> sums_, squares_;   // by position
  std::vector<std::uint32_t> samples_;  // likewise, as they were judged last
  std::vector<std::uint8_t> is_done_;   // likewise
  PixelList<Real> wanting_;
  std::vector<std::uint32_t> positions_;  // of those
};

}  // namespace sheaf

#endif  // SHEAF_RENDER_SAMPLE_UNTIL_H_
