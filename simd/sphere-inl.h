// Pairs of a ray and a sphere, one a lane: src/scalar/intersect_sphere.h, screened in Real.
//
// A packet meets one sphere with the sphere in every lane, a ray meets several with the ray in
// every lane.
#if defined(SHEAF_SIMD_SPHERE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SHEAF_SIMD_SPHERE_INL_H_
#undef SHEAF_SIMD_SPHERE_INL_H_
#else
#define SHEAF_SIMD_SPHERE_INL_H_
#endif

#include <limits>

#include "simd/math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE {

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

// Lanes whose line may meet the sphere, not beyond t_max nor before t_min: a superset, by
// construction. (fx, fy, fz) is the origin relative to the center.
//
// With u the roundoff and F = |fx| + |fy| + |fz| >= |f|: the computed f is within u F of the true
// one, b / a within 10 u of |f| / |d| relatively, so the computed vector l to the closest point
// within 16 u F. A line that meets the sphere has |l| <= r, hence |computed l| <= r + 16 u F;
// squaring and summing err by 4 u relatively. 32 u F and a factor of 1 + 16 u cover both, `tiny`
// what underflows. The roots are within `reach` / |d| of the closest point, whose parameter errs by
// 16 u F / |d|; one more u of it for the rounding of t itself. NaN passes.
template <class D, class V = hn::Vec<D>>
HWY_INLINE hn::Mask<D> MayHitSphere(D d, V fx, V fy, V fz, V dx, V dy, V dz, V scale, V radius,
                                    V t_min, V t_max) {
  using Real = hn::TFromD<D>;
  constexpr Real kUnit = std::numeric_limits<Real>::epsilon() / 2;
  const V s = hn::Mul(hn::MulAdd(fx, dx, hn::MulAdd(fy, dy, hn::Mul(fz, dz))), scale);
  const V lx = hn::NegMulAdd(s, dx, fx);
  const V ly = hn::NegMulAdd(s, dy, fy);
  const V lz = hn::NegMulAdd(s, dz, fz);
  const V l2 = hn::MulAdd(lx, lx, hn::MulAdd(ly, ly, hn::Mul(lz, lz)));
  const V size = hn::Add(hn::Add(hn::Abs(fx), hn::Abs(fy)), hn::Abs(fz));
  const V reach =
      hn::MulAdd(size, hn::Set(d, 32 * kUnit), hn::Mul(radius, hn::Set(d, 1 + 16 * kUnit)));
  const V tiny = hn::Set(d, std::numeric_limits<Real>::min());
  const V chord2 = hn::Sub(hn::MulAdd(reach, reach, tiny), l2);
  // (t + s)^2 |d|^2 <= chord2 between the roots. What lies beyond the interval's end is left out
  // where the end is before the closest point and too far from it; likewise its start.
  const V slack = hn::Mul(hn::Abs(s), hn::Set(d, 16 * kUnit));
  const V before = hn::Sub(hn::Sub(hn::Neg(s), slack), t_max);  // > 0: the end comes first
  const V after = hn::Sub(hn::Add(t_min, s), slack);            // > 0: the start comes last
  const V gap = hn::Max(hn::Max(before, after), hn::Zero(d));
  const V reach_t2 = hn::Mul(hn::Mul(chord2, scale), hn::Set(d, 1 + 64 * kUnit));
  const auto misses = hn::Or(hn::Lt(chord2, hn::Zero(d)), hn::Gt(hn::Mul(gap, gap), reach_t2));
  return hn::Not(misses);
}

// Both roots wide, as in IntersectSphere; NaN where the line misses.
template <class DW, class W = hn::Vec<DW>>
HWY_INLINE void SphereRoots(DW dw, W fx, W fy, W fz, W dx, W dy, W dz, W r, W& near, W& far) {
  const W zero = hn::Zero(dw);
  const W nan = hn::Set(dw, std::numeric_limits<double>::quiet_NaN());
  const W a = Dot(dw, dx, dy, dz, dx, dy, dz);
  // Negated after the sum: Neg is exact, so the bits are those of -(f . d).
  const W b = hn::Neg(Dot(dw, fx, fy, fz, dx, dy, dz));
  const W s = Divide(dw, b, a);
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
  const W by_product = Divide(dw, c, q);
  const W by_sum = Divide(dw, q, a);
  near = hn::IfThenElse(ahead, by_product, by_sum);
  far = hn::IfThenElse(ahead, by_sum, by_product);
}

// The numbers of N rays or of one, and of N spheres or of one: what a half of a vector of pairs is
// loaded from.
template <typename Real>
struct PairColumn {
  const Real* values;
  std::uint32_t stride;  // 1: one a lane; 0: one for all

  template <class DN>
  HWY_INLINE hn::Vec<DN> Load(DN dn, std::uint32_t lane) const {
    return stride ? hn::LoadU(dn, values + lane) : hn::Set(dn, *values);
  }
};

// Rays and spheres of a vector of pairs.
template <typename Real>
struct SpherePairs {
  PairColumn<Real> origin[3], direction[3];
  PairColumn<Real> center[3], radius;
};

// The lanes of `screened` that hit within [t_min, t_max], with t and u: src/scalar/trace.h,
// HitSphere. `source` and `id` are the rays' sources and the spheres' ids; no lane of `screened`
// starts outside on its sphere. Half a vector at a time, and no half without candidates.
template <class D, class V, class M, class VI, typename Real = hn::TFromD<D>>
HWY_INLINE M HitSphere(D d, const SpherePairs<Real>& pairs, VI source, VI id, V t_min, V t_max,
                       M screened, V& t, V& u) {
  const WideLanes<Real> dw;
  const hn::Rebind<Real, WideLanes<Real>> dn;
  const IdLanes<D> di;
  alignas(kAlignment) Real nears[kMaxLanes], fars[kMaxLanes];
  const std::uint32_t candidates = MaskBits(d, screened);
  const std::uint32_t half = (1u << LaneCount(dn)) - 1;
  for (std::uint32_t lane = 0; lane < LaneCount(d); lane += LaneCount(dn)) {
    if ((candidates >> lane & half) == 0) continue;  // what the arrays hold there does not count
    const auto relative = [&](int axis) SHEAF_LAMBDA {
      return hn::Sub(Widen(pairs.origin[axis].Load(dn, lane)),
                     Widen(pairs.center[axis].Load(dn, lane)));
    };
    hn::Vec<WideLanes<Real>> near, far;
    SphereRoots(dw, relative(0), relative(1), relative(2), Widen(pairs.direction[0].Load(dn, lane)),
                Widen(pairs.direction[1].Load(dn, lane)), Widen(pairs.direction[2].Load(dn, lane)),
                Widen(pairs.radius.Load(dn, lane)), near, far);
    hn::StoreU(Narrow<Real>(near), dn, nears + lane);
    hn::StoreU(Narrow<Real>(far), dn, fars + lane);
  }
  const V near = hn::LoadU(d, nears), far = hn::LoadU(d, fars);
  const VI inside_id = hn::Or(id, hn::Set(di, hn::TFromD<IdLanes<D>>{kInsideBit}));
  const auto inside = hn::RebindMask(d, hn::Eq(source, inside_id));
  // A NaN root is in no interval.
  const auto near_counts = hn::AndNot(inside, hn::Le(t_min, near));
  t = hn::IfThenElse(near_counts, near, far);
  u = hn::IfThenElse(near_counts, hn::Zero(d), hn::Set(d, Real(1)));
  const auto within = hn::And(hn::Le(t_min, t), hn::Le(t, t_max));
  return hn::And(screened, within);
}

}  // namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // SHEAF_SIMD_SPHERE_INL_H_
