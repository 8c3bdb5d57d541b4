// The streams that kernels read and write, as plain views.
//
// Layout: structure of arrays, one pointer a field. Owning arrays are aligned to kAlignment; a view
//   may start anywhere in them, so kernels assume no alignment.
// Padding: a stream of `n` elements owns StreamCapacity(n) of each field. Kernels load and store
//   whole vectors: lanes past the count may hold anything on entry and anything on return.
// Aliasing: the fields of a view never overlap, and no output overlaps an input.
// NaN: allowed everywhere in rays; such a ray misses (src/scalar/ray.h).
// Colours are never -0: a sum of them is then the same whether it starts at 0 or at the first.
// `Real` is float or double; identifiers are 32 bit in both.
#ifndef SHEAF_SIMD_STREAMS_H_
#define SHEAF_SIMD_STREAMS_H_

#include <cstddef>
#include <cstdint>
#include <tuple>
#include <utility>

namespace sheaf {

inline constexpr std::size_t kAlignment = 64;
// Kernels use at most this many lanes, whatever the target offers.
inline constexpr std::uint32_t kMaxLanes = 16;

constexpr std::uint32_t PaddedCount(std::uint32_t n) {
  return (n + kMaxLanes - 1) / kMaxLanes * kMaxLanes;
}
// One vector more than padded, because compaction stores a whole vector at any offset below n.
constexpr std::uint32_t StreamCapacity(std::uint32_t n) { return PaddedCount(n) + kMaxLanes; }

// A stream is declared once, over what a field is: an owning array, a pointer or a const pointer.

template <typename T>
using MutableField = T*;
template <typename T>
using ConstField = const T*;

// What TraceClosest and TraceOccluded read of a ray.
template <typename Real, template <typename> class Field>
struct RayFields {
  Field<Real> origin_x, origin_y, origin_z;
  Field<Real> direction_x, direction_y, direction_z;  // any length
  Field<std::uint32_t> source;  // kNoPrimitive: none; a null pointer: none for all

  static constexpr auto kFields = std::make_tuple(
      &RayFields::origin_x, &RayFields::origin_y, &RayFields::origin_z, &RayFields::direction_x,
      &RayFields::direction_y, &RayFields::direction_z, &RayFields::source);
};

// What the schedule keeps of a ray besides: where its light goes, and how much of it.
template <typename Real, template <typename> class Field>
struct PathFields {
  Field<std::uint32_t> pixel;                            // index into the tile
  Field<std::uint32_t> parent;                           // position in the stream that spawned it
  Field<Real> throughput_r, throughput_g, throughput_b;  // throughput since the eye
  Field<Real> width;          // of the ray's cone where it starts; with kNeedsWidth
  Field<std::uint32_t> seed;  // of its random numbers; with kNeedsSeed
  Field<Real> density;        // with which a diffuse ray was drawn, by solid angle; null for others

  static constexpr auto kFields = std::make_tuple(
      &PathFields::pixel, &PathFields::parent, &PathFields::throughput_r, &PathFields::throughput_g,
      &PathFields::throughput_b, &PathFields::width, &PathFields::seed, &PathFields::density);
};

// What TraceClosest writes: t, the primitive's id (kNoPrimitive: a miss, then t is t_max and u, v
// are 0) and two parameters of the hit, which mean something else for each kind:
//   triangle: u and v, the barycentric weights of the second and third vertex
//   sphere: `leaves`, 0 where the ray enters and 1 where it leaves, and `t_rest`, what rounding
//   took
//     from t, so that t + t_rest is the root to twice the bits of float (0 in double and in fast
//     arithmetic)
// Who writes or reads hits of one kind calls them by these names.
template <typename Real, template <typename> class Field>
struct HitFields {
  Field<Real> t, u, v;
  Field<std::uint32_t> primitive;

  static constexpr auto kFields =
      std::make_tuple(&HitFields::t, &HitFields::u, &HitFields::v, &HitFields::primitive);
};

// A point to be shaded.
template <typename Real, template <typename> class Field>
struct SurfaceFields {
  Field<Real> position_x, position_y, position_z;
  Field<Real> normal_x, normal_y, normal_z;  // shading normal: unit, on the face's side
  Field<Real> face_x, face_y, face_z;  // the face's own normal: unit, facing the ray; these fields
                                       // may be the normal's where the two are one
  Field<Real> direction_x, direction_y, direction_z;  // of the ray, unit
  // What shadow rays ask about; these fields may be the position's where the two are one. Left
  // alone where no light asks.
  Field<Real> shadow_x, shadow_y, shadow_z;
  Field<Real> bend;  // how far below the face a light may lie, as a cosine; null where all are flat
  Field<Real> u, v;  // surface coordinates; the kernel leaves 0 on spheres
  Field<Real> tint_r, tint_g, tint_b;  // what the base colour is multiplied with, point by point
  Field<Real> offset;           // along the normal; takes a secondary ray past every rounding error
  Field<std::uint32_t> source;  // primitive id, with kInsideBit where the ray hit the back side
  Field<std::uint32_t> ray;     // position in the ray stream
  // With kNeedsTerms, what takes the place of the material's members of these names.
  Field<Real> ambient_r, ambient_g, ambient_b;
  Field<Real> emission_r, emission_g, emission_b;
  Field<Real> kd, ks, shininess;
  Field<Real> reflect_r, reflect_g, reflect_b;
  Field<Real> transmit_r, transmit_g, transmit_b;
  Field<Real> slope_width;
  Field<Real> width;                     // of the ray's cone; with kNeedsWidth
  Field<Real> footprint_u, footprint_v;  // how much of u and v it covers; with kNeedsFootprint
  // With kNeedsGloss: the normal that rays are mirrored and bent at, and what their throughputs are
  // multiplied with besides.
  Field<Real> facet_x, facet_y, facet_z, gloss;
  // With kNeedsChoice: what the throughputs of its rays are multiplied with, 0 for all but one.
  Field<Real> choice_reflect, choice_refract, choice_diffuse;
  Field<Real> scatter;  // how likely the diffuse one was to be followed
  Field<Real> alpha;    // of the vertices; with kNeedsVertexAlpha
  // The same of the second set of coordinates, with kNeedsSecondSet; these fields may be the first
  // set's where the two are one.
  Field<Real> u2, v2, footprint_u2, footprint_v2;

  // What few scenes have comes last, so that arrays that are used together lie together.
  static constexpr auto kFields = std::make_tuple(
      &SurfaceFields::position_x, &SurfaceFields::position_y, &SurfaceFields::position_z,
      &SurfaceFields::normal_x, &SurfaceFields::normal_y, &SurfaceFields::normal_z,
      &SurfaceFields::direction_x, &SurfaceFields::direction_y, &SurfaceFields::direction_z,
      &SurfaceFields::u, &SurfaceFields::v, &SurfaceFields::offset, &SurfaceFields::source,
      &SurfaceFields::ray, &SurfaceFields::face_x, &SurfaceFields::face_y, &SurfaceFields::face_z,
      &SurfaceFields::tint_r, &SurfaceFields::tint_g, &SurfaceFields::tint_b,
      &SurfaceFields::ambient_r, &SurfaceFields::ambient_g, &SurfaceFields::ambient_b,
      &SurfaceFields::emission_r, &SurfaceFields::emission_g, &SurfaceFields::emission_b,
      &SurfaceFields::kd, &SurfaceFields::ks, &SurfaceFields::shininess, &SurfaceFields::reflect_r,
      &SurfaceFields::reflect_g, &SurfaceFields::reflect_b, &SurfaceFields::transmit_r,
      &SurfaceFields::transmit_g, &SurfaceFields::transmit_b, &SurfaceFields::slope_width,
      &SurfaceFields::shadow_x, &SurfaceFields::shadow_y, &SurfaceFields::shadow_z,
      &SurfaceFields::bend, &SurfaceFields::width, &SurfaceFields::footprint_u,
      &SurfaceFields::footprint_v, &SurfaceFields::facet_x, &SurfaceFields::facet_y,
      &SurfaceFields::facet_z, &SurfaceFields::gloss, &SurfaceFields::choice_reflect,
      &SurfaceFields::choice_refract, &SurfaceFields::choice_diffuse, &SurfaceFields::scatter,
      &SurfaceFields::alpha, &SurfaceFields::u2, &SurfaceFields::v2, &SurfaceFields::footprint_u2,
      &SurfaceFields::footprint_v2);
};

// What textures say of surfaces, one an element. Metallic and roughness before their factors.
template <typename Real, template <typename> class Field>
struct TexelFields {
  Field<Real> r, g, b;  // of the base colour, or of a normal map
  Field<Real> alpha, metallic, roughness, occlusion, transmission;
  Field<Real> emission_r, emission_g, emission_b;

  static constexpr auto kFields =
      std::make_tuple(&TexelFields::r, &TexelFields::g, &TexelFields::b, &TexelFields::alpha,
                      &TexelFields::metallic, &TexelFields::roughness, &TexelFields::occlusion,
                      &TexelFields::transmission, &TexelFields::emission_r,
                      &TexelFields::emission_g, &TexelFields::emission_b);
};

// Linear RGB, one an element.
template <typename Real, template <typename> class Field>
struct ColourFields {
  Field<Real> r, g, b;

  static constexpr auto kFields =
      std::make_tuple(&ColourFields::r, &ColourFields::g, &ColourFields::b);
};

// How a light meets surfaces, one an element: what FaceLight finds and ShadeLight goes by.
template <typename Real, template <typename> class Field>
struct IncidenceFields {
  Field<Real> x, y, z;              // unit vector to the light
  Field<Real> cosine;               // of it and the normal; 0 where the light lies on the point
  Field<Real> falloff;              // what the light is divided by
  Field<Real> end_x, end_y, end_z;  // of lights with a size: the point drawn, or a sun's direction
  Field<Real> r, g, b;              // of emitters: the colour of that light, weighed

  static constexpr auto kFields = std::make_tuple(
      &IncidenceFields::x, &IncidenceFields::y, &IncidenceFields::z, &IncidenceFields::cosine,
      &IncidenceFields::falloff, &IncidenceFields::end_x, &IncidenceFields::end_y,
      &IncidenceFields::end_z, &IncidenceFields::r, &IncidenceFields::g, &IncidenceFields::b);
};

// Random points of the unit square, one an element: src/scalar/draw_sample.h.
template <typename Real, template <typename> class Field>
struct SampleFields {
  Field<Real> u, v;  // in [0, 1)

  static constexpr auto kFields = std::make_tuple(&SampleFields::u, &SampleFields::v);
};

template <typename Real>
using RayView = RayFields<Real, ConstField>;
template <typename Real>
using RayOutput = RayFields<Real, MutableField>;
template <typename Real>
using PathView = PathFields<Real, ConstField>;
template <typename Real>
using PathOutput = PathFields<Real, MutableField>;
template <typename Real>
using HitView = HitFields<Real, ConstField>;
template <typename Real>
using HitOutput = HitFields<Real, MutableField>;
template <typename Real>
using SurfaceView = SurfaceFields<Real, ConstField>;
template <typename Real>
using SurfaceOutput = SurfaceFields<Real, MutableField>;
template <typename Real>
using ColourView = ColourFields<Real, ConstField>;
template <typename Real>
using ColourOutput = ColourFields<Real, MutableField>;
template <typename Real>
using TexelView = TexelFields<Real, ConstField>;
template <typename Real>
using TexelOutput = TexelFields<Real, MutableField>;
template <typename Real>
using SampleView = SampleFields<Real, ConstField>;
template <typename Real>
using SampleOutput = SampleFields<Real, MutableField>;
template <typename Real>
using IncidenceView = IncidenceFields<Real, ConstField>;
template <typename Real>
using IncidenceOutput = IncidenceFields<Real, MutableField>;

// Calls f(field of a, field of b) for the fields of two instances of one stream, in order.
template <typename A, typename B, typename F>
constexpr void ForEachField(A& a, B& b, F f) {
  constexpr std::size_t kCount = std::tuple_size_v<decltype(A::kFields)>;
  [&]<std::size_t... kIndex>(std::index_sequence<kIndex...>) {
    (f(a.*std::get<kIndex>(A::kFields), b.*std::get<kIndex>(B::kFields)), ...);
  }
  (std::make_index_sequence<kCount>());
}
template <typename A, typename F>
constexpr void ForEachField(A& a, F f) {
  std::apply([&](auto... member) { (f(a.*member), ...); }, A::kFields);
}

// The cones of a stream's rays: src/scalar/footprint.h.
template <typename Real>
struct ConeView {
  const Real* width;  // where each starts; null: all_width for all
  Real all_width;
  Real spread;  // how much wider a cone is a unit of length on
};

// A list of hits that are treated alike: positions in the ray stream, and what each ray hit there.
struct HitBatch {
  const std::uint32_t* ray;
  const std::uint32_t* index;      // into the arrays of its kind
  const std::uint32_t* primitive;  // id
  std::uint32_t count;
};

// The same surfaces where no normal but the face's own is used, so that nothing is curved.
template <typename Real>
SurfaceView<Real> WithoutFaces(SurfaceView<Real> surfaces) {
  surfaces.face_x = surfaces.normal_x;
  surfaces.face_y = surfaces.normal_y;
  surfaces.face_z = surfaces.normal_z;
  surfaces.shadow_x = surfaces.position_x;
  surfaces.shadow_y = surfaces.position_y;
  surfaces.shadow_z = surfaces.position_z;
  surfaces.bend = nullptr;
  return surfaces;
}

// The same surfaces where there is one set of coordinates, which serves for both.
template <typename Real>
SurfaceView<Real> WithOneSet(SurfaceView<Real> surfaces) {
  surfaces.u2 = surfaces.u;
  surfaces.v2 = surfaces.v;
  surfaces.footprint_u2 = surfaces.footprint_u;
  surfaces.footprint_v2 = surfaces.footprint_v;
  return surfaces;
}

}  // namespace sheaf

#endif  // SHEAF_SIMD_STREAMS_H_
