// The ray that asks whether a light reaches a surface.
#ifndef SHEAF_SCALAR_SHADOW_RAY_H_
#define SHEAF_SCALAR_SHADOW_RAY_H_

#include "simd/query.h"
#include "simd/roundoffs.h"
#include "simd/shading.h"
#include "src/scalar/shade.h"

namespace sheaf::scalar {

template <typename Real>
Ray<Real> ShadowRay(const LightData<Real>& light, const Surface<Real>& surface,
                    const Incidence<Real>& incidence) {
  if (light.kind == LightKind::kPointFromLight) {
    const Vec3<Real> position = FromArray(light.vector);
    const Real away = surface.offset +
                      kLightRoundoffs<Real> * AbsDot(surface.face, position - surface.shadow_end);
    const Vec3<Real> target = surface.shadow_end + surface.face * away;
    // From the inside of a sphere the light may have to pass the sphere itself.
    const std::uint32_t source = surface.inside() ? kNoPrimitive : surface.source;
    return {position, target - position, source, kDefaultTMin<Real>, Real(1)};
  }
  const Vec3<Real> start = surface.shadow_end + surface.face * surface.offset;
  if (light.kind == LightKind::kDirectional) return {start, incidence.to_light, surface.source};
  const bool is_point = light.shape == LightShape::kPoint;
  const Vec3<Real> end = is_point ? FromArray(light.vector) : incidence.end;
  return {start, end - start, surface.source, kDefaultTMin<Real>, Real(1)};
}

}  // namespace sheaf::scalar

#endif  // SHEAF_SCALAR_SHADOW_RAY_H_
