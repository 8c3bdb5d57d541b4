// A disk: where a ray meets its plane, computed wide and rounded once, and what is seen there.
//
// The plane is n . (p - c) = 0, t = n . (c - o) / n . d. Products of two floats are exact in double
// and their sums are compensated, so t is within an ULP of the exact one at any angle
// (docs/numerics.md).
#ifndef SHEAF_SCALAR_DISK_H_
#define SHEAF_SCALAR_DISK_H_

#include <cmath>
#include <optional>

#include "simd/primitives.h"
#include "simd/query.h"
#include "simd/roundoffs.h"
#include "src/scalar/frame.h"
#include "src/scalar/ray.h"
#include "src/scalar/surface.h"

namespace sheaf::scalar {

// A sum with what its additions round (Knuth's TwoSum), after Ogita, Rump, Oishi, "Accurate Sum and
// Dot Product" (SIAM J. Sci. Comput. 26(6), 2005).
template <typename W>
struct CompensatedSum {
  W sum, error = 0;

  void Add(W x) {
    const W next = sum + x, part = next - sum;
    error = error + ((sum - (next - part)) + (x - part));
    sum = next;
  }
  W value() const { return sum + error; }
};

// Parameter of the line o + t d on the plane through c with the normal n; not finite where the line
// is in the plane or beside it.
template <typename W>
SHEAF_INLINE W PlaneT(Vec3<W> o, Vec3<W> d, Vec3<W> c, Vec3<W> n) {
  CompensatedSum<W> height{n.x * c.x};
  height.Add(-(n.x * o.x));
  height.Add(n.y * c.y);
  height.Add(-(n.y * o.y));
  height.Add(n.z * c.z);
  height.Add(-(n.z * o.z));
  CompensatedSum<W> slope{n.x * d.x};
  slope.Add(n.y * d.y);
  slope.Add(n.z * d.z);
  return height.value() / slope.value();
}

template <typename Real>
struct DiskHit {
  Real t;
  Real u, v;  // surface coordinates
};

template <typename Real>
Vec3<Wide<Real>> DiskCenter(const DiskArrays<Real>& disks, std::uint32_t i) {
  return Vec3<Real>{disks.center_x[i], disks.center_y[i], disks.center_z[i]}
      .template To<Wide<Real>>();
}
template <typename Real>
Vec3<Wide<Real>> DiskNormal(const DiskArrays<Real>& disks, std::uint32_t i) {
  return Vec3<Real>{disks.normal_x[i], disks.normal_y[i], disks.normal_z[i]}
      .template To<Wide<Real>>();
}

// The hit of one disk in [t_min, t_max]; the source disk is never hit.
template <typename Real>
std::optional<DiskHit<Real>> HitDisk(const Ray<Real>& ray, const DiskArrays<Real>& disks,
                                     std::uint32_t i) {
  using W = Wide<Real>;
  if ((ray.source & ~kInsideBit) == disks.id[i]) return std::nullopt;
  const Vec3<W> o = ray.origin.template To<W>(), d = ray.direction.template To<W>();
  const Vec3<W> c = DiskCenter(disks, i), n = DiskNormal(disks, i);
  const W r = static_cast<W>(disks.radius[i]);
  const W plane_t = PlaneT(o, d, c, n);
  const Vec3<W> l = (o - c) + d * plane_t;
  if (!(r * r - Dot(l, l) >= 0)) return std::nullopt;  // NaN misses
  const Real t = static_cast<Real>(plane_t);
  if (!(ray.t_min <= t && t <= ray.t_max)) return std::nullopt;

  const Frame<W> frame(NormalizeWide(n));
  const W scale = W(0.5) / r;
  return DiskHit<Real>{t, static_cast<Real>(W(0.5) + Dot(l, frame.x) * scale),
                       static_cast<Real>(W(0.5) - Dot(l, frame.y) * scale)};
}

// The point on the plane is found again, so that its error is not that of t.
template <typename Real>
Surface<Real> DiskSurface(const Ray<Real>& ray, const Hit<Real>& hit, const DiskArrays<Real>& disks,
                          std::uint32_t i) {
  using W = Wide<Real>;
  const Vec3<W> o = ray.origin.template To<W>(), d = ray.direction.template To<W>();
  const Vec3<W> c = DiskCenter(disks, i), n = DiskNormal(disks, i);
  const Vec3<W> front = NormalizeWide(n);
  const bool inside = Dot(front, d) > 0;
  const Vec3<W> met = (o - c) + d * PlaneT(o, d, c, n);
  const Vec3<W> l = met - front * Dot(front, met);
  const Vec3<W> position = c + l;

  Surface<Real> surface;
  surface.position = position.template To<Real>();
  surface.shadow_end = surface.position;
  surface.face = (inside ? -front : front).template To<Real>();
  surface.normal = surface.face;
  surface.direction = ray.direction;
  surface.u = hit.u;
  surface.v = hit.v;
  // Where c + l cancels, the error is that of its wide terms.
  const W r = static_cast<W>(disks.radius[i]);
  const Vec3<W> terms = {std::abs(c.x) + r, std::abs(c.y) + r, std::abs(c.z) + r};
  surface.offset =
      static_cast<Real>(static_cast<W>(kPositionRoundoffs<Real>) * AbsDot(front, position) +
                        kTermRoundoffs<W> * AbsDot(front, terms));
  surface.source = hit.primitive | (inside ? kInsideBit : 0);
  return surface;
}

}  // namespace sheaf::scalar

#endif  // SHEAF_SCALAR_DISK_H_
