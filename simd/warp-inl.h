// From points of the unit square to those of other figures: src/scalar/warp.h.
#if defined(SHEAF_SIMD_WARP_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SHEAF_SIMD_WARP_INL_H_
#undef SHEAF_SIMD_WARP_INL_H_
#else
#define SHEAF_SIMD_WARP_INL_H_
#endif

#include "simd/sin_cos-inl.h"

HWY_BEFORE_NAMESPACE();
namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE {

template <class D, class V = hn::Vec<D>, typename Real = hn::TFromD<D>>
HWY_INLINE void DiskPoint(D d, V u, V v, V& x, V& y) {
  const V radius = hn::Sqrt(u);
  V sine, cosine;
  SinCos(d, hn::Mul(hn::Set(d, Real(4)), v), sine, cosine);
  x = hn::Mul(radius, cosine);
  y = hn::Mul(radius, sine);
}

template <class D, class V = hn::Vec<D>, typename Real = hn::TFromD<D>>
HWY_INLINE void PolygonPoint(D d, Real sides, Real turn, V u, V v, V& x, V& y) {
  const V along = hn::Mul(u, hn::Set(d, sides)), side = hn::Floor(along);
  const V step = hn::Set(d, 4 / sides), turned = hn::Set(d, turn);
  const V next = hn::Add(side, hn::Set(d, Real(1)));
  V sin_a, cos_a, sin_b, cos_b;
  SinCos(d, hn::Add(hn::Mul(side, step), turned), sin_a, cos_a);
  SinCos(d, hn::Add(hn::Mul(next, step), turned), sin_b, cos_b);
  const V depth = hn::Sqrt(hn::Sub(along, side)), share = hn::Mul(depth, v);
  const V rest = hn::Sub(depth, share);
  x = hn::Add(hn::Mul(cos_a, rest), hn::Mul(cos_b, share));
  y = hn::Add(hn::Mul(sin_a, rest), hn::Mul(sin_b, share));
}

// ConeDirection about (ax, ay, az) with the axes x and y.
template <class D, class V = hn::Vec<D>, typename Real = hn::TFromD<D>>
HWY_INLINE void DrawInCone(D d, V ax, V ay, V az, V xx, V xy, V xz, V yx, V yy, V yz, V extent, V u,
                           V v, V& dx, V& dy, V& dz, V& cosine, V& sine) {
  const V below = hn::Mul(u, extent);
  V sin_around, cos_around;
  SinCos(d, hn::Mul(hn::Set(d, Real(4)), v), sin_around, cos_around);
  cosine = hn::Sub(hn::Set(d, Real(1)), below);
  sine = hn::Sqrt(hn::Mul(below, hn::Sub(hn::Set(d, Real(2)), below)));
  const V along_x = hn::Mul(sine, cos_around), along_y = hn::Mul(sine, sin_around);
  const auto sum = [&](V a, V x, V y) SHEAF_LAMBDA {
    return hn::Add(hn::Add(hn::Mul(x, along_x), hn::Mul(y, along_y)), hn::Mul(a, cosine));
  };
  dx = sum(ax, xx, yx);
  dy = sum(ay, xy, yy);
  dz = sum(az, xz, yz);
}

}  // namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // SHEAF_SIMD_WARP_INL_H_
