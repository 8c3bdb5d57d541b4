#include "simd/surfaces.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simd/triangle_surface.cc"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "hwy/highway.h"
#include "simd/dispatch.h"
#include "simd/math-inl.h"
#include "simd/query.h"
#include "simd/roundoffs.h"

HWY_BEFORE_NAMESPACE();
namespace sheaf::simd::HWY_NAMESPACE {

template <typename Real>
void TriangleSurfacesLanes(const GeometryView<Real>& geometry, const RayView<Real>& rays,
                           const HitView<Real>& hits, const HitBatch& batch, std::uint32_t needs,
                           const SurfaceOutput<Real>& surfaces) {
  const TriangleArrays<Real>& triangles = geometry.triangles;
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
    const std::uint32_t wanted = batch.count - i;
    const IdPattern ray_pattern = PatternOf(batch.ray + i, LaneCount(dn), wanted);
    const IdPattern index_pattern = PatternOf(batch.index + i, LaneCount(dn), wanted);
    const auto of_ray = [&](const Real* array)
                            HWY_ATTR { return Fetch(dn, ray_pattern, array, batch.ray[i], ray); };
    const auto of_primitive = [&](const Real* array) HWY_ATTR {
      return Fetch(dn, index_pattern, array, batch.index[i], index);
    };
    const auto direction_x = of_ray(rays.direction_x);
    const auto direction_y = of_ray(rays.direction_y);
    const auto direction_z = of_ray(rays.direction_z);
    const W w1 = Widen(of_ray(hits.u)), w2 = Widen(of_ray(hits.v));
    const W w0 = hn::Sub(hn::Sub(hn::Set(dw, Wide(1)), w1), w2);
    const auto mean = [&](W a, W b, W c) HWY_ATTR {
      return hn::Add(hn::Add(hn::Mul(a, w0), hn::Mul(b, w1)), hn::Mul(c, w2));
    };
    const auto vertex = [&](int number, int axis) HWY_ATTR {
      return Widen(of_primitive(triangles.vertex[number][axis]));
    };
    const W ax = vertex(0, 0), ay = vertex(0, 1), az = vertex(0, 2);
    const W bx = vertex(1, 0), by = vertex(1, 1), bz = vertex(1, 2);
    const W cx = vertex(2, 0), cy = vertex(2, 1), cz = vertex(2, 2);

    const W ex = hn::Sub(bx, ax), ey = hn::Sub(by, ay), ez = hn::Sub(bz, az);
    const W gx = hn::Sub(cx, ax), gy = hn::Sub(cy, ay), gz = hn::Sub(cz, az);
    W nx = hn::Sub(hn::Mul(ey, gz), hn::Mul(ez, gy));
    W ny = hn::Sub(hn::Mul(ez, gx), hn::Mul(ex, gz));
    W nz = hn::Sub(hn::Mul(ex, gy), hn::Mul(ey, gx));
    NormalizeWide(dw, nx, ny, nz);
    const W ox = Widen(of_ray(rays.origin_x)), oy = Widen(of_ray(rays.origin_y)),
            oz = Widen(of_ray(rays.origin_z));
    const W dx = Widen(direction_x), dy = Widen(direction_y), dz = Widen(direction_z);
    const W slope = Dot(dw, nx, ny, nz, dx, dy, dz);
    const W t =
        hn::Div(Dot(dw, nx, ny, nz, hn::Sub(ax, ox), hn::Sub(ay, oy), hn::Sub(az, oz)), slope);
    const auto inside_wide = hn::Gt(slope, hn::Zero(dw));
    const auto is_steep =
        hn::Gt(hn::Mul(slope, slope),
               hn::Mul(hn::Set(dw, kFlatSquare<Real, Wide>),
                       hn::Mul(Dot(dw, nx, ny, nz, nx, ny, nz), Dot(dw, dx, dy, dz, dx, dy, dz))));
    const auto position = [&](W o, W d, W a, W b, W c) HWY_ATTR {
      return hn::IfThenElse(is_steep, hn::Add(o, hn::Mul(d, t)), mean(a, b, c));
    };
    const W px = position(ox, dx, ax, bx, cx), py = position(oy, dy, ay, by, cy),
            pz = position(oz, dz, az, bz, cz);
    const auto sum_of_sizes = [&](W a, W b, W c, W o) HWY_ATTR {
      return hn::Add(hn::Add(hn::Add(hn::Abs(a), hn::Abs(b)), hn::Abs(c)), hn::Abs(o));
    };
    const W position_error = hn::Mul(hn::Set(dw, static_cast<Wide>(kFoldRoundoffs<Real>)),
                                     AbsDot(dw, nx, ny, nz, px, py, pz));
    const W term_error =
        hn::Mul(hn::Set(dw, kTermRoundoffs<Wide>),
                AbsDot(dw, nx, ny, nz, sum_of_sizes(ax, bx, cx, ox), sum_of_sizes(ay, by, cy, oy),
                       sum_of_sizes(az, bz, cz, oz)));
    const W error = hn::Add(position_error, term_error);

    hn::StoreU(Narrow<Real>(px), dn, surfaces.position_x + i);
    hn::StoreU(Narrow<Real>(py), dn, surfaces.position_y + i);
    hn::StoreU(Narrow<Real>(pz), dn, surfaces.position_z + i);
    const auto facing = [&](W n) HWY_ATTR {
      return Narrow<Real>(hn::IfThenElse(inside_wide, hn::Neg(n), n));
    };
    hn::StoreU(facing(nx), dn, surfaces.normal_x + i);
    hn::StoreU(facing(ny), dn, surfaces.normal_y + i);
    hn::StoreU(facing(nz), dn, surfaces.normal_z + i);
    hn::StoreU(direction_x, dn, surfaces.direction_x + i);
    hn::StoreU(direction_y, dn, surfaces.direction_y + i);
    hn::StoreU(direction_z, dn, surfaces.direction_z + i);
    const auto surface_coordinate = [&](int axis) HWY_ATTR {
      const auto at = [&](int number)
                          HWY_ATTR { return Widen(of_primitive(triangles.uv[number][axis])); };
      return Narrow<Real>(mean(at(0), at(1), at(2)));
    };
    if ((needs & kNeedsCoordinates) && triangles.uv[0][0]) {
      hn::StoreU(surface_coordinate(0), dn, surfaces.u + i);
      hn::StoreU(surface_coordinate(1), dn, surfaces.v + i);
    }
    hn::StoreU(Narrow<Real>(error), dn, surfaces.offset + i);
    const auto inside =
        hn::Ne(Narrow<Real>(hn::IfThenElseZero(inside_wide, hn::Set(dw, Wide(1)))), hn::Zero(dn));
    const auto bit = hn::Set(di, hn::TFromD<decltype(di)>{kInsideBit});
    const auto id = LoadIds(dn, batch.primitive + i);
    StoreIds(dn, hn::Or(id, hn::IfThenElseZero(hn::RebindMask(di, inside), bit)),
             surfaces.source + i);
    StoreIds(dn, ray, surfaces.ray + i);
  }
}
SHEAF_NAME_KERNELS(TriangleSurfaces);

}  // namespace sheaf::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sheaf::simd {
SHEAF_EXPORT(TriangleSurfaces);
}  // namespace sheaf::simd
#endif  // HWY_ONCE
