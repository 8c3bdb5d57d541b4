#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simd/disk_surface.cc"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "hwy/highway.h"
#include "simd/disk-inl.h"
#include "simd/dispatch.h"
#include "simd/math-inl.h"
#include "simd/query.h"
#include "simd/roundoffs.h"
#include "simd/surfaces.h"

HWY_BEFORE_NAMESPACE();
namespace sheaf::simd::HWY_NAMESPACE {

template <typename Real>
void DiskSurfacesLanes(const GeometryView<Real>& geometry, const RayView<Real>& rays,
                       const HitView<Real>& hits, const HitBatch& batch, std::uint32_t needs,
                       const SurfaceOutput<Real>& surfaces) {
  const DiskArrays<Real>& disks = geometry.disks;
  const WideLanes<Real> dw;
  const NarrowLanes<Real> dn;
  const IdLanes<NarrowLanes<Real>> di;
  using W = hn::Vec<WideLanes<Real>>;
  using Wide = hn::TFromD<WideLanes<Real>>;
  for (std::uint32_t i = 0; i < batch.count; i += LaneCount(dn)) {
    // Lanes past the count gather element 0.
    const auto lanes = hn::RebindMask(di, LanesBelow(dn, i, batch.count));
    const auto ray = hn::IfThenElseZero(lanes, LoadIds(dn, batch.ray + i));
    const auto index = hn::IfThenElseZero(lanes, LoadIds(dn, batch.index + i));
    const auto of_ray = [&](const Real* array) HWY_ATTR { return GatherAt(dn, array, ray); };
    const auto wide = [&](const Real* array) HWY_ATTR { return Widen(GatherAt(dn, array, index)); };
    const auto direction_x = of_ray(rays.direction_x);
    const auto direction_y = of_ray(rays.direction_y);
    const auto direction_z = of_ray(rays.direction_z);
    const W ox = Widen(of_ray(rays.origin_x)), oy = Widen(of_ray(rays.origin_y)),
            oz = Widen(of_ray(rays.origin_z));
    const W dx = Widen(direction_x), dy = Widen(direction_y), dz = Widen(direction_z);
    const W cx = wide(disks.center_x), cy = wide(disks.center_y), cz = wide(disks.center_z);
    W nx = wide(disks.normal_x), ny = wide(disks.normal_y), nz = wide(disks.normal_z);
    const W t = PlaneT(dw, ox, oy, oz, dx, dy, dz, cx, cy, cz, nx, ny, nz);
    NormalizeWide(dw, nx, ny, nz);
    const auto inside_wide = hn::Gt(Dot(dw, nx, ny, nz, dx, dy, dz), hn::Zero(dw));
    const W mx = hn::Add(hn::Sub(ox, cx), hn::Mul(dx, t));
    const W my = hn::Add(hn::Sub(oy, cy), hn::Mul(dy, t));
    const W mz = hn::Add(hn::Sub(oz, cz), hn::Mul(dz, t));
    const W off = Dot(dw, nx, ny, nz, mx, my, mz);
    const W px = hn::Add(cx, hn::Sub(mx, hn::Mul(nx, off)));
    const W py = hn::Add(cy, hn::Sub(my, hn::Mul(ny, off)));
    const W pz = hn::Add(cz, hn::Sub(mz, hn::Mul(nz, off)));
    const W r = wide(disks.radius);
    const W position_error = hn::Mul(hn::Set(dw, static_cast<Wide>(kPositionRoundoffs<Real>)),
                                     AbsDot(dw, nx, ny, nz, px, py, pz));
    const W term_error = hn::Mul(hn::Set(dw, kTermRoundoffs<Wide>),
                                 AbsDot(dw, nx, ny, nz, hn::Add(hn::Abs(cx), r),
                                        hn::Add(hn::Abs(cy), r), hn::Add(hn::Abs(cz), r)));

    const auto store = [&](W v, Real* HWY_RESTRICT field)
                           HWY_ATTR { hn::StoreU(Narrow<Real>(v), dn, field + i); };
    const auto facing = [&](W n) HWY_ATTR { return hn::IfThenElse(inside_wide, hn::Neg(n), n); };
    store(px, surfaces.position_x);
    store(py, surfaces.position_y);
    store(pz, surfaces.position_z);
    store(facing(nx), surfaces.normal_x);
    store(facing(ny), surfaces.normal_y);
    store(facing(nz), surfaces.normal_z);
    hn::StoreU(direction_x, dn, surfaces.direction_x + i);
    hn::StoreU(direction_y, dn, surfaces.direction_y + i);
    hn::StoreU(direction_z, dn, surfaces.direction_z + i);
    if (needs & kNeedsCoordinates) {
      hn::StoreU(of_ray(hits.u), dn, surfaces.u + i);
      hn::StoreU(of_ray(hits.v), dn, surfaces.v + i);
    }
    store(hn::Add(position_error, term_error), surfaces.offset);
    const auto inside =
        hn::Ne(Narrow<Real>(hn::IfThenElseZero(inside_wide, hn::Set(dw, Wide(1)))), hn::Zero(dn));
    const auto bit = hn::Set(di, hn::TFromD<decltype(di)>{kInsideBit});
    const auto id = LoadIds(dn, batch.primitive + i);
    StoreIds(dn, hn::Or(id, hn::IfThenElseZero(hn::RebindMask(di, inside), bit)),
             surfaces.source + i);
    StoreIds(dn, ray, surfaces.ray + i);
  }
}
SHEAF_NAME_KERNELS(DiskSurfaces);

}  // namespace sheaf::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sheaf::simd {
SHEAF_EXPORT(DiskSurfaces);
}  // namespace sheaf::simd
#endif  // HWY_ONCE
