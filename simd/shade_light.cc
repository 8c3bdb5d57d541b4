#include "simd/shade_light.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simd/shade_light.cc"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "hwy/highway.h"
#include "simd/dispatch.h"
#include "simd/light-inl.h"
#include "simd/material-inl.h"
#include "simd/pow-inl.h"

HWY_BEFORE_NAMESPACE();
namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE {

template <typename Real>
void ShadeLightLanes(const LightData<Real>& light, const MaterialData<Real>& material,
                     const SurfaceView<Real>& surfaces, const IncidenceView<Real>& incidence,
                     const std::uint32_t* lit, const ColourView<Real>& shares, std::uint32_t count,
                     const ColourOutput<Real>& colours) {
  const Lanes<Real> d;
  using V = hn::Vec<Lanes<Real>>;
  const V one = hn::Set(d, Real(1));
  for (std::uint32_t i = 0; i < count; i += LaneCount(d)) {
    const auto wanted = hn::Ne(LoadIds(d, lit + i), hn::Zero(IdLanes<Lanes<Real>>()));
    const auto lanes = hn::And(LanesBelow(d, i, count), hn::RebindMask(d, wanted));
    if (hn::AllFalse(d, lanes)) continue;
    V lx = hn::LoadU(d, incidence.x + i);
    V ly = hn::LoadU(d, incidence.y + i);
    V lz = hn::LoadU(d, incidence.z + i);
    V n_dot_l = hn::LoadU(d, incidence.cosine + i);
    V falloff = hn::LoadU(d, incidence.falloff + i);
    // FaceLight is strict: what is fast stays so from the light's direction on.
    if (kIsFast && light.shape == LightShape::kPoint) {
      ComputeIncidence(d, light, surfaces, i, lx, ly, lz, n_dot_l, falloff);
    }
    V attenuation = hn::Div(one, falloff);
    if (light.is_spot) attenuation = hn::Mul(attenuation, ConeShare(d, light, lx, ly, lz));
    const V diffuse = hn::Mul(LoadTerm(d, material, material.kd, surfaces.kd, i), n_dot_l);
    V highlight = hn::Zero(d);
    if ((material.needs & kNeedsHighlight) && light.shape != LightShape::kEmitters) {
      V hx = hn::Sub(lx, hn::LoadU(d, surfaces.direction_x + i));
      V hy = hn::Sub(ly, hn::LoadU(d, surfaces.direction_y + i));
      V hz = hn::Sub(lz, hn::LoadU(d, surfaces.direction_z + i));
      Normalize(d, hx, hy, hz);
      const V n_dot_h =
          Dot(d, hn::LoadU(d, surfaces.normal_x + i), hn::LoadU(d, surfaces.normal_y + i),
              hn::LoadU(d, surfaces.normal_z + i), hx, hy, hz);
      // Rounding can carry it past 1; NaN, from an h of length 0, counts as 0.
      const V below_one = hn::IfThenElse(hn::Lt(n_dot_h, one), n_dot_h, one);
      const V clamped = hn::IfThenElseZero(hn::Gt(n_dot_h, hn::Zero(d)), below_one);
      const V power = material.needs & kNeedsTerms
                          ? Pow(d, clamped, OfLanes<Real>{surfaces.shininess + i})
                          : Pow(d, clamped, OfAllLanes<Real>{material.shininess});
      highlight = hn::Mul(LoadTerm(d, material, material.ks, surfaces.ks, i), power);
    }
    V r = hn::Zero(d), g = hn::Zero(d), b = hn::Zero(d);
    LoadBaseColour(d, material, surfaces, i, r, g, b);
    const auto add = [&](int channel, V base, const Real* share, Real* HWY_RESTRICT sum) HWY_ATTR {
      const V light_here = hn::Mul(hn::Set(d, light.rgb[channel]), attenuation);
      V added = hn::Mul(light_here, hn::Add(hn::Mul(base, diffuse), highlight));
      if (share) added = hn::Mul(added, hn::LoadU(d, share + i));
      const V before = hn::LoadU(d, sum + i);
      hn::StoreU(hn::IfThenElse(lanes, hn::Add(before, added), before), d, sum + i);
    };
    add(0, r, shares.r, colours.r);
    add(1, g, shares.g, colours.g);
    add(2, b, shares.b, colours.b);
  }
}
SHEAF_NAME_KERNELS(ShadeLight);

}  // namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sheaf::SHEAF_SIMD {
SHEAF_EXPORT(ShadeLight);
}  // namespace sheaf::SHEAF_SIMD
#endif  // HWY_ONCE
