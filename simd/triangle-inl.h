// Pairs of a ray and a triangle, one a lane: src/scalar/triangle.h (Woop, Benthin, Wald
// 2013, unfused).
//
// A packet meets one triangle with the triangle in every lane, a ray meets several with the ray in
// every lane.
#if defined(SHEAF_SIMD_TRIANGLE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SHEAF_SIMD_TRIANGLE_INL_H_
#undef SHEAF_SIMD_TRIANGLE_INL_H_
#else
#define SHEAF_SIMD_TRIANGLE_INL_H_
#endif

#include "simd/math-inl.h"
#include "simd/roundoffs.h"
#include "simd/sphere-inl.h"

HWY_BEFORE_NAMESPACE();
namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE {

// std::min(a, b) and std::max(a, b), down to the sign of zero.
template <class V>
HWY_INLINE V StrictMin(V a, V b) {
  return hn::IfThenElse(hn::Lt(b, a), b, a);
}
template <class V>
HWY_INLINE V StrictMax(V a, V b) {
  return hn::IfThenElse(hn::Lt(a, b), b, a);
}

// Lanes where the sheared triangle lies beside the ray along one axis.
template <class D, class V = hn::Vec<D>>
HWY_INLINE hn::Mask<D> IsBeside(D d, V a, V b, V c) {
  const V zero = hn::Zero(d);
  return hn::Or(hn::Gt(hn::Min(hn::Min(a, b), c), zero), hn::Lt(hn::Max(hn::Max(a, b), c), zero));
}

// Lanes where `position` lies outside the triangle's extent along an axis, with slack: ExtentOf and
// IsOutside. (The sign of a zero makes no difference here, so the target's Min and Max will do.)
template <class D, class V = hn::Vec<D>>
HWY_INLINE hn::Mask<D> IsOutsideExtent(D d, V position, V a, V b, V c) {
  using Real = hn::TFromD<D>;
  const V low = hn::Min(hn::Min(a, b), c), high = hn::Max(hn::Max(a, b), c);
  const V slack = hn::Mul(hn::Max(hn::Neg(low), high), hn::Set(d, kExtentRoundoffs<Real>));
  return hn::Or(hn::Lt(position, hn::Sub(low, slack)), hn::Gt(position, hn::Add(high, slack)));
}

// One axis of KeepInExtent: narrows [enter, leave].
template <class D, class V = hn::Vec<D>>
HWY_INLINE void NarrowToExtent(D d, V direction, V a, V b, V c, V& enter, V& leave) {
  using Real = hn::TFromD<D>;
  const V low = StrictMin(StrictMin(a, b), c), high = StrictMax(StrictMax(a, b), c);
  const V slack = hn::Mul(StrictMax(hn::Neg(low), high), hn::Set(d, kExtentRoundoffs<Real>));
  const V from = hn::Sub(low, slack), to = hn::Add(high, slack), zero = hn::Zero(d);
  const auto forward = hn::Gt(direction, zero), still = hn::Eq(direction, zero);
  const V first = hn::Div(hn::IfThenElse(forward, from, to), direction);
  const V last = hn::Div(hn::IfThenElse(forward, to, from), direction);
  // A ray that does not move along the axis is in the extent everywhere or nowhere.
  const auto nowhere = hn::And(still, hn::Or(hn::Gt(from, zero), hn::Lt(to, zero)));
  leave = hn::IfThenElse(nowhere, hn::Neg(hn::Inf(d)), leave);
  enter = hn::IfThenElse(still, enter, StrictMax(enter, first));
  leave = hn::IfThenElse(still, leave, StrictMin(leave, last));
}

// Rays and the vertices of triangles of a vector of pairs, as the scene has them.
template <typename Real>
struct TrianglePairs {
  PairColumn<Real> origin[3], direction[3];
  PairColumn<Real> vertex[3][3];  // [vertex][axis]
};

// t of `lanes`, whose triangles reach far beyond their hits: RefineT of src/scalar/triangle.h. In
// double in fast arithmetic too, where t would otherwise not tell a floor from what stands on it.
template <class D, class V, typename Real = hn::TFromD<D>>
HWY_NOINLINE V RefineT(D d, const TrianglePairs<Real>& pairs, std::uint32_t lanes, V t) {
  const hn::CappedTag<double, kMaxLanes / 2> dw;
  const hn::Rebind<Real, decltype(dw)> dn;
  using W = hn::Vec<decltype(dw)>;
  alignas(kAlignment) Real ts[kMaxLanes];
  hn::Store(t, d, ts);
  const std::uint32_t step = LaneCount(dn), half = (1u << step) - 1;
  for (std::uint32_t lane = 0; lane < LaneCount(d); lane += step) {
    if ((lanes >> lane & half) == 0) continue;
    const auto wide = [&](const PairColumn<Real>& column)
                          SHEAF_LAMBDA { return hn::PromoteTo(dw, column.Load(dn, lane)); };
    const auto edge = [&](int vertex, int axis) SHEAF_LAMBDA {
      return hn::Sub(wide(pairs.vertex[vertex][axis]), wide(pairs.vertex[0][axis]));
    };
    const W ex = edge(1, 0), ey = edge(1, 1), ez = edge(1, 2);
    const W gx = edge(2, 0), gy = edge(2, 1), gz = edge(2, 2);
    const W nx = hn::Sub(hn::Mul(ey, gz), hn::Mul(ez, gy));
    const W ny = hn::Sub(hn::Mul(ez, gx), hn::Mul(ex, gz));
    const W nz = hn::Sub(hn::Mul(ex, gy), hn::Mul(ey, gx));
    const W dx = wide(pairs.direction[0]), dy = wide(pairs.direction[1]),
            dz = wide(pairs.direction[2]);
    const auto from_origin = [&](int axis) SHEAF_LAMBDA {
      return hn::Sub(wide(pairs.vertex[0][axis]), wide(pairs.origin[axis]));
    };
    const W height = Dot(dw, nx, ny, nz, from_origin(0), from_origin(1), from_origin(2));
    const W slope = Dot(dw, nx, ny, nz, dx, dy, dz);
    const auto is_steep =
        hn::Gt(hn::Mul(slope, slope),
               hn::Mul(hn::Set(dw, kFlatSquare<Real, double>),
                       hn::Mul(Dot(dw, nx, ny, nz, nx, ny, nz), Dot(dw, dx, dy, dz, dx, dy, dz))));
    const W was = hn::PromoteTo(dw, hn::Load(dn, ts + lane));
    const W refined = hn::IfThenElse(is_steep, hn::Div(height, slope), was);
    alignas(kAlignment) double exact[kMaxLanes];
    hn::Store(refined, dw, exact);
    // Lane by lane: DemoteTo differs by target on what overflows.
    for (std::uint32_t i = 0; i < step; ++i) {
      if ((lanes >> (lane + i) & 1) != 0) ts[lane + i] = static_cast<Real>(exact[i]);
    }
  }
  return hn::Load(d, ts);
}

// Lanes of `lanes` inside the triangle's edges, with t. All coordinates have their axes in the
// order kx, ky, kz of the ray's shear; vertices are relative to the origin, (sx, sy) is the shear.
// elsewhere() are the lanes whose rays do not start on their triangle: most rays that start on a
// mesh are inside the edges of one triangle alone, their own. refine(far, t) is t with RefineT for
// the lanes of `far`, which few are.
// Writes t, v, w and det only where some lane is inside; t is NaN where the ray misses after all.
template <class D, class M, class Elsewhere, class Refine, class V = hn::Vec<D>,
          typename Real = hn::TFromD<D>>
HWY_INLINE M HitTriangle(D d, V ax, V ay, V az, V bx, V by, V bz, V cx, V cy, V cz, V sx, V sy,
                         V dx, V dy, V dz, V t_min, M lanes, const Elsewhere& elsewhere,
                         const Refine& refine, V& t, V& v, V& w, V& det) {
  const V asx = hn::Sub(ax, hn::Mul(sx, az)), asy = hn::Sub(ay, hn::Mul(sy, az));
  const V bsx = hn::Sub(bx, hn::Mul(sx, bz)), bsy = hn::Sub(by, hn::Mul(sy, bz));
  const V csx = hn::Sub(cx, hn::Mul(sx, cz)), csy = hn::Sub(cy, hn::Mul(sy, cz));

  const V ua = hn::Sub(hn::Mul(csx, bsy), hn::Mul(csy, bsx));
  const V vb = hn::Sub(hn::Mul(asx, csy), hn::Mul(asy, csx));
  const V wc = hn::Sub(hn::Mul(bsx, asy), hn::Mul(bsy, asx));
  // Every comparison is false for NaN: the lane misses.
  const V zero = hn::Zero(d);
  const M positive = hn::And(hn::And(hn::Ge(ua, zero), hn::Ge(vb, zero)), hn::Ge(wc, zero));
  const M negative = hn::And(hn::And(hn::Le(ua, zero), hn::Le(vb, zero)), hn::Le(wc, zero));
  const V sum = hn::Add(hn::Add(ua, vb), wc);
  const M has_area = hn::Ge(hn::Abs(sum), hn::Set(d, std::numeric_limits<Real>::min()));
  M inside = hn::And(hn::And(lanes, hn::Or(positive, negative)), has_area);
  if (hn::AllFalse(d, inside)) return inside;
  inside = hn::And(inside, elsewhere());
  if (hn::AllFalse(d, inside)) return inside;
  inside = hn::AndNot(hn::Or(IsBeside(d, asx, bsx, csx), IsBeside(d, asy, bsy, csy)), inside);

  const V scale = hn::AndNot(sum, hn::Inf(d));  // ScaleOf
  const V scaled_t =
      hn::Add(hn::Add(hn::Mul(hn::Mul(ua, scale), az), hn::Mul(hn::Mul(vb, scale), bz)),
              hn::Mul(hn::Mul(wc, scale), cz));
  t = Divide(d, Divide(d, scaled_t, hn::Mul(sum, scale)), dz);
  M outside = NoLanes(d);
  if constexpr (std::is_same_v<Real, float>) {
    const V reach = hn::Max(hn::Max(hn::Abs(az), hn::Abs(bz)), hn::Abs(cz));
    const V met = hn::Mul(hn::Set(d, kFarReach<Real>), hn::Abs(hn::Mul(t, dz)));
    const V behind = hn::Mul(hn::Sub(t_min, t), hn::Abs(dz));
    const V most = hn::Mul(hn::Set(d, kBehindReach<Real>), reach);
    const M far = hn::And(inside, hn::And(hn::Gt(reach, met), hn::Le(behind, most)));
    if (HWY_UNLIKELY(!hn::AllFalse(d, far))) {
      t = refine(far, t);
      outside = hn::And(far, IsOutsideExtent(d, hn::Mul(t, dz), az, bz, cz));
    }
  }
  const M beside = hn::Or(IsOutsideExtent(d, hn::Mul(t, dx), ax, bx, cx),
                          IsOutsideExtent(d, hn::Mul(t, dy), ay, by, cy));
  outside = hn::Or(outside, hn::And(inside, beside));
  if (HWY_UNLIKELY(!hn::AllFalse(d, outside))) {
    V enter = hn::Neg(hn::Inf(d)), leave = hn::Inf(d);
    NarrowToExtent(d, dx, ax, bx, cx, enter, leave);
    NarrowToExtent(d, dy, ay, by, cy, enter, leave);
    NarrowToExtent(d, dz, az, bz, cz, enter, leave);
    V kept = hn::IfThenElse(hn::Lt(t, enter), enter, t);
    kept = hn::IfThenElse(hn::Gt(kept, leave), leave, kept);
    const V nan = hn::Set(d, std::numeric_limits<Real>::quiet_NaN());
    t = hn::IfThenElse(outside, hn::IfThenElse(hn::Le(enter, leave), kept, nan), t);
  }
  v = vb;
  w = wc;
  det = sum;
  return inside;
}

}  // namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // SHEAF_SIMD_TRIANGLE_INL_H_
