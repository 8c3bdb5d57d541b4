// A packet of rays against one sphere: src/scalar/intersect_sphere.h, screened in Real.
#if defined(SHEAF_SIMD_SPHERE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SHEAF_SIMD_SPHERE_INL_H_
#undef SHEAF_SIMD_SPHERE_INL_H_
#else
#define SHEAF_SIMD_SPHERE_INL_H_
#endif

#include <limits>

#include "simd/math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace sheaf::simd::HWY_NAMESPACE {

// The screen's part of a ray: 1 / |d|^2, or NaN where its rounding error is not relative (then the
// screen keeps every sphere).
template <class D, class V = hn::Vec<D>>
HWY_INLINE V ScreenScale(D d, V dx, V dy, V dz) {
  using Real = hn::TFromD<D>;
  const V a = Dot(d, dx, dy, dz, dx, dy, dz);
  const auto in_range =
      hn::And(hn::Gt(a, hn::Set(d, Real(1e-30))), hn::Lt(a, hn::Set(d, Real(1e30))));
  const V nan = hn::Set(d, std::numeric_limits<Real>::quiet_NaN());
  return hn::IfThenElse(in_range, hn::Div(hn::Set(d, Real(1)), a), nan);
}

// Lanes whose line may meet the sphere: a superset, by construction.
//
// With u the roundoff and F = |fx| + |fy| + |fz| >= |f|: the computed f is within u F of the true
// one, b / a within 10 u of |f| / |d| relatively, so the computed vector l to the closest point
// within 16 u F. A line that meets the sphere has |l| <= r, hence |computed l| <= r + 16 u F;
// squaring and summing err by 4 u relatively. 32 u F and a factor of 1 + 16 u cover both, `tiny`
// what underflows. NaN passes. The ray's source never does, unless the ray runs inside it.
template <class D, class VI, class V = hn::Vec<D>, typename Real = hn::TFromD<D>>
HWY_INLINE hn::Mask<D> MayHitSphere(D d, V ox, V oy, V oz, V dx, V dy, V dz, V scale, VI source,
                                    const SphereArrays<Real>& spheres, std::uint32_t index) {
  constexpr Real kUnit = std::numeric_limits<Real>::epsilon() / 2;
  const V fx = hn::Sub(ox, hn::Set(d, spheres.center_x[index]));
  const V fy = hn::Sub(oy, hn::Set(d, spheres.center_y[index]));
  const V fz = hn::Sub(oz, hn::Set(d, spheres.center_z[index]));
  const V s = hn::Mul(hn::MulAdd(fx, dx, hn::MulAdd(fy, dy, hn::Mul(fz, dz))), scale);
  const V lx = hn::NegMulAdd(s, dx, fx);
  const V ly = hn::NegMulAdd(s, dy, fy);
  const V lz = hn::NegMulAdd(s, dz, fz);
  const V l2 = hn::MulAdd(lx, lx, hn::MulAdd(ly, ly, hn::Mul(lz, lz)));
  const V size = hn::Add(hn::Add(hn::Abs(fx), hn::Abs(fy)), hn::Abs(fz));
  const V reach = hn::MulAdd(size, hn::Set(d, 32 * kUnit),
                             hn::Set(d, spheres.radius[index] * (1 + 16 * kUnit)));
  const V tiny = hn::Set(d, std::numeric_limits<Real>::min());
  const IdLanes<D> di;
  const auto from_here = hn::RebindMask(d, hn::Eq(source, hn::Set(di, spheres.id[index])));
  return hn::Not(hn::Or(from_here, hn::Gt(l2, hn::MulAdd(reach, reach, tiny))));
}

// Both roots wide, as in IntersectSphere; NaN where the line misses.
template <class DW, class W = hn::Vec<DW>>
HWY_INLINE void SphereRoots(DW dw, W fx, W fy, W fz, W dx, W dy, W dz, W r, W& near, W& far) {
  const W zero = hn::Zero(dw);
  const W nan = hn::Set(dw, std::numeric_limits<double>::quiet_NaN());
  const W a = Dot(dw, dx, dy, dz, dx, dy, dz);
  // Negated after the sum: Neg is exact, so the bits are those of -(f . d).
  const W b = hn::Neg(Dot(dw, fx, fy, fz, dx, dy, dz));
  const W s = hn::Div(b, a);
  const W lx = hn::Add(fx, hn::Mul(dx, s));
  const W ly = hn::Add(fy, hn::Mul(dy, s));
  const W lz = hn::Add(fz, hn::Mul(dz, s));
  const W r2 = hn::Mul(r, r);
  const W delta = hn::Sub(r2, Dot(dw, lx, ly, lz, lx, ly, lz));
  const auto meets = hn::Ge(delta, zero);  // false for NaN
  const W root = hn::IfThenElse(meets, hn::Sqrt(hn::Mul(a, delta)), nan);
  const W c = hn::Sub(Dot(dw, fx, fy, fz, fx, fy, fz), r2);
  const auto ahead = hn::Ge(b, zero);
  const W q = hn::IfThenElse(ahead, hn::Add(b, root), hn::Sub(b, root));
  const W by_product = hn::Div(c, q);
  const W by_sum = hn::Div(q, a);
  near = hn::IfThenElse(ahead, by_product, by_sum);
  far = hn::IfThenElse(ahead, by_sum, by_product);
}

// The lanes of `screened` that hit the sphere within [t_min, t_max], with t and u:
// src/scalar/trace.h, HitSphere. Reads the rays at `i` from memory, half a vector at a time.
template <class D, class V, class M, class VI, typename Real = hn::TFromD<D>>
HWY_INLINE M HitSphere(D d, const RayView<Real>& rays, std::uint32_t i, VI source, V t_min, V t_max,
                       const SphereArrays<Real>& spheres, std::uint32_t index, M screened, V& t,
                       V& u) {
  const WideLanes<Real> dw;
  const NarrowLanes<Real> dn;
  const IdLanes<D> di;
  const auto cx = hn::Set(dw, static_cast<double>(spheres.center_x[index]));
  const auto cy = hn::Set(dw, static_cast<double>(spheres.center_y[index]));
  const auto cz = hn::Set(dw, static_cast<double>(spheres.center_z[index]));
  const auto r = hn::Set(dw, static_cast<double>(spheres.radius[index]));
  alignas(kAlignment) Real nears[kMaxLanes], fars[kMaxLanes];
  for (std::uint32_t lane = 0; lane < LaneCount(d); lane += LaneCount(dn)) {
    const std::uint32_t at = i + lane;
    const auto fx = hn::Sub(Widen(hn::LoadU(dn, rays.origin_x + at)), cx);
    const auto fy = hn::Sub(Widen(hn::LoadU(dn, rays.origin_y + at)), cy);
    const auto fz = hn::Sub(Widen(hn::LoadU(dn, rays.origin_z + at)), cz);
    const auto dx = Widen(hn::LoadU(dn, rays.direction_x + at));
    const auto dy = Widen(hn::LoadU(dn, rays.direction_y + at));
    const auto dz = Widen(hn::LoadU(dn, rays.direction_z + at));
    auto near = hn::Zero(dw), far = hn::Zero(dw);
    SphereRoots(dw, fx, fy, fz, dx, dy, dz, r, near, far);
    hn::Store(Narrow<Real>(near), dn, nears + lane);
    hn::Store(Narrow<Real>(far), dn, fars + lane);
  }
  const V near = hn::Load(d, nears), far = hn::Load(d, fars);
  const std::uint32_t id = spheres.id[index];
  const auto from_inside = hn::RebindMask(d, hn::Eq(source, hn::Set(di, id | kInsideBit)));
  const auto enters = hn::AndNot(from_inside, hn::Le(t_min, near));
  t = hn::IfThenElse(enters, near, far);
  u = hn::IfThenElse(enters, hn::Zero(d), hn::Set(d, Real(1)));
  // A NaN root is in no interval.
  const auto in_interval = hn::And(hn::Le(t_min, t), hn::Le(t, t_max));
  return hn::And(screened, in_interval);
}

}  // namespace sheaf::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // SHEAF_SIMD_SPHERE_INL_H_
