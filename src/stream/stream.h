// The owning arrays behind the views of simd/streams.h.
#ifndef SHEAF_STREAM_STREAM_H_
#define SHEAF_STREAM_STREAM_H_

#include <cstdint>
#include <tuple>
#include <type_traits>

#include "simd/streams.h"
#include "src/core/aligned_array.h"

namespace sheaf {

// The bit of a field by its place in the list of its stream, for Stream::Reserve.
template <typename Fields, typename Member>
constexpr std::uint64_t FieldBit(Member Fields::*field) {
  std::uint64_t bit = 1, found = 0;
  const auto compare = [&](auto member) {
    if constexpr (std::is_same_v<decltype(member), Member Fields::*>) {
      if (member == field) found = bit;
    }
    bit <<= 1;
  };
  std::apply([&](auto... member) { (compare(member), ...); }, Fields::kFields);
  return found;
}

// `Fields` is one of the field lists of streams.h: Stream<float, RayFields> owns what
// RayView<float> shows.
template <typename Real, template <typename, template <typename> class> class Fields>
class Stream {
 public:
  // Makes room for `n` elements with the padding of streams.h; what the stream held is lost.
  void Allocate(std::uint32_t n) {
    ForEachField(arrays_, [&](auto& field) { field.Allocate(StreamCapacity(n)); });
  }
  // The same, only where there is less room, and for those fields alone whose bits are set. What
  // was never made room for is a null pointer.
  void Reserve(std::uint32_t n, std::uint64_t fields = ~std::uint64_t{0}) {
    ForEachField(arrays_, [&, bit = std::uint64_t{1}](auto& field) mutable {
      if (fields & bit) field.Reserve(StreamCapacity(n));
      bit <<= 1;
    });
  }

  std::size_t bytes() const {
    std::size_t sum = 0;
    ForEachField(arrays_, [&](const auto& field) { sum += field.bytes(); });
    return sum;
  }

  Fields<Real, ConstField> view() const {
    Fields<Real, ConstField> view;
    ForEachField(view, arrays_, [](auto& to, auto& from) { to = from.data(); });
    return view;
  }
  // Both: the elements from `first` on; `first` + count stays within the n of Allocate or Reserve.
  Fields<Real, ConstField> view(std::uint32_t first) const {
    Fields<Real, ConstField> view;
    ForEachField(view, arrays_,
                 [&](auto& to, auto& from) { to = from.data() ? from.data() + first : nullptr; });
    return view;
  }
  Fields<Real, MutableField> output(std::uint32_t first = 0) {
    Fields<Real, MutableField> view;
    ForEachField(view, arrays_,
                 [&](auto& to, auto& from) { to = from.data() ? from.data() + first : nullptr; });
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
using SampleStream = Stream<Real, SampleFields>;
template <typename Real>
using TexelStream = Stream<Real, TexelFields>;
template <typename Real>
using ColourStream = Stream<Real, ColourFields>;

}  // namespace sheaf

#endif  // SHEAF_STREAM_STREAM_H_
