// How a light meets surfaces: what FaceLight finds and ShadeLight goes by.
#ifndef SHEAF_SIMD_INCIDENCE_H_
#define SHEAF_SIMD_INCIDENCE_H_

#include <tuple>

#include "simd/streams.h"

namespace sheaf {

// A stream as those of streams.h, one element a surface.
template <typename Real, template <typename> class Field>
struct IncidenceFields {
  Field<Real> x, y, z;  // unit vector to the light
  Field<Real> cosine;   // of it and the normal; 0 where the light lies on the point
  Field<Real> falloff;  // what the light is divided by

  static constexpr auto kFields =
      std::make_tuple(&IncidenceFields::x, &IncidenceFields::y, &IncidenceFields::z,
                      &IncidenceFields::cosine, &IncidenceFields::falloff);
};

template <typename Real>
using IncidenceView = IncidenceFields<Real, ConstField>;
template <typename Real>
using IncidenceOutput = IncidenceFields<Real, MutableField>;

}  // namespace sheaf

#endif  // SHEAF_SIMD_INCIDENCE_H_
