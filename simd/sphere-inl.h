// Pairs of a ray and a sphere, one a lane: src/scalar/sphere.h, screened in Real.
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
#include "simd/query.h"
#include "simd/streams.h"

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

// What the roots of a vector of pairs are computed from, as in IntersectSphere. A line's terms wait
// for one division and its root for the next, so each step is done for several lines before the
// next.
template <typename Real>
struct SphereTerms {
  using Wide = hn::TFromD<WideLanes<Real>>;

  alignas(kAlignment) Wide a[kMaxLanes], b[kMaxLanes], c[kMaxLanes];
  alignas(kAlignment) Wide a_delta[kMaxLanes];  // NaN where the line misses
};

// The terms of a vector of lines from `at` on. (fx, fy, fz) is the origin relative to the center.
template <typename Real, class DW, class W = hn::Vec<DW>>
HWY_INLINE void StoreTerms(DW dw, W fx, W fy, W fz, W dx, W dy, W dz, W r, std::uint32_t at,
                           SphereTerms<Real>& terms) {
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
  const auto meets = hn::Ge(delta, hn::Zero(dw));  // false for NaN
  hn::Store(a, dw, terms.a + at);
  hn::Store(b, dw, terms.b + at);
  hn::Store(hn::Sub(Dot(dw, fx, fy, fz, fx, fy, fz), r2), dw, terms.c + at);
  hn::Store(hn::IfThenElse(meets, hn::Mul(a, delta), nan), dw, terms.a_delta + at);
}

// One root of each line: the far one in the lanes of `is_far`, the near one in the others; NaN
// where the line misses.
template <typename Real, class DW, class W = hn::Vec<DW>>
HWY_INLINE W SphereRoot(DW dw, const SphereTerms<Real>& terms, std::uint32_t at,
                        hn::Mask<DW> is_far) {
  const W a = hn::Load(dw, terms.a + at), b = hn::Load(dw, terms.b + at),
          c = hn::Load(dw, terms.c + at);
  const W root = hn::Sqrt(hn::Load(dw, terms.a_delta + at));
  const auto ahead = hn::Ge(b, hn::Zero(dw));
  const W q = hn::IfThenElse(ahead, hn::Add(b, root), hn::Sub(b, root));
  // The far root ahead and the near one behind are q / a, the others c / q.
  const auto by_product = hn::Xor(ahead, is_far);
  return Divide(dw, hn::IfThenElse(by_product, c, q), hn::IfThenElse(by_product, q, a));
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

// Calls body(lane) for the halves of a vector that have a lane of `wanted`, by their first lanes.
template <class D, typename Body>
HWY_INLINE void ForEachHalf(D d, std::uint32_t wanted, Body body) {
  const std::uint32_t lanes = LaneCount(NarrowLanes<hn::TFromD<D>>());
  const std::uint32_t half = (1u << lanes) - 1;
  for (std::uint32_t lane = 0; lane < LaneCount(d); lane += lanes) {
    if ((wanted >> lane & half) != 0) body(lane);
  }
}

// The lanes of `screened` that hit within [t_min, t_max], with t, `leaves` and `t_rest`:
// HitSphere of src/scalar/sphere.h. `source` and `id` are the rays' sources and the spheres' ids;
// no lane of `screened` starts outside on its sphere. Half a vector at a time, and no half without
// candidates.
template <class D, class V, class M, class VI, typename Real = hn::TFromD<D>>
HWY_INLINE M HitSphere(D d, const SpherePairs<Real>& pairs, VI source, VI id, V t_min, V t_max,
                       M screened, V& t, V& leaves, V& t_rest) {
  const WideLanes<Real> dw;
  const NarrowLanes<Real> dn;
  const IdLanes<D> di;
  const V zero = hn::Zero(d), one = hn::Set(d, Real(1));
  SphereTerms<Real> terms;
  alignas(kAlignment) Real roots[kMaxLanes], rests[kMaxLanes], is_far[kMaxLanes];
  const VI inside_id = hn::Or(id, hn::Set(di, hn::TFromD<IdLanes<D>>{kInsideBit}));
  const auto inside = hn::RebindMask(d, hn::Eq(source, inside_id));
  leaves = hn::IfThenElse(inside, one, zero);
  hn::Store(leaves, d, is_far);
  hn::Store(leaves, d, roots);
  hn::Store(zero, d, rests);
  const std::uint32_t candidates = MaskBits(d, screened);
  ForEachHalf(d, candidates, [&](std::uint32_t lane) SHEAF_LAMBDA {
    const auto wide = [&](const PairColumn<Real>& column)
                          SHEAF_LAMBDA { return Widen(column.Load(dn, lane)); };
    const auto relative = [&](int axis) SHEAF_LAMBDA {
      return hn::Sub(wide(pairs.origin[axis]), wide(pairs.center[axis]));
    };
    StoreTerms(dw, relative(0), relative(1), relative(2), wide(pairs.direction[0]),
               wide(pairs.direction[1]), wide(pairs.direction[2]), wide(pairs.radius), lane, terms);
  });
  const auto find_roots = [&](std::uint32_t wanted) SHEAF_LAMBDA {
    ForEachHalf(d, wanted, [&](std::uint32_t lane) SHEAF_LAMBDA {
      const auto far = hn::Ne(Widen(hn::Load(dn, is_far + lane)), hn::Zero(dw));
      const auto root = SphereRoot(dw, terms, lane, far);
      const auto rounded = Narrow<Real>(root);
      hn::Store(rounded, dn, roots + lane);
      if constexpr (kHasWide<Real>) {
        hn::Store(Narrow<Real>(hn::Sub(root, Widen(rounded))), dn, rests + lane);
      }
    });
  };
  find_roots(candidates);
  t = hn::Load(d, roots);
  t_rest = hn::Load(d, rests);
  // Rays that start in a sphere, or past it, see its far root. A NaN root is in no interval.
  const auto too_near = hn::AndNot(hn::Or(inside, hn::Le(t_min, t)), screened);
  if (!hn::AllFalse(d, too_near)) {
    hn::Store(one, d, is_far);
    leaves = hn::IfThenElse(too_near, one, leaves);
    find_roots(MaskBits(d, too_near));
    t = hn::IfThenElse(too_near, hn::Load(d, roots), t);
    t_rest = hn::IfThenElse(too_near, hn::Load(d, rests), t_rest);
  }
  const auto within = hn::And(hn::Le(t_min, t), hn::Le(t, t_max));
  return hn::And(screened, within);
}

}  // namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // SHEAF_SIMD_SPHERE_INL_H_
