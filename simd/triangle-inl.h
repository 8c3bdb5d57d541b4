// A packet of rays against one triangle: src/scalar/intersect_triangle.h (Woop, Benthin, Wald 2013,
// unfused).
#if defined(SHEAF_SIMD_TRIANGLE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SHEAF_SIMD_TRIANGLE_INL_H_
#undef SHEAF_SIMD_TRIANGLE_INL_H_
#else
#define SHEAF_SIMD_TRIANGLE_INL_H_
#endif

#include "simd/math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace sheaf::simd::HWY_NAMESPACE {

// Lanes whose direction is dominated by `axis`; x wins ties, then y (ShearOf).
template <class D, class V = hn::Vec<D>>
HWY_INLINE hn::Mask<D> DominatedBy(D /*d*/, int axis, V dx, V dy, V dz) {
  const V ax = hn::Abs(dx), ay = hn::Abs(dy), az = hn::Abs(dz);
  const auto x = hn::And(hn::Ge(ax, ay), hn::Ge(ax, az));
  if (axis == 0) return x;
  const auto y = hn::AndNot(x, hn::Ge(ay, az));
  return axis == 1 ? y : hn::Not(hn::Or(x, y));
}

// The triangles' vertices with their axes in the order kx, ky, kz of a shear.
template <typename Real>
struct ShearedVertices {
  const Real* HWY_RESTRICT x[3];
  const Real* HWY_RESTRICT y[3];
  const Real* HWY_RESTRICT z[3];

  ShearedVertices(const TriangleArrays<Real>& triangles, int kz) {
    for (int vertex = 0; vertex < 3; ++vertex) {
      x[vertex] = triangles.vertex[vertex][(kz + 1) % 3];
      y[vertex] = triangles.vertex[vertex][(kz + 2) % 3];
      z[vertex] = triangles.vertex[vertex][kz];
    }
  }
};

// Lanes inside the triangle's edges, with t and barycentrics; t, u and v are written only where
// some lane is. The origin's axes are in the order kx, ky, kz; (sx, sy) is the shear, dz the
// direction along kz.
template <class D, class M, class V = hn::Vec<D>, typename Real = hn::TFromD<D>>
HWY_INLINE M HitTriangle(D d, V ox, V oy, V oz, V sx, V sy, V dz,
                         const ShearedVertices<Real>& vertices, std::uint32_t index, M lanes, V& t,
                         V& u, V& v) {
  const V az = hn::Sub(hn::Set(d, vertices.z[0][index]), oz);
  const V bz = hn::Sub(hn::Set(d, vertices.z[1][index]), oz);
  const V cz = hn::Sub(hn::Set(d, vertices.z[2][index]), oz);
  const V ax = hn::Sub(hn::Sub(hn::Set(d, vertices.x[0][index]), ox), hn::Mul(sx, az));
  const V ay = hn::Sub(hn::Sub(hn::Set(d, vertices.y[0][index]), oy), hn::Mul(sy, az));
  const V bx = hn::Sub(hn::Sub(hn::Set(d, vertices.x[1][index]), ox), hn::Mul(sx, bz));
  const V by = hn::Sub(hn::Sub(hn::Set(d, vertices.y[1][index]), oy), hn::Mul(sy, bz));
  const V cx = hn::Sub(hn::Sub(hn::Set(d, vertices.x[2][index]), ox), hn::Mul(sx, cz));
  const V cy = hn::Sub(hn::Sub(hn::Set(d, vertices.y[2][index]), oy), hn::Mul(sy, cz));

  const V ua = hn::Sub(hn::Mul(cx, by), hn::Mul(cy, bx));
  const V vb = hn::Sub(hn::Mul(ax, cy), hn::Mul(ay, cx));
  const V wc = hn::Sub(hn::Mul(bx, ay), hn::Mul(by, ax));
  // Every comparison is false for NaN: the lane misses.
  const V zero = hn::Zero(d);
  const M positive = hn::And(hn::And(hn::Ge(ua, zero), hn::Ge(vb, zero)), hn::Ge(wc, zero));
  const M negative = hn::And(hn::And(hn::Le(ua, zero), hn::Le(vb, zero)), hn::Le(wc, zero));
  const V det = hn::Add(hn::Add(ua, vb), wc);
  const M inside = hn::And(hn::And(lanes, hn::Or(positive, negative)), hn::Ne(det, zero));
  if (hn::AllFalse(d, inside)) return inside;

  const V scaled_t = hn::Add(hn::Add(hn::Mul(ua, az), hn::Mul(vb, bz)), hn::Mul(wc, cz));
  t = hn::Div(hn::Div(scaled_t, det), dz);
  u = hn::Div(vb, det);
  v = hn::Div(wc, det);
  return inside;
}

}  // namespace sheaf::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // SHEAF_SIMD_TRIANGLE_INL_H_
