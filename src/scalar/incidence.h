// How light arrives at a surface: from a point, or from a point drawn on a light that has a size.
#ifndef SHEAF_SCALAR_INCIDENCE_H_
#define SHEAF_SCALAR_INCIDENCE_H_

#include <cmath>
#include <limits>

#include "simd/roundoffs.h"
#include "simd/shading.h"
#include "src/scalar/draw_sample.h"
#include "src/scalar/emitters.h"
#include "src/scalar/frame.h"
#include "src/scalar/surface.h"
#include "src/scalar/warp.h"

namespace sheaf::scalar {

// A light as the surface sees it.
template <typename Real>
struct Incidence {
  Vec3<Real> to_light;  // from the surface to the light's position; a directional light's vector
  Vec3<Real> l;         // unit
  Real n_dot_l;         // 0 where the light lies on the point or is too far: it gives nothing
  Real attenuation;     // 1 / (kc + kl r + kq r^2), of a spot light times its cone's share
  bool reaches;         // whether the surface faces the light, within the cone of a spot light
  Vec3<Real> end;       // of a light with a size: the point of it that was drawn
  Vec3<Real> colour;    // of emitters: of the light that was drawn, weighed
};

// A spot light's share toward a surface that sees it along `l`: KHR_lights_punctual, "Inner and
// Outer Cone Angles".
template <typename Real>
Real ConeShare(const LightData<Real>& light, Vec3<Real> l) {
  const Real share = -Dot(l, FromArray(light.axis)) * light.cone_scale + light.cone_offset;
  const Real clamped = share > 0 ? (share < 1 ? share : Real(1)) : Real(0);
  return clamped * clamped;
}

// What the light is divided by, and whether there is any.
template <typename Real>
struct Falling {
  Real falloff = 1;
  bool is_light = true;
  Real density = 0;  // of emitters: with which the point was drawn, by area
};

// The length of l is 1 only where the square is a normal number; an infinite one makes l 0.
template <typename Real>
bool IsNormalSquare(Real squared) {
  return squared >= std::numeric_limits<Real>::min();
}

// A light without a size; leaves to_light and l.
template <typename Real>
Falling<Real> LookAtPoint(const LightData<Real>& light, const Surface<Real>& surface,
                          Incidence<Real>& incidence) {
  Real squared = 0, distance = 0;
  incidence.to_light = FromArray(light.vector);
  incidence.l = incidence.to_light;
  if (light.kind != LightKind::kDirectional) {
    incidence.to_light = incidence.to_light - surface.position;
    squared = Dot(incidence.to_light, incidence.to_light);
    distance = std::sqrt(squared);
    incidence.l = incidence.to_light / distance;
  }
  return {(light.falloff[0] + light.falloff[1] * distance) + light.falloff[2] * squared,
          light.kind == LightKind::kDirectional || IsNormalSquare(squared)};
}

// A rectangle or a disk, drawn from evenly by area: as a point light of its intensity along the
// axis, times the cosine there, at the point's distance.
template <typename Real>
Falling<Real> LookAtFlat(const LightData<Real>& light, const Surface<Real>& surface,
                         SamplePoint<Real> point, Incidence<Real>& incidence) {
  Real a = point.u - Real(0.5), b = point.v - Real(0.5);
  if (light.shape == LightShape::kDisk) {
    const PlanePoint<Real> on_disk = DiskPoint(point);
    a = on_disk.x;
    b = on_disk.y;
  }
  incidence.end =
      FromArray(light.vector) + (FromArray(light.across_u) * a + FromArray(light.across_v) * b);
  incidence.to_light = incidence.end - surface.position;
  const Real squared = Dot(incidence.to_light, incidence.to_light);
  incidence.l = incidence.to_light / std::sqrt(squared);
  const Real cosine = -Dot(incidence.l, FromArray(light.axis));
  return {squared / cosine, IsNormalSquare(squared) && cosine > 0};
}

// A ball, drawn from evenly by solid angle: Shirley, Wang, Zimmerman, "Monte Carlo Techniques for
// Direct Lighting Calculations" (ACM TOG 15(1), 1996). From inside it gives nothing.
template <typename Real>
Falling<Real> LookAtSphere(const LightData<Real>& light, const Surface<Real>& surface,
                           SamplePoint<Real> point, Incidence<Real>& incidence) {
  const Vec3<Real> to_centre = FromArray(light.vector) - surface.position;
  const Real squared = Dot(to_centre, to_centre), distance = std::sqrt(squared);
  const Vec3<Real> toward = to_centre / distance;
  const Real square_radius = light.extent * light.extent;
  const Real sine2 = square_radius / squared;  // of the half angle under which it is seen
  const Real rest = 1 - sine2;
  const Real cosine = std::sqrt(rest > 0 ? rest : Real(0));
  const Frame<Real> frame(toward);
  const ConeDirection<Real> cone(toward, frame.x, frame.y, sine2 / (1 + cosine), point);
  const Real beside = distance * cone.sine;  // how far off the centre the line passes
  const Real depth2 = square_radius - beside * beside;
  const Real depth = std::sqrt(depth2 > 0 ? depth2 : Real(0));
  incidence.l = cone.direction;
  incidence.to_light = cone.direction * (distance * cone.cosine - depth);
  incidence.end = surface.position + incidence.to_light;
  return {squared * (1 + cosine) * Real(0.5), IsNormalSquare(squared) && rest > 0};
}

// A sun, seen as a disk of the sky.
template <typename Real>
Falling<Real> LookAtSun(const LightData<Real>& light, SamplePoint<Real> point,
                        Incidence<Real>& incidence) {
  const ConeDirection<Real> cone(FromArray(light.vector), FromArray(light.across_u),
                                 FromArray(light.across_v), light.extent, point);
  incidence.l = incidence.to_light = incidence.end = cone.direction;
  return {};
}

// A point of a triangle that shines to both sides; its colour is not yet weighed.
template <typename Real>
Falling<Real> LookAtEmitters(const EmitterView<Real>& emitters, const Surface<Real>& surface,
                             SamplePoint<Real> point, Incidence<Real>& incidence) {
  const EmitterChoice<Real> choice = ChooseEmitter(emitters, point.u);
  const std::uint32_t i = choice.emitter;
  const auto at = [&](const Real* const(&arrays)[3]) {
    return Vec3<Real>{arrays[0][i], arrays[1][i], arrays[2][i]};
  };
  // Evenly on the triangle.
  const Real along = std::sqrt(choice.rest), second = along * point.v, first = along - second;
  const Vec3<Real> drawn =
      at(emitters.corner) + (at(emitters.edge1) * first + at(emitters.edge2) * second);
  incidence.to_light = drawn - surface.position;
  const Real squared = Dot(incidence.to_light, incidence.to_light);
  incidence.l = incidence.to_light / std::sqrt(squared);
  const Vec3<Real> normal = at(emitters.normal);
  const Real cosine = Dot(incidence.l, normal);
  // The ray ends before the triangle, as one from a light ends above a surface.
  const Real away = emitters.offset[i] + kLightRoundoffs<Real> * AbsDot(normal, incidence.to_light);
  incidence.end = drawn - normal * std::copysign(away, cosine);
  incidence.colour = at(emitters.rgb);
  const Real size = std::abs(cosine);
  return {squared / size, IsNormalSquare(squared) && size > 0, emitters.density[i]};
}

template <typename Real>
Falling<Real> LookAt(const LightData<Real>& light, const Surface<Real>& surface,
                     SamplePoint<Real> point, Incidence<Real>& incidence) {
  switch (light.shape) {
    case LightShape::kPoint:
      break;
    case LightShape::kRectangle:
    case LightShape::kDisk:
      return LookAtFlat(light, surface, point, incidence);
    case LightShape::kSphere:
      return LookAtSphere(light, surface, point, incidence);
    case LightShape::kSun:
      return LookAtSun(light, point, incidence);
    case LightShape::kEmitters:
      return LookAtEmitters(*light.emitters, surface, point, incidence);
  }
  return LookAtPoint(light, surface, incidence);
}

// `point` is where on a light that has a size.
template <typename Real>
Incidence<Real> IncidenceOf(const LightData<Real>& light, const Surface<Real>& surface,
                            SamplePoint<Real> point = {}) {
  Incidence<Real> incidence{};
  const Falling<Real> falling = LookAt(light, surface, point, incidence);
  incidence.n_dot_l = Dot(surface.normal, incidence.l);
  if (!falling.is_light) incidence.n_dot_l = 0;
  if (light.shape == LightShape::kEmitters) {
    const Real ray_density = surface.scatter * (incidence.n_dot_l * kInversePi<Real>);
    if (ray_density > 0) {
      const Real other = ray_density / (falling.density * falling.falloff);
      incidence.colour = incidence.colour * PowerWeight(other);
    }
  }
  incidence.attenuation = 1 / falling.falloff;
  // Nor does a shading normal light the back of a face, but where the face is bent.
  incidence.reaches = incidence.n_dot_l > 0 && Dot(surface.face, incidence.l) > -surface.bend;
  if (light.is_spot) {
    const Real share = ConeShare(light, incidence.l);
    incidence.attenuation = incidence.attenuation * share;
    incidence.reaches = incidence.reaches && share > 0;
  }
  return incidence;
}

}  // namespace sheaf::scalar

#endif  // SHEAF_SCALAR_INCIDENCE_H_
