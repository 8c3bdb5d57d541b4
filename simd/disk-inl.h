// Pairs of a ray and a disk, one a lane: src/scalar/disk.h, screened in Real as the sphere around
// the disk.
#if defined(SHEAF_SIMD_DISK_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SHEAF_SIMD_DISK_INL_H_
#undef SHEAF_SIMD_DISK_INL_H_
#else
#define SHEAF_SIMD_DISK_INL_H_
#endif

#include <limits>

#include "simd/frame-inl.h"
#include "simd/math-inl.h"
#include "simd/query.h"
#include "simd/sphere-inl.h"
#include "simd/streams.h"

HWY_BEFORE_NAMESPACE();
namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE {

// CompensatedSum::Add.
template <class V>
HWY_INLINE void AddCompensated(V x, V& sum, V& error) {
  const V next = hn::Add(sum, x), part = hn::Sub(next, sum);
  error = hn::Add(error, hn::Add(hn::Sub(sum, hn::Sub(next, part)), hn::Sub(x, part)));
  sum = next;
}

// PlaneT: the line o + t d on the plane through c with the normal n.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V PlaneT(D d, V ox, V oy, V oz, V dx, V dy, V dz, V cx, V cy, V cz, V nx, V ny, V nz) {
  V height = hn::Mul(nx, cx), height_error = hn::Zero(d);
  AddCompensated(hn::Neg(hn::Mul(nx, ox)), height, height_error);
  AddCompensated(hn::Mul(ny, cy), height, height_error);
  AddCompensated(hn::Neg(hn::Mul(ny, oy)), height, height_error);
  AddCompensated(hn::Mul(nz, cz), height, height_error);
  AddCompensated(hn::Neg(hn::Mul(nz, oz)), height, height_error);
  V slope = hn::Mul(nx, dx), slope_error = hn::Zero(d);
  AddCompensated(hn::Mul(ny, dy), slope, slope_error);
  AddCompensated(hn::Mul(nz, dz), slope, slope_error);
  return Divide(d, hn::Add(height, height_error), hn::Add(slope, slope_error));
}

// The surface coordinates of points l from the center; (nx, ny, nz) is any normal: Frame.
template <class D, class V = hn::Vec<D>>
HWY_INLINE void DiskCoordinates(D d, V nx, V ny, V nz, V lx, V ly, V lz, V r, V& u, V& v) {
  using W = hn::TFromD<D>;
  NormalizeWide(d, nx, ny, nz);
  const V half = hn::Set(d, W(0.5));
  V xx, xy, xz, yx, yy, yz;
  MakeFrame(d, nx, ny, nz, xx, xy, xz, yx, yy, yz);
  const V scale = hn::Div(half, r);
  const V along_x = Dot(d, lx, ly, lz, xx, xy, xz);
  const V along_y = Dot(d, lx, ly, lz, yx, yy, yz);
  u = hn::Add(half, hn::Mul(along_x, scale));
  v = hn::Sub(half, hn::Mul(along_y, scale));
}

// The lanes of `screened` that hit within [t_min, t_max], with t and, for the nearest hit, u and v:
// HitDisk of src/scalar/disk.h, but for the source, whose lanes are not in `screened`. The sphere
// of `pairs` is the one around the disk. Half a vector at a time, and no half without candidates.
template <Query kQuery, class D, class V, class M, typename Real = hn::TFromD<D>>
HWY_INLINE M HitDisk(D d, const SpherePairs<Real>& pairs, const PairColumn<Real> (&normal)[3],
                     V t_min, V t_max, M screened, V& t, V& u, V& v) {
  const WideLanes<Real> dw;
  const NarrowLanes<Real> dn;
  using W = hn::Vec<WideLanes<Real>>;
  alignas(kAlignment) Real ts[kMaxLanes], us[kMaxLanes], vs[kMaxLanes];
  const V zero = hn::Zero(d);
  hn::Store(zero, d, ts);
  hn::Store(zero, d, us);
  hn::Store(zero, d, vs);
  ForEachHalf(d, MaskBits(d, screened), [&](std::uint32_t lane) SHEAF_LAMBDA {
    const auto wide = [&](const PairColumn<Real>& column)
                          SHEAF_LAMBDA { return Widen(column.Load(dn, lane)); };
    const W ox = wide(pairs.origin[0]), oy = wide(pairs.origin[1]), oz = wide(pairs.origin[2]);
    const W dx = wide(pairs.direction[0]), dy = wide(pairs.direction[1]),
            dz = wide(pairs.direction[2]);
    const W cx = wide(pairs.center[0]), cy = wide(pairs.center[1]), cz = wide(pairs.center[2]);
    const W nx = wide(normal[0]), ny = wide(normal[1]), nz = wide(normal[2]);
    const W r = wide(pairs.radius);
    const W plane_t = PlaneT(dw, ox, oy, oz, dx, dy, dz, cx, cy, cz, nx, ny, nz);
    const W lx = hn::Add(hn::Sub(ox, cx), hn::Mul(dx, plane_t));
    const W ly = hn::Add(hn::Sub(oy, cy), hn::Mul(dy, plane_t));
    const W lz = hn::Add(hn::Sub(oz, cz), hn::Mul(dz, plane_t));
    // False for NaN, which misses; NaN is in no interval.
    const auto within =
        hn::Ge(hn::Sub(hn::Mul(r, r), Dot(dw, lx, ly, lz, lx, ly, lz)), hn::Zero(dw));
    const W nan = hn::Set(dw, std::numeric_limits<double>::quiet_NaN());
    hn::Store(Narrow<Real>(hn::IfThenElse(within, plane_t, nan)), dn, ts + lane);
    if constexpr (kQuery == Query::kClosest) {
      W wide_u, wide_v;
      DiskCoordinates(dw, nx, ny, nz, lx, ly, lz, r, wide_u, wide_v);
      hn::Store(Narrow<Real>(wide_u), dn, us + lane);
      hn::Store(Narrow<Real>(wide_v), dn, vs + lane);
    }
  });
  t = hn::Load(d, ts);
  u = hn::Load(d, us);
  v = hn::Load(d, vs);
  return hn::And(screened, hn::And(hn::Le(t_min, t), hn::Le(t, t_max)));
}

}  // namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // SHEAF_SIMD_DISK_INL_H_
