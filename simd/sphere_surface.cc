#include "simd/sphere_surface.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simd/sphere_surface.cc"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "hwy/highway.h"
#include "simd/dispatch.h"
#include "simd/roundoffs.h"
#include "simd/sphere-inl.h"

HWY_BEFORE_NAMESPACE();
namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE {

template <typename Real>
void SphereSurfacesLanes(const SphereArrays<Real>& spheres, const RayView<Real>& rays,
                         const HitView<Real>& hits, const HitBatch& batch, std::uint32_t needs,
                         const SurfaceOutput<Real>& surfaces) {
  const WideLanes<Real> dw;
  const NarrowLanes<Real> dn;
  const IdLanes<NarrowLanes<Real>> di;
  using Wide = hn::TFromD<WideLanes<Real>>;
  for (std::uint32_t i = 0; i < batch.count; i += LaneCount(dn)) {
    // Lanes past the count gather element 0.
    const auto lanes = hn::RebindMask(di, LanesBelow(dn, i, batch.count));
    const auto ray = hn::IfThenElseZero(lanes, LoadIds(dn, batch.ray + i));
    const auto local = hn::IfThenElseZero(lanes, LoadIds(dn, batch.local + i));
    const std::uint32_t wanted = batch.count - i;
    const IdPattern ray_pattern = PatternOf(batch.ray + i, LaneCount(dn), wanted);
    const IdPattern local_pattern = PatternOf(batch.local + i, LaneCount(dn), wanted);
    const auto of_ray = [&](const Real* array)
                            HWY_ATTR { return Fetch(dn, ray_pattern, array, batch.ray[i], ray); };
    const auto of_local = [&](const Real* array) HWY_ATTR {
      return Fetch(dn, local_pattern, array, batch.local[i], local);
    };
    const auto direction_x = of_ray(rays.direction_x);
    const auto direction_y = of_ray(rays.direction_y);
    const auto direction_z = of_ray(rays.direction_z);
    const auto leaves = hn::Ne(of_ray(hits.u), hn::Zero(dn));

    const auto cx = Widen(of_local(spheres.center_x));
    const auto cy = Widen(of_local(spheres.center_y));
    const auto cz = Widen(of_local(spheres.center_z));
    const auto r = Widen(of_local(spheres.radius));
    const auto fx = hn::Sub(Widen(of_ray(rays.origin_x)), cx);
    const auto fy = hn::Sub(Widen(of_ray(rays.origin_y)), cy);
    const auto fz = hn::Sub(Widen(of_ray(rays.origin_z)), cz);
    const auto dx = Widen(direction_x), dy = Widen(direction_y), dz = Widen(direction_z);
    auto near = hn::Zero(dw), far = hn::Zero(dw);
    SphereRoots(dw, fx, fy, fz, dx, dy, dz, r, near, far);
    const auto leaves_wide =
        hn::Ne(Widen(hn::IfThenElseZero(leaves, hn::Set(dn, Real(1)))), hn::Zero(dw));
    const auto t = hn::IfThenElse(leaves_wide, far, near);
    auto nx = hn::Add(fx, hn::Mul(dx, t));
    auto ny = hn::Add(fy, hn::Mul(dy, t));
    auto nz = hn::Add(fz, hn::Mul(dz, t));
    NormalizeWide(dw, nx, ny, nz);

    const auto px = hn::Add(cx, hn::Mul(nx, r));
    const auto py = hn::Add(cy, hn::Mul(ny, r));
    const auto pz = hn::Add(cz, hn::Mul(nz, r));
    const auto position_error = hn::Mul(hn::Set(dw, static_cast<Wide>(kPositionRoundoffs<Real>)),
                                        AbsDot(dw, nx, ny, nz, px, py, pz));
    const auto term_error = hn::Mul(hn::Set(dw, kTermRoundoffs<Wide>),
                                    AbsDot(dw, nx, ny, nz, hn::Add(hn::Abs(cx), r),
                                           hn::Add(hn::Abs(cy), r), hn::Add(hn::Abs(cz), r)));

    hn::StoreU(Narrow<Real>(px), dn, surfaces.position_x + i);
    hn::StoreU(Narrow<Real>(py), dn, surfaces.position_y + i);
    hn::StoreU(Narrow<Real>(pz), dn, surfaces.position_z + i);
    const auto facing = [&](auto n) HWY_ATTR {
      return Narrow<Real>(hn::IfThenElse(leaves_wide, hn::Neg(n), n));
    };
    hn::StoreU(facing(nx), dn, surfaces.normal_x + i);
    hn::StoreU(facing(ny), dn, surfaces.normal_y + i);
    hn::StoreU(facing(nz), dn, surfaces.normal_z + i);
    hn::StoreU(direction_x, dn, surfaces.direction_x + i);
    hn::StoreU(direction_y, dn, surfaces.direction_y + i);
    hn::StoreU(direction_z, dn, surfaces.direction_z + i);
    if (needs & kNeedsCoordinates) {
      hn::StoreU(hn::Zero(dn), dn, surfaces.u + i);
      hn::StoreU(hn::Zero(dn), dn, surfaces.v + i);
    }
    hn::StoreU(Narrow<Real>(hn::Add(position_error, term_error)), dn, surfaces.offset + i);
    const auto inside = hn::Set(di, hn::TFromD<decltype(di)>{kInsideBit});
    const auto id = LoadIds(dn, batch.primitive + i);
    StoreIds(dn, hn::Or(id, hn::IfThenElseZero(hn::RebindMask(di, leaves), inside)),
             surfaces.source + i);
    StoreIds(dn, ray, surfaces.ray + i);
  }
}
SHEAF_NAME_KERNELS(SphereSurfaces);

}  // namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sheaf::SHEAF_SIMD {

SHEAF_EXPORT(SphereSurfaces);

template <typename Real>
void SphereSurfaces(const SphereArrays<Real>& spheres, const RayView<Real>& rays,
                    const HitView<Real>& hits, const HitBatch& batch, std::uint32_t needs,
                    const SurfaceOutput<Real>& surfaces) {
  SHEAF_DISPATCH(Real, SphereSurfaces)(spheres, rays, hits, batch, needs, surfaces);
}
SHEAF_INSTANTIATE(SphereSurfaces);

}  // namespace sheaf::SHEAF_SIMD
#endif  // HWY_ONCE
