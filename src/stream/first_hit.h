// Adaptive sampling: what a pixel's first sample saw, and where its neighbours saw something else.
//
// Whitted 1980, section "Anti-aliasing", and Mitchell, "Generating Antialiased Images at Low
// Sampling Densities" (SIGGRAPH 1987): one sample a pixel everywhere, the others only at edges.
#ifndef SHEAF_STREAM_FIRST_HIT_H_
#define SHEAF_STREAM_FIRST_HIT_H_

#include <algorithm>
#include <cmath>

#include "simd/query.h"
#include "src/core/vec3.h"
#include "src/stream/frame_view.h"

namespace sheaf {

template <typename Real>
struct FirstHit {
  Vec3<Real> colour = {0, 0, 0};  // of the sample
  Vec3<Real> normal = {0, 0, 0};  // where the primary ray hit, else 0
  std::uint32_t surface = kNoPrimitive;
  // For the layers of a picture; of a hit alone.
  Real t = 0;
  Vec3<Real> albedo = {0, 0, 0};
  std::uint32_t primitive = kNoPrimitive;
};

// What counts as one surface: a primitive, but all triangles of one material, which meshes are made
// of.
inline std::uint32_t SurfaceIdOf(std::uint32_t primitive, const PrimitiveInfo& info) {
  constexpr std::uint32_t kTriangles = 0x80000000u;
  return info.kind() == PrimitiveKind::kTriangle ? kTriangles | info.material : primitive;
}

// Normals further apart than this, about 18 degrees, are an edge.
template <typename Real>
inline constexpr Real kCreaseCosine = Real(0.95);

// Whether an edge lies between two neighbours: another surface, a crease, or a colour that differs
// by more than `contrast` in a channel, brighter than white counting as white.
template <typename Real>
bool HasEdgeBetween(const FirstHit<Real>& a, const FirstHit<Real>& b, Real contrast) {
  if (a.surface != b.surface) return true;
  const auto differs = [&](Real x, Real y) {
    return std::abs(std::min(x, Real(1)) - std::min(y, Real(1))) > contrast;
  };
  if (differs(a.colour.x, b.colour.x) || differs(a.colour.y, b.colour.y) ||
      differs(a.colour.z, b.colour.z)) {
    return true;
  }
  return a.surface != kNoPrimitive && Dot(a.normal, b.normal) < kCreaseCosine<Real>;
}

}  // namespace sheaf

#endif  // SHEAF_STREAM_FIRST_HIT_H_
