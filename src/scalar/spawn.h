// The rays that a surface sends on: reflection by the mirror law, refraction by Snell's law, split
// by Fresnel.
#ifndef SHEAF_SCALAR_SPAWN_H_
#define SHEAF_SCALAR_SPAWN_H_

#include "simd/query.h"
#include "simd/shading.h"
#include "src/scalar/microfacet.h"
#include "src/scalar/ray.h"
#include "src/scalar/shade.h"

namespace sheaf::scalar {

template <typename Real>
bool SpawnsRays(const MaterialData<Real>& material) {
  return AnyPositive(material.reflect) || AnyPositive(material.transmit);
}

// How an interface splits light that arrives at the cosine `cos_i` >= 0.
template <typename Real>
struct Split {
  Real reflectance;  // unpolarised Fresnel; 1 where reflection is total
  Real cos_t;        // of the refracted ray; 0 where there is none
  bool is_total;
};

// `eta` is the index of refraction on the ray's side over that on the other side. Computed wide:
// near the critical angle k cancels, and a few roundoffs of float would decide between a ray and
// none.
template <typename Real>
Split<Real> FresnelSplit(Real eta, Real cos_i) {
  using W = Wide<Real>;
  // Matched indices let everything through unbent, without the rounding of the square root.
  if (eta == 1) return {0, cos_i, false};
  const W n = static_cast<W>(eta), c = static_cast<W>(cos_i);
  const W k = 1 - (n * n) * (1 - c * c);
  if (!(k > 0)) return {1, 0, true};
  const W cos_t = std::sqrt(k);
  // s = s0 / s1 and p = p0 / p1 are the amplitudes; their squares are added over one denominator.
  const W s0 = n * c - cos_t, s1 = n * c + cos_t;
  const W p0 = c - n * cos_t, p1 = c + n * cos_t;
  const W both = s1 * p1, s = s0 * p1, p = p0 * s1;
  const W reflectance = (s * s + p * p) / (2 * (both * both));
  return {static_cast<Real>(reflectance), static_cast<Real>(cos_t), false};
}

// A ray and its throughput.
template <typename Real>
struct Path {
  Ray<Real> ray;
  Real throughput[3];
  Real width = 0;          // of the ray's cone where it starts
  std::uint32_t seed = 0;  // of its random numbers
  Real density = 0;        // with which a diffuse ray was drawn, by solid angle; 0: another

  // Whether it is traced: not where all it could add is weighed by `min_throughput` or less (Hall
  // and Greenberg, "A Testbed for Realistic Image Synthesis", 1983). By default 0: what adds
  // nothing.
  bool counts(Real min_throughput = 0) const {
    return throughput[0] > min_throughput || throughput[1] > min_throughput ||
           throughput[2] > min_throughput;
  }
};

template <typename Real>
struct Spawned {
  Path<Real> reflected, refracted;
};

// A shading normal other than the face's may send a ray to the wrong side of its face, `side` being
// 1 above it and -1 below. Such a ray is mirrored at the face once more, which joins without a step
// where rays are just right.
template <typename Real>
Vec3<Real> KeepOnSide(const Surface<Real>& surface, Vec3<Real> direction, Real side) {
  const Vec3<Real> n = surface.normal, f = surface.face;
  if (n.x == f.x && n.y == f.y && n.z == f.z) return direction;
  const Real height = Dot(direction, f);
  return height * side < 0 ? direction - f * (2 * height) : direction;
}

// The normal that rays are mirrored and bent at.
template <typename Real>
Vec3<Real> MirrorNormal(const MaterialData<Real>& material, const Surface<Real>& surface) {
  return HasFacets(material) ? surface.facet : surface.normal;
}

template <typename Real>
Real ArrivalCosine(Vec3<Real> normal, Vec3<Real> direction) {
  const Real towards = -Dot(normal, direction);
  return towards > 0 ? towards : Real(0);
}

// The index of refraction on the ray's side over that on the other side.
template <typename Real>
Real IndexRatio(const MaterialData<Real>& material, const Surface<Real>& surface) {
  return surface.inside() ? material.ior : 1 / material.ior;
}

// How the surface splits the light of the ray that arrived; of a material that does not transmit,
// all is reflected that is.
template <typename Real>
Split<Real> SplitAt(const MaterialData<Real>& material, const Surface<Real>& surface) {
  if (!AnyPositive(material.transmit)) return {0, 0, true};
  return FresnelSplit(IndexRatio(material, surface),
                      ArrivalCosine(MirrorNormal(material, surface), surface.direction));
}

// What is left of light that a rough surface sends along the unit vector `direction`, on the side
// of its normal that `side` names.
template <typename Real>
Real GlossShare(const MaterialData<Real>& material, const Surface<Real>& surface,
                Vec3<Real> direction, Real side) {
  return Unmasked(Dot(direction, surface.normal) * side, material.slope_width) * surface.gloss;
}

template <typename Real>
Spawned<Real> Spawn(const MaterialData<Real>& material, const Surface<Real>& surface,
                    const Real (&throughput)[3]) {
  const bool is_rough = HasFacets(material);
  const Vec3<Real> n = MirrorNormal(material, surface), d = surface.direction;
  const Real cos_i = ArrivalCosine(n, d), eta = IndexRatio(material, surface);
  const Split<Real> split = SplitAt(material, surface);

  Spawned<Real> spawned;
  const Vec3<Real> away = surface.face * surface.offset;
  spawned.reflected.ray = {surface.position + away,
                           Normalize(KeepOnSide(surface, d + n * (2 * cos_i), Real(1))),
                           surface.source};
  spawned.refracted.ray = {
      surface.position - away,
      Normalize(KeepOnSide(surface, d * eta + n * (eta * cos_i - split.cos_t), Real(-1))),
      surface.source ^ kInsideBit};
  spawned.reflected.width = spawned.refracted.width = surface.width;
  for (int i = 0; i < 3; ++i) {
    const Real reflect = material.reflect[i] + material.transmit[i] * split.reflectance;
    const Real transmit = split.is_total ? Real(0) : material.transmit[i] * (1 - split.reflectance);
    spawned.reflected.throughput[i] = throughput[i] * reflect;
    spawned.refracted.throughput[i] = throughput[i] * transmit;
  }
  if (is_rough) {
    const Real reflected = GlossShare(material, surface, spawned.reflected.ray.direction, Real(1));
    // Where indices match there are no facets: what goes through is not bent.
    const Real refracted =
        eta == 1 ? Real(1)
                 : GlossShare(material, surface, spawned.refracted.ray.direction, Real(-1));
    for (int i = 0; i < 3; ++i) {
      spawned.reflected.throughput[i] = spawned.reflected.throughput[i] * reflected;
      spawned.refracted.throughput[i] = spawned.refracted.throughput[i] * refracted;
    }
  }
  return spawned;
}

}  // namespace sheaf::scalar

#endif  // SHEAF_SCALAR_SPAWN_H_
