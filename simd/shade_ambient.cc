#include "simd/shade_ambient.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simd/shade_ambient.cc"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "hwy/highway.h"
#include "simd/dispatch.h"
#include "simd/material-inl.h"

HWY_BEFORE_NAMESPACE();
namespace sheaf::simd::HWY_NAMESPACE {

template <typename Real>
void ShadeAmbientLanes(const MaterialData<Real>& material, const SurfaceView<Real>& surfaces,
                       std::uint32_t count, const ColourOutput<Real>& colours) {
  const Lanes<Real> d;
  using V = hn::Vec<Lanes<Real>>;
  for (std::uint32_t i = 0; i < count; i += LaneCount(d)) {
    const auto local = HasLocalLight(d, material, surfaces, i);
    V r = hn::Zero(d), g = hn::Zero(d), b = hn::Zero(d);
    LoadBaseColour(d, material, surfaces, i, r, g, b);
    const auto ambient = [&](int channel, V base, const Real* ambients,
                             const Real* emissions) HWY_ATTR {
      const V reflected = LoadTerm(d, material, material.ambient[channel], ambients, i);
      const V emission = LoadTerm(d, material, material.emission[channel], emissions, i);
      return hn::IfThenElseZero(local, hn::Add(hn::Mul(reflected, base), emission));
    };
    hn::StoreU(ambient(0, r, surfaces.ambient_r, surfaces.emission_r), d, colours.r + i);
    hn::StoreU(ambient(1, g, surfaces.ambient_g, surfaces.emission_g), d, colours.g + i);
    hn::StoreU(ambient(2, b, surfaces.ambient_b, surfaces.emission_b), d, colours.b + i);
  }
}
SHEAF_NAME_KERNELS(ShadeAmbient);

}  // namespace sheaf::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sheaf::simd {
SHEAF_EXPORT(ShadeAmbient);
}  // namespace sheaf::simd
#endif  // HWY_ONCE
