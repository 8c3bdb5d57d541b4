#include "simd/generate_shadow.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simd/generate_shadow.cc"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "hwy/highway.h"
#include "simd/compact-inl.h"
#include "simd/dispatch.h"
#include "simd/light-inl.h"
#include "simd/query.h"
#include "simd/roundoffs.h"

HWY_BEFORE_NAMESPACE();
namespace sheaf::simd::HWY_NAMESPACE {

template <typename Real>
std::uint32_t GenerateShadowLanes(const LightData<Real>& light, const SurfaceView<Real>& surfaces,
                                  const IncidenceView<Real>& incidence, const std::uint32_t* faces,
                                  std::uint32_t count, const RayOutput<Real>& rays,
                                  std::uint32_t* surface_of_ray) {
  const Lanes<Real> d;
  const IdLanes<Lanes<Real>> di;
  using V = hn::Vec<Lanes<Real>>;
  V light_x = hn::Set(d, light.vector[0]);
  V light_y = hn::Set(d, light.vector[1]);
  V light_z = hn::Set(d, light.vector[2]);
  std::uint32_t size = 0;
  for (std::uint32_t i = 0; i < count; i += LaneCount(d)) {
    const auto wanted = hn::Ne(LoadIds(d, faces + i), hn::Zero(di));
    const auto lanes = hn::And(LanesBelow(d, i, count), hn::RebindMask(d, wanted));
    if (hn::AllFalse(d, lanes)) continue;
    const V px = hn::LoadU(d, surfaces.shadow_x + i);
    const V py = hn::LoadU(d, surfaces.shadow_y + i);
    const V pz = hn::LoadU(d, surfaces.shadow_z + i);
    const V nx = hn::LoadU(d, surfaces.face_x + i);
    const V ny = hn::LoadU(d, surfaces.face_y + i);
    const V nz = hn::LoadU(d, surfaces.face_z + i);
    if (light.shape != LightShape::kPoint) {
      light_x = hn::LoadU(d, incidence.end_x + i);
      light_y = hn::LoadU(d, incidence.end_y + i);
      light_z = hn::LoadU(d, incidence.end_z + i);
    }
    V away = hn::LoadU(d, surfaces.offset + i);
    auto source = LoadIds(d, surfaces.source + i);
    if (light.kind == LightKind::kPointFromLight) {
      const V error =
          AbsDot(d, nx, ny, nz, hn::Sub(light_x, px), hn::Sub(light_y, py), hn::Sub(light_z, pz));
      away = hn::Add(away, hn::Mul(hn::Set(d, kLightRoundoffs<Real>), error));
      // From the inside of a sphere the light may have to pass the sphere itself.
      const auto bit = hn::Set(di, hn::TFromD<decltype(di)>{kInsideBit});
      const auto inside = hn::Ne(hn::And(source, bit), hn::Zero(di));
      source = hn::IfThenElse(inside, hn::Set(di, hn::TFromD<decltype(di)>{kNoPrimitive}), source);
    }
    // The end of the ray that lies above the surface.
    const V qx = hn::Add(px, hn::Mul(nx, away));
    const V qy = hn::Add(py, hn::Mul(ny, away));
    const V qz = hn::Add(pz, hn::Mul(nz, away));
    V ox = qx, oy = qy, oz = qz, dx = light_x, dy = light_y, dz = light_z;
    if (light.kind == LightKind::kPointFromLight) {
      ox = light_x, oy = light_y, oz = light_z;
      dx = hn::Sub(qx, light_x), dy = hn::Sub(qy, light_y), dz = hn::Sub(qz, light_z);
    } else if (light.kind == LightKind::kPointFromSurface) {
      dx = hn::Sub(light_x, qx), dy = hn::Sub(light_y, qy), dz = hn::Sub(light_z, qz);
    }
    const auto order = CompactOrder(d, lanes);
    CompactStore(d, ox, order, rays.origin_x + size);
    CompactStore(d, oy, order, rays.origin_y + size);
    CompactStore(d, oz, order, rays.origin_z + size);
    CompactStore(d, dx, order, rays.direction_x + size);
    CompactStore(d, dy, order, rays.direction_y + size);
    CompactStore(d, dz, order, rays.direction_z + size);
    CompactStoreIds(d, source, order, rays.source + size);
    CompactStoreIds(d, hn::Iota(di, static_cast<hn::TFromD<decltype(di)>>(i)), order,
                    surface_of_ray + size);
    size += CountLanes(d, lanes);
  }
  return size;
}
SHEAF_NAME_KERNELS(GenerateShadow);

}  // namespace sheaf::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sheaf::simd {
SHEAF_EXPORT(GenerateShadow);
}  // namespace sheaf::simd
#endif  // HWY_ONCE
