// What the kernels share that make the rays of surfaces: how light splits at an interface, and
// directions on the right side of a face.
#if defined(SHEAF_SIMD_CHILDREN_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SHEAF_SIMD_CHILDREN_INL_H_
#undef SHEAF_SIMD_CHILDREN_INL_H_
#else
#define SHEAF_SIMD_CHILDREN_INL_H_
#endif

#include <algorithm>

#include "simd/math-inl.h"
#include "simd/query.h"
#include "simd/shading.h"
#include "simd/streams.h"

HWY_BEFORE_NAMESPACE();
namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE {

// Surfaces that are worked on together: the divisions and roots of several vectors overlap, which
// those of one do not.
inline constexpr std::uint32_t kBlock = 2 * kMaxLanes;

// What each surface of a block does with the light that arrives.
template <typename Real>
struct Splits {
  alignas(kAlignment) Real cos_i[kBlock], eta[kBlock];
  alignas(kAlignment) Real reflectance[kBlock];
  alignas(kAlignment) Real cos_t[kBlock];  // -1 where reflection is total
};

// The angles of arrival at a vector of surfaces from `i` on, to the block at `at`.
template <typename Real>
HWY_INLINE void StoreArrival(const MaterialData<Real>& material, const SurfaceView<Real>& surfaces,
                             std::uint32_t i, std::uint32_t at, Splits<Real>& splits) {
  const Lanes<Real> d;
  const IdLanes<Lanes<Real>> di;
  const bool is_rough = (material.needs & kNeedsGloss) != 0;
  const auto towards =
      hn::Neg(Dot(d, hn::LoadU(d, (is_rough ? surfaces.facet_x : surfaces.normal_x) + i),
                  hn::LoadU(d, (is_rough ? surfaces.facet_y : surfaces.normal_y) + i),
                  hn::LoadU(d, (is_rough ? surfaces.facet_z : surfaces.normal_z) + i),
                  hn::LoadU(d, surfaces.direction_x + i), hn::LoadU(d, surfaces.direction_y + i),
                  hn::LoadU(d, surfaces.direction_z + i)));
  hn::Store(hn::IfThenElseZero(hn::Gt(towards, hn::Zero(d)), towards), d, splits.cos_i + at);
  if (!(material.needs & kNeedsTransmission)) return;
  const auto bit = hn::Set(di, hn::TFromD<decltype(di)>{kInsideBit});
  const auto source = LoadIds(d, surfaces.source + i);
  const auto inside = hn::RebindMask(d, hn::Ne(hn::And(source, bit), hn::Zero(di)));
  const auto ior = hn::Set(d, material.ior);
  const auto outside_eta = hn::Div(hn::Set(d, Real(1)), ior);
  hn::Store(hn::IfThenElse(inside, ior, outside_eta), d, splits.eta + at);
}

// src/scalar/spawn.h, FresnelSplit, for the surfaces of the block from `at` on, as many as are
// wide.
template <typename Real>
HWY_INLINE void SplitLight(Splits<Real>& splits, std::uint32_t at) {
  const WideLanes<Real> dw;
  const NarrowLanes<Real> dn;
  const auto zero = hn::Zero(dw), one = hn::Set(dw, 1.0), two = hn::Set(dw, 2.0);
  const auto n = Widen(hn::Load(dn, splits.eta + at));
  const auto c = Widen(hn::Load(dn, splits.cos_i + at));
  const auto sin2 = hn::Mul(hn::Mul(n, n), hn::Sub(one, hn::Mul(c, c)));
  const auto k = hn::Sub(one, sin2);
  const auto passes = hn::Gt(k, zero);
  const auto root = hn::Sqrt(k);
  const auto n_c = hn::Mul(n, c), n_t = hn::Mul(n, root);
  const auto s1 = hn::Add(n_c, root), p1 = hn::Add(c, n_t);
  const auto both = hn::Mul(s1, p1);
  const auto s = hn::Mul(hn::Sub(n_c, root), p1), p = hn::Mul(hn::Sub(c, n_t), s1);
  const auto reflectance =
      Divide(dw, hn::Add(hn::Mul(s, s), hn::Mul(p, p)), hn::Mul(two, hn::Mul(both, both)));
  // Matched indices let everything through unbent, without the rounding of the square root.
  const auto matched = hn::Eq(n, one);
  const auto split = hn::IfThenElse(passes, reflectance, one);
  const auto cos_t = hn::IfThenElse(passes, root, hn::Neg(one));
  hn::Store(Narrow<Real>(hn::IfThenZeroElse(matched, split)), dn, splits.reflectance + at);
  hn::Store(Narrow<Real>(hn::IfThenElse(matched, c, cos_t)), dn, splits.cos_t + at);
}

template <typename Real>
HWY_INLINE void FillBlock(const MaterialData<Real>& material, const SurfaceView<Real>& surfaces,
                          std::uint32_t first, std::uint32_t count, Splits<Real>& splits) {
  for (std::uint32_t i = 0; i < count; i += LaneCount(Lanes<Real>())) {
    StoreArrival(material, surfaces, first + i, i, splits);
  }
  if (!(material.needs & kNeedsTransmission)) return;
  for (std::uint32_t i = 0; i < count; i += LaneCount(WideLanes<Real>())) SplitLight(splits, i);
}

// KeepOnSide, then the unit vector.
template <class D, class V = hn::Vec<D>, typename Real = hn::TFromD<D>>
HWY_INLINE void FinishDirection(D d, const MaterialData<Real>& material, V fx, V fy, V fz, V nx,
                                V ny, V nz, V side, V& x, V& y, V& z) {
  if (material.needs & kNeedsNormals) {
    const auto differs = hn::Or(hn::Or(hn::Ne(nx, fx), hn::Ne(ny, fy)), hn::Ne(nz, fz));
    const V height = Dot(d, x, y, z, fx, fy, fz);
    const auto crosses = hn::And(differs, hn::Lt(hn::Mul(height, side), hn::Zero(d)));
    const V back = hn::IfThenElseZero(crosses, hn::Mul(hn::Set(d, Real(2)), height));
    x = hn::IfThenElse(crosses, hn::Sub(x, hn::Mul(fx, back)), x);
    y = hn::IfThenElse(crosses, hn::Sub(y, hn::Mul(fy, back)), y);
    z = hn::IfThenElse(crosses, hn::Sub(z, hn::Mul(fz, back)), z);
  }
  Normalize(d, x, y, z);
}

}  // namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // SHEAF_SIMD_CHILDREN_INL_H_
