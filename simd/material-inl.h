// What a batch of one material needs to know of it: src/scalar/shade.h.
#if defined(SHEAF_SIMD_MATERIAL_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SHEAF_SIMD_MATERIAL_INL_H_
#undef SHEAF_SIMD_MATERIAL_INL_H_
#else
#define SHEAF_SIMD_MATERIAL_INL_H_
#endif

#include "simd/filter_checker-inl.h"
#include "simd/math-inl.h"
#include "simd/query.h"
#include "simd/shading.h"
#include "simd/streams.h"

HWY_BEFORE_NAMESPACE();
namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE {

// A transparent body has no light of its own inside.
template <class D, typename Real = hn::TFromD<D>>
HWY_INLINE hn::Mask<D> HasLocalLight(D d, const MaterialData<Real>& material,
                                     const SurfaceView<Real>& surfaces, std::uint32_t i) {
  const IdLanes<D> di;
  if (!AnyPositive(material.transmit)) return AllLanes(d);
  const auto bit = hn::Set(di, hn::TFromD<decltype(di)>{kInsideBit});
  return hn::RebindMask(d, hn::Eq(hn::And(LoadIds(d, surfaces.source + i), bit), hn::Zero(di)));
}

// A checker is odd where floor(u * cells) + floor(v * cells) is. Halving and doubling are exact.
template <class D, class V = hn::Vec<D>, typename Real = hn::TFromD<D>>
HWY_INLINE void LoadPattern(D d, const MaterialData<Real>& material,
                            const SurfaceView<Real>& surfaces, std::uint32_t i, V& r, V& g, V& b) {
  r = hn::Set(d, material.even[0]);
  g = hn::Set(d, material.even[1]);
  b = hn::Set(d, material.even[2]);
  if (!(material.needs & kNeedsCoordinates) || material.kind == BaseColour::kTexture) return;
  const V u = hn::Mul(hn::LoadU(d, surfaces.u + i), hn::Set(d, material.cells[0]));
  const V v = hn::Mul(hn::LoadU(d, surfaces.v + i), hn::Set(d, material.cells[1]));
  if (material.kind == BaseColour::kFilteredChecker) {
    const V share = EvenShare(
        d, u, v, hn::Mul(hn::LoadU(d, surfaces.footprint_u + i), hn::Set(d, material.cells[0])),
        hn::Mul(hn::LoadU(d, surfaces.footprint_v + i), hn::Set(d, material.cells[1])));
    const V rest = hn::Sub(hn::Set(d, Real(1)), share);
    r = hn::Add(hn::Mul(r, share), hn::Mul(hn::Set(d, material.odd[0]), rest));
    g = hn::Add(hn::Mul(g, share), hn::Mul(hn::Set(d, material.odd[1]), rest));
    b = hn::Add(hn::Mul(b, share), hn::Mul(hn::Set(d, material.odd[2]), rest));
    return;
  }
  const V cell = hn::Add(hn::Floor(u), hn::Floor(v));
  const V half = hn::Floor(hn::Mul(cell, hn::Set(d, Real(0.5))));
  const auto odd = hn::Ne(cell, hn::Add(half, half));
  r = hn::IfThenElse(odd, hn::Set(d, material.odd[0]), r);
  g = hn::IfThenElse(odd, hn::Set(d, material.odd[1]), g);
  b = hn::IfThenElse(odd, hn::Set(d, material.odd[2]), b);
}

// A shading term: the material's own, or where these vary that of each surface, from `field`.
template <class D, typename Real = hn::TFromD<D>>
HWY_INLINE hn::Vec<D> LoadTerm(D d, const MaterialData<Real>& material, Real term,
                               const Real* HWY_RESTRICT field, std::uint32_t i) {
  return material.needs & kNeedsTerms ? hn::LoadU(d, field + i) : hn::Set(d, term);
}

template <class D, class V = hn::Vec<D>, typename Real = hn::TFromD<D>>
HWY_INLINE void LoadBaseColour(D d, const MaterialData<Real>& material,
                               const SurfaceView<Real>& surfaces, std::uint32_t i, V& r, V& g,
                               V& b) {
  LoadPattern(d, material, surfaces, i, r, g, b);
  if (!(material.needs & kNeedsTint)) return;
  r = hn::Mul(r, hn::LoadU(d, surfaces.tint_r + i));
  g = hn::Mul(g, hn::LoadU(d, surfaces.tint_g + i));
  b = hn::Mul(b, hn::LoadU(d, surfaces.tint_b + i));
}

}  // namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // SHEAF_SIMD_MATERIAL_INL_H_
