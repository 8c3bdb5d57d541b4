#include "simd/face_light.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simd/face_light.cc"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "hwy/highway.h"
#include "simd/dispatch.h"
#include "simd/draw_light-inl.h"
#include "simd/light-inl.h"
#include "simd/material-inl.h"

HWY_BEFORE_NAMESPACE();
namespace sheaf::simd::HWY_NAMESPACE {

template <typename Real>
std::uint32_t FaceLightLanes(const LightData<Real>& light, const MaterialData<Real>& material,
                             const SurfaceView<Real>& surfaces, const SampleView<Real>& points,
                             std::uint32_t count, std::uint32_t* faces,
                             const IncidenceOutput<Real>& incidence) {
  const Lanes<Real> d;
  const IdLanes<Lanes<Real>> di;
  using V = hn::Vec<Lanes<Real>>;
  std::uint32_t facing = 0;
  for (std::uint32_t i = 0; i < count; i += LaneCount(d)) {
    V lx = hn::Zero(d), ly = hn::Zero(d), lz = hn::Zero(d), n_dot_l = hn::Zero(d),
      falloff = hn::Zero(d);
    if (light.shape == LightShape::kPoint) {
      ComputeIncidence(d, light, surfaces, i, lx, ly, lz, n_dot_l, falloff);
    } else {
      DrawIncidence(d, light, surfaces, points, i, lx, ly, lz, n_dot_l, falloff, incidence);
    }
    // False for NaN: a light that lies on the point gives nothing.
    auto lanes = hn::And(LanesBelow(d, i, count), hn::Gt(n_dot_l, hn::Zero(d)));
    lanes = hn::And(lanes, HasLocalLight(d, material, surfaces, i));
    if ((material.needs & kNeedsNormals) && surfaces.bend) {
      const V face_dot_l =
          Dot(d, hn::LoadU(d, surfaces.face_x + i), hn::LoadU(d, surfaces.face_y + i),
              hn::LoadU(d, surfaces.face_z + i), lx, ly, lz);
      lanes = hn::And(lanes, hn::Gt(face_dot_l, hn::Neg(hn::LoadU(d, surfaces.bend + i))));
    }
    if (light.is_spot) {
      lanes = hn::And(lanes, hn::Gt(ConeShare(d, light, lx, ly, lz), hn::Zero(d)));
    }
    facing += static_cast<std::uint32_t>(hn::CountTrue(d, lanes));
    const auto one = hn::Set(di, hn::TFromD<decltype(di)>{1});
    StoreIds(d, hn::IfThenElseZero(hn::RebindMask(di, lanes), one), faces + i);
    if (hn::AllFalse(d, lanes)) continue;
    hn::StoreU(lx, d, incidence.x + i);
    hn::StoreU(ly, d, incidence.y + i);
    hn::StoreU(lz, d, incidence.z + i);
    hn::StoreU(n_dot_l, d, incidence.cosine + i);
    hn::StoreU(falloff, d, incidence.falloff + i);
  }
  return facing;
}
SHEAF_NAME_KERNELS(FaceLight);

}  // namespace sheaf::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sheaf::simd {
SHEAF_EXPORT(FaceLight);
}  // namespace sheaf::simd
#endif  // HWY_ONCE
