// The surface, material and light that shading is tested with.
#ifndef SHEAF_TESTS_PLAIN_SURFACES_H_
#define SHEAF_TESTS_PLAIN_SURFACES_H_

#include <cmath>

#include "random_scene.h"
#include "simd/query.h"
#include "simd/shading.h"
#include "src/scalar/surface.h"

namespace sheaf {

inline double Length(Vec3<double> a) { return std::sqrt(Dot(a, a)); }
// A unit vector on the side of `normal`.
inline Vec3<double> RandomAbout(Random& random, Vec3<double> normal) {
  const Vec3<double> v = RandomUnit(random);
  return Dot(v, normal) < 0 ? -v : v;
}

// A level surface at `position` seen from straight above.
inline scalar::Surface<float> Floor(Vec3<float> position = {0, 0, 0}) {
  scalar::Surface<float> surface;
  surface.position = surface.shadow_end = position;
  surface.normal = surface.face = {0, 1, 0};
  surface.direction = {0, -1, 0};
  surface.offset = 1e-6f;
  surface.source = 0;
  return surface;
}

inline MaterialData<float> White(float kd, float ks, float shininess) {
  MaterialData<float> material{};
  for (float& c : material.even) c = 1;
  material.kd = kd, material.ks = ks, material.shininess = shininess, material.ior = 1;
  return material;
}

inline LightData<float> PointLightAt(Vec3<float> at, float kc, float kl, float kq) {
  return {LightKind::kPointFromLight, {at.x, at.y, at.z}, {2, 3, 5}, {kc, kl, kq}, 1};
}

}  // namespace sheaf

#endif  // SHEAF_TESTS_PLAIN_SURFACES_H_
