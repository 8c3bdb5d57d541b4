#include "simd/find_footprints.h"

#include <numbers>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simd/find_footprints.cc"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "hwy/highway.h"
#include "simd/dispatch.h"
#include "simd/frame-inl.h"
#include "simd/math-inl.h"
#include "simd/query.h"

HWY_BEFORE_NAMESPACE();
namespace sheaf::simd::HWY_NAMESPACE {

// Each calls put(slope of u, slope of v, facing), vectors by their coordinates: CoordinateSlopes of
// src/scalar/footprint.h.

// `fetch(array)` loads a triangle's number a lane.
template <class D, class V = hn::Vec<D>, typename Real = hn::TFromD<D>, typename Fetch,
          typename Put>
HWY_INLINE void SlopesOnTriangles(D d, const TriangleArrays<Real>& triangles, const Fetch& fetch,
                                  V dx, V dy, V dz, const Put& put) {
  const auto edge = [&](int vertex, int axis) SHEAF_LAMBDA {
    return hn::Sub(fetch(triangles.vertex[vertex][axis]), fetch(triangles.vertex[0][axis]));
  };
  const V ax = edge(1, 0), ay = edge(1, 1), az = edge(1, 2);
  const V bx = edge(2, 0), by = edge(2, 1), bz = edge(2, 2);
  const auto rise = [&](int vertex, int axis) SHEAF_LAMBDA {
    return hn::Sub(fetch(triangles.uv[vertex][axis]), fetch(triangles.uv[0][axis]));
  };
  const V u1 = rise(1, 0), u2 = rise(2, 0), v1 = rise(1, 1), v2 = rise(2, 1);
  const auto slope = [&](V a, V b, V first, V second)
                         SHEAF_LAMBDA { return hn::Sub(hn::Mul(b, first), hn::Mul(a, second)); };
  const V facing =
      Dot(d, hn::Sub(hn::Mul(ay, bz), hn::Mul(az, by)), hn::Sub(hn::Mul(az, bx), hn::Mul(ax, bz)),
          hn::Sub(hn::Mul(ax, by), hn::Mul(ay, bx)), dx, dy, dz);
  put(slope(ax, bx, u1, u2), slope(ay, by, u1, u2), slope(az, bz, u1, u2), slope(ax, bx, v1, v2),
      slope(ay, by, v1, v2), slope(az, bz, v1, v2), facing);
}

template <class D, class V = hn::Vec<D>, typename Real = hn::TFromD<D>, typename Put>
HWY_INLINE void SlopesOnSpheres(D d, V radius, V nx, V ny, V nz, V facing, const Put& put) {
  const V square = hn::Add(hn::Mul(nx, nx), hn::Mul(nz, nz));
  const V around = hn::Mul(hn::Set(d, 2 * std::numbers::pi_v<Real>), radius);
  const V to_u = hn::Div(hn::Set(d, Real(1)), hn::Mul(around, square));
  const V to_v = hn::Div(hn::Set(d, Real(2)), hn::Mul(around, hn::Sqrt(square)));
  put(hn::Mul(hn::Neg(hn::Mul(nx, ny)), to_u), hn::Mul(square, to_u),
      hn::Mul(hn::Neg(hn::Mul(nz, ny)), to_u), hn::Mul(nz, to_v), hn::Zero(d),
      hn::Mul(hn::Neg(nx), to_v), facing);
}

// (nx, ny, nz) are the normals of the disks' fronts.
template <class D, class V = hn::Vec<D>, typename Real = hn::TFromD<D>, typename Put>
HWY_INLINE void SlopesOnDisks(D d, V radius, V nx, V ny, V nz, V facing, const Put& put) {
  V xx, xy, xz, yx, yy, yz;
  MakeFrame(d, nx, ny, nz, xx, xy, xz, yx, yy, yz);
  const V scale = hn::Div(hn::Set(d, Real(0.5)), radius);
  put(hn::Mul(yx, scale), hn::Mul(yy, scale), hn::Mul(yz, scale), hn::Mul(xx, scale),
      hn::Mul(xy, scale), hn::Mul(xz, scale), facing);
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE V ExtentAlong(D d, V sx, V sy, V sz, V facing, V dx, V dy, V dz, V width) {
  const V x = hn::Sub(hn::Mul(sy, dz), hn::Mul(sz, dy));
  const V y = hn::Sub(hn::Mul(sz, dx), hn::Mul(sx, dz));
  const V z = hn::Sub(hn::Mul(sx, dy), hn::Mul(sy, dx));
  return hn::Div(hn::Mul(width, hn::Sqrt(Dot(d, x, y, z, x, y, z))), hn::Abs(facing));
}

template <typename Real>
void FindFootprintsLanes(const GeometryView<Real>& geometry, PrimitiveKind kind,
                         const ConeView<Real>& cones, const HitView<Real>& hits,
                         const HitBatch& batch, std::uint32_t needs,
                         const SurfaceView<Real>& surfaces, const SurfaceOutput<Real>& footprints) {
  const Lanes<Real> d;
  const IdLanes<Lanes<Real>> di;
  using V = hn::Vec<Lanes<Real>>;
  const bool is_triangle = kind == PrimitiveKind::kTriangle;
  const bool measures =
      (needs & kNeedsFootprint) != 0 && !(is_triangle && !geometry.triangles.uv[0][0]);
  for (std::uint32_t i = 0; i < batch.count; i += LaneCount(d)) {
    // Lanes past the count gather element 0.
    const std::uint32_t wanted = batch.count - i;
    const auto lanes = hn::RebindMask(di, LanesBelow(d, i, batch.count));
    const auto ray = hn::IfThenElseZero(lanes, LoadIds(d, batch.ray + i));
    const auto index = hn::IfThenElseZero(lanes, LoadIds(d, batch.index + i));
    const IdPattern ray_pattern = PatternOf(batch.ray + i, LaneCount(d), wanted);
    const IdPattern index_pattern = PatternOf(batch.index + i, LaneCount(d), wanted);
    const auto of_ray = [&](const Real* array) SHEAF_LAMBDA {
      return Fetch(d, ray_pattern, array, batch.ray[i], ray);
    };
    const auto of_primitive = [&](const Real* array) SHEAF_LAMBDA {
      return Fetch(d, index_pattern, array, batch.index[i], index);
    };
    const V start = cones.width ? of_ray(cones.width) : hn::Set(d, cones.all_width);
    const V width = hn::Add(start, hn::Mul(hn::Set(d, cones.spread), of_ray(hits.t)));
    hn::StoreU(width, d, footprints.width + i);
    if (!measures) continue;

    const V dx = hn::LoadU(d, surfaces.direction_x + i),
            dy = hn::LoadU(d, surfaces.direction_y + i),
            dz = hn::LoadU(d, surfaces.direction_z + i);
    const auto put = [&](V ux, V uy, V uz, V vx, V vy, V vz, V facing) SHEAF_LAMBDA {
      const V along_u = ExtentAlong(d, ux, uy, uz, facing, dx, dy, dz, width);
      const V along_v = ExtentAlong(d, vx, vy, vz, facing, dx, dy, dz, width);
      hn::StoreU(along_u, d, footprints.footprint_u + i);
      hn::StoreU(along_v, d, footprints.footprint_v + i);
    };
    if (is_triangle) {
      SlopesOnTriangles(d, geometry.triangles, of_primitive, dx, dy, dz, put);
      continue;
    }
    V nx = hn::LoadU(d, surfaces.face_x + i), ny = hn::LoadU(d, surfaces.face_y + i),
      nz = hn::LoadU(d, surfaces.face_z + i);
    if (kind == PrimitiveKind::kSphere) {
      const V facing = Dot(d, nx, ny, nz, dx, dy, dz);
      SlopesOnSpheres(d, of_primitive(geometry.spheres.radius), nx, ny, nz, facing, put);
      continue;
    }
    const auto bit = hn::Set(di, hn::TFromD<decltype(di)>{kInsideBit});
    const auto inside =
        hn::RebindMask(d, hn::Ne(hn::And(LoadIds(d, surfaces.source + i), bit), hn::Zero(di)));
    nx = hn::IfThenElse(inside, hn::Neg(nx), nx);
    ny = hn::IfThenElse(inside, hn::Neg(ny), ny);
    nz = hn::IfThenElse(inside, hn::Neg(nz), nz);
    const V facing = Dot(d, nx, ny, nz, dx, dy, dz);
    SlopesOnDisks(d, of_primitive(geometry.disks.radius), nx, ny, nz, facing, put);
  }
}
SHEAF_NAME_KERNELS(FindFootprints);

}  // namespace sheaf::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sheaf::simd {
SHEAF_EXPORT(FindFootprints);
}  // namespace sheaf::simd
#endif  // HWY_ONCE
