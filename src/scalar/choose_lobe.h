// Path tracing: of what a surface sends on, one ray is followed.
//
// Kajiya, "The Rendering Equation" (SIGGRAPH 1986). Light that goes on by mirror, interface or
// diffuse reflection is chosen as often as it is bright, and weighs the more the rarer it is
// chosen; dim paths end by Russian roulette (Arvo and Kirk, "Particle Transport and Image
// Synthesis", SIGGRAPH 1990).
#ifndef SHEAF_SCALAR_CHOOSE_LOBE_H_
#define SHEAF_SCALAR_CHOOSE_LOBE_H_

#include <cmath>

#include "simd/sample_terms.h"
#include "simd/shading.h"
#include "src/scalar/frame.h"
#include "src/scalar/shade.h"
#include "src/scalar/spawn.h"
#include "src/scalar/warp.h"

namespace sheaf::scalar {

// What the throughput of each is multiplied with: 0 for those that are not followed.
template <typename Real>
struct Lobes {
  Real reflect = 0, refract = 0, diffuse = 0;
  Real scatter = 0;  // how likely the diffuse one was to be followed
};

template <typename Real>
Real LargestOf(Vec3<Real> c) {
  const Real xy = c.x > c.y ? c.x : c.y;
  return xy > c.z ? xy : c.z;
}

// `u` in [0, 1) chooses. `here` is the
// material as it is at the surface, where its base colour is `base`.
template <typename Real>
Lobes<Real> ChooseLobe(const MaterialData<Real>& material, const MaterialData<Real>& here,
                       const Surface<Real>& surface, Vec3<Real> base, const Real (&throughput)[3],
                       Roulette roulette, Real u) {
  const Split<Real> split = SplitAt(here, surface);
  const Real kd = HasLocalLight(material, surface) ? here.kd : Real(0);
  const auto largest = [&](auto share) {
    return LargestOf(
        Vec3<Real>{throughput[0] * share(0), throughput[1] * share(1), throughput[2] * share(2)});
  };
  const Real base_at[3] = {base.x, base.y, base.z};
  const Real reflect =
      largest([&](int i) { return here.reflect[i] + here.transmit[i] * split.reflectance; });
  const Real refract = largest(
      [&](int i) { return split.is_total ? Real(0) : here.transmit[i] * (1 - split.reflectance); });
  const Real diffuse = largest([&](int i) { return kd * base_at[i]; });
  const Real through = reflect + refract, all = through + diffuse;
  // A path goes on with the probability of its brightness, but not too rarely.
  Real survival = 1;
  if (roulette == Roulette::kOn && all < 1) {
    survival = all > kLeastSurvival<Real> ? all : kLeastSurvival<Real>;
  }
  const Real pick = u * all / survival;
  Lobes<Real> lobes;
  if (all > 0) lobes.scatter = diffuse * survival / all;
  if (pick < reflect) {
    lobes.reflect = all / (reflect * survival);
  } else if (pick < through) {
    lobes.refract = all / (refract * survival);
  } else if (pick < all) {
    lobes.diffuse = all / (diffuse * survival);
  }
  return lobes;
}

// A ray by Lambert's law: as often as the cosine with the normal, so that its throughput is that of
// the surface's colour.
template <typename Real>
Path<Real> ScatterDiffuse(const MaterialData<Real>& here, const Surface<Real>& surface,
                          Vec3<Real> base, const Real (&throughput)[3], Real share,
                          SamplePoint<Real> point) {
  const Frame<Real> frame(surface.normal);
  const PlanePoint<Real> on_disk = DiskPoint(point);
  const Real cosine = std::sqrt(1 - point.u);
  const Vec3<Real> direction =
      (frame.x * on_disk.x + frame.y * on_disk.y) + surface.normal * cosine;
  Path<Real> path{};
  path.ray = {surface.position + surface.face * surface.offset,
              Normalize(KeepOnSide(surface, direction, Real(1))), surface.source};
  path.width = surface.width;
  path.density = surface.scatter * (cosine * kInversePi<Real>);
  const Real base_at[3] = {base.x, base.y, base.z};
  for (int i = 0; i < 3; ++i) {
    path.throughput[i] = (throughput[i] * (here.kd * base_at[i])) * share;
  }
  return path;
}

}  // namespace sheaf::scalar

#endif  // SHEAF_SCALAR_CHOOSE_LOBE_H_
