// The owning arrays behind the views of simd/streams.h.
#ifndef SHEAF_STREAM_STREAM_H_
#define SHEAF_STREAM_STREAM_H_

#include "simd/streams.h"
#include "src/core/aligned_array.h"

namespace sheaf {

// `Fields` is one of the field lists of streams.h: Stream<float, RayFields> owns what
// RayView<float> shows.
template <typename Real, template <typename, template <typename> class> class Fields>
class Stream {
 public:
  // Makes room for `n` elements with the padding of streams.h; what the stream held is lost.
  void Allocate(std::uint32_t n) {
    ForEachField(arrays_, [&](auto& field) { field.Allocate(StreamCapacity(n)); });
  }

  Fields<Real, ConstField> view() const {
    Fields<Real, ConstField> view;
    ForEachField(view, arrays_, [](auto& to, auto& from) { to = from.data(); });
    return view;
  }
  // The elements from `first` on; `first` + count stays within the n of Allocate.
  Fields<Real, MutableField> output(std::uint32_t first = 0) {
    Fields<Real, MutableField> view;
    ForEachField(view, arrays_, [&](auto& to, auto& from) { to = from.data() + first; });
    return view;
  }

 private:
  Fields<Real, AlignedArray> arrays_;
};

template <typename Real>
using RayStream = Stream<Real, RayFields>;
template <typename Real>
using PathStream = Stream<Real, PathFields>;
template <typename Real>
using HitStream = Stream<Real, HitFields>;
template <typename Real>
using SurfaceStream = Stream<Real, SurfaceFields>;
template <typename Real>
using IncidenceStream = Stream<Real, IncidenceFields>;
template <typename Real>
using ColourStream = Stream<Real, ColourFields>;

}  // namespace sheaf

#endif  // SHEAF_STREAM_STREAM_H_
