// The point that a ray hit: where, facing which way, and how far off a new ray has to start.
//
// Positions are reprojected onto the primitive, so that their error does not grow with the distance
// the ray came; what is left is bounded, and a secondary ray starts that bound away (Pharr, Jakob,
// Humphreys, "Physically Based Rendering", 4th ed., 6.8). No epsilon is tuned and no scale of the
// world assumed.
#ifndef SHEAF_SCALAR_SURFACE_H_
#define SHEAF_SCALAR_SURFACE_H_

#include "simd/query.h"
#include "src/core/vec3.h"

namespace sheaf::scalar {

// What SurfaceFields of simd/streams.h holds for one hit.
template <typename Real>
struct Surface {
  Vec3<Real> position;
  Vec3<Real> normal;     // for shading: unit, on the face's side
  Vec3<Real> face;       // the face's own: unit, facing the ray
  Vec3<Real> direction;  // of the ray, unit
  // What shadow rays ask about: the position, or the point of the curved surface that smooth
  // normals stand for.
  Vec3<Real> shadow_end;
  Real bend = 0;  // how far below the face a light may lie, as a cosine; 0 where it is flat
  Real u = 0, v = 0;
  Real u2 = 0, v2 = 0;          // of the second set of coordinates
  Vec3<Real> tint = {1, 1, 1};  // of the vertices' colours
  Real alpha = 1;               // of the vertices
  Real offset;
  std::uint32_t source;
  std::uint32_t instance = kNoInstance;   // that the source belongs to
  Real width = 0;                         // of the ray's cone there
  Real footprint_u = 0, footprint_v = 0;  // how much of u and v the cone covers
  Real footprint_u2 = 0, footprint_v2 = 0;
  // Of a rough surface: the normal that rays are mirrored and bent at, and what their throughputs
  // are multiplied with besides.
  Vec3<Real> facet = {0, 0, 0};
  Real gloss = 1;
  Real scatter = 0;  // how likely a diffuse ray is followed, of paths

  bool inside() const { return (source & kInsideBit) != 0; }
  std::uint32_t primitive() const { return source & ~kInsideBit; }
};

}  // namespace sheaf::scalar

#endif  // SHEAF_SCALAR_SURFACE_H_
