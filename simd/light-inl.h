// A light as surfaces see it.
#if defined(SHEAF_SIMD_LIGHT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SHEAF_SIMD_LIGHT_INL_H_
#undef SHEAF_SIMD_LIGHT_INL_H_
#else
#define SHEAF_SIMD_LIGHT_INL_H_
#endif

#include <limits>

#include "simd/math-inl.h"
#include "simd/shading.h"
#include "simd/streams.h"

HWY_BEFORE_NAMESPACE();
namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE {

// The unit vector to the light, its cosine with the normal (0 where the light lies on the point)
// and the denominator of its falloff: IncidenceOf in src/scalar/incidence.h.
template <class D, class V = hn::Vec<D>, typename Real = hn::TFromD<D>>
HWY_INLINE void ComputeIncidence(D d, const LightData<Real>& light,
                                 const SurfaceView<Real>& surfaces, std::uint32_t i, V& lx, V& ly,
                                 V& lz, V& n_dot_l, V& falloff) {
  lx = hn::Set(d, light.vector[0]);
  ly = hn::Set(d, light.vector[1]);
  lz = hn::Set(d, light.vector[2]);
  V squared = hn::Zero(d), distance = hn::Zero(d);
  if (light.kind != LightKind::kDirectional) {
    lx = hn::Sub(lx, hn::LoadU(d, surfaces.position_x + i));
    ly = hn::Sub(ly, hn::LoadU(d, surfaces.position_y + i));
    lz = hn::Sub(lz, hn::LoadU(d, surfaces.position_z + i));
    squared = Dot(d, lx, ly, lz, lx, ly, lz);
    distance = hn::Sqrt(squared);
    Normalize(d, lx, ly, lz);
  }
  n_dot_l = Dot(d, hn::LoadU(d, surfaces.normal_x + i), hn::LoadU(d, surfaces.normal_y + i),
                hn::LoadU(d, surfaces.normal_z + i), lx, ly, lz);
  if (light.kind != LightKind::kDirectional) {
    const auto is_apart = hn::Ge(squared, hn::Set(d, std::numeric_limits<Real>::min()));
    n_dot_l = hn::IfThenElseZero(is_apart, n_dot_l);
  }
  falloff = hn::Add(
      hn::Add(hn::Set(d, light.falloff[0]), hn::Mul(hn::Set(d, light.falloff[1]), distance)),
      hn::Mul(hn::Set(d, light.falloff[2]), squared));
}

// A spot light's share toward surfaces that see it along (lx, ly, lz): ConeShare in
// src/scalar/incidence.h.
template <class D, class V = hn::Vec<D>, typename Real = hn::TFromD<D>>
HWY_INLINE V ConeShare(D d, const LightData<Real>& light, V lx, V ly, V lz) {
  const V zero = hn::Zero(d), one = hn::Set(d, Real(1));
  const V cos = Dot(d, lx, ly, lz, hn::Set(d, light.axis[0]), hn::Set(d, light.axis[1]),
                    hn::Set(d, light.axis[2]));
  const V share =
      hn::Add(hn::Mul(hn::Neg(cos), hn::Set(d, light.cone_scale)), hn::Set(d, light.cone_offset));
  const V below_one = hn::IfThenElse(hn::Lt(share, one), share, one);
  const V clamped = hn::IfThenElseZero(hn::Gt(share, zero), below_one);
  return hn::Mul(clamped, clamped);
}

}  // namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // SHEAF_SIMD_LIGHT_INL_H_
