#include "simd/generate_primary.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simd/generate_primary.cc"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "hwy/highway.h"
#include "simd/dispatch.h"
#include "simd/math-inl.h"
#include "simd/sin_cos-inl.h"
#include "simd/warp-inl.h"

HWY_BEFORE_NAMESPACE();
namespace sheaf::simd::HWY_NAMESPACE {

// Moves the origins to points of the lens, and turns the rays to where the others are sharp.
template <class D, class V = hn::Vec<D>, typename Real = hn::TFromD<D>>
HWY_INLINE void LookThroughLens(D d, const CameraData<Real>& camera, V u, V v, V& ox, V& oy, V& oz,
                                V& dx, V& dy, V& dz) {
  V a, b;
  if (camera.blades > 0) {
    PolygonPoint(d, camera.blades, camera.blade_turn, u, v, a, b);
  } else {
    DiskPoint(d, u, v, a, b);
  }
  const V ahead = Dot(d, dx, dy, dz, hn::Set(d, camera.forward[0]), hn::Set(d, camera.forward[1]),
                      hn::Set(d, camera.forward[2]));
  const V nearness = hn::Div(ahead, hn::Set(d, camera.focus));
  const auto move = [&](int axis, V& origin, V& direction) SHEAF_LAMBDA {
    const V aside = hn::Add(hn::Mul(hn::Set(d, camera.lens_right[axis]), a),
                            hn::Mul(hn::Set(d, camera.lens_up[axis]), b));
    direction = hn::Sub(direction, hn::Mul(aside, nearness));
    origin = hn::Add(origin, aside);
  };
  move(0, ox, dx);
  move(1, oy, dy);
  move(2, oz, dz);
  Normalize(d, dx, dy, dz);
}

template <typename Real>
void GeneratePrimaryLanes(const CameraData<Real>& camera, const Real* x, const Real* y, Real sx,
                          Real sy, const SampleView<Real>& lens, std::uint32_t count,
                          const RayOutput<Real>& rays) {
  const Lanes<Real> d;
  using V = hn::Vec<Lanes<Real>>;
  for (std::uint32_t i = 0; i < count; i += LaneCount(d)) {
    const V a =
        hn::Sub(hn::Add(hn::LoadU(d, x + i), hn::Set(d, sx)), hn::Set(d, camera.half_width));
    const V b =
        hn::Sub(hn::Set(d, camera.half_height), hn::Add(hn::LoadU(d, y + i), hn::Set(d, sy)));
    const auto across = [&](int axis) HWY_ATTR {
      return hn::Add(hn::Mul(hn::Set(d, camera.right[axis]), a),
                     hn::Mul(hn::Set(d, camera.up[axis]), b));
    };
    V ox = hn::Set(d, camera.eye[0]), oy = hn::Set(d, camera.eye[1]),
      oz = hn::Set(d, camera.eye[2]);
    V dx = hn::Set(d, camera.forward[0]), dy = hn::Set(d, camera.forward[1]),
      dz = hn::Set(d, camera.forward[2]);
    switch (camera.model) {
      case CameraModel::kPerspective:
        dx = hn::Add(dx, across(0));
        dy = hn::Add(dy, across(1));
        dz = hn::Add(dz, across(2));
        Normalize(d, dx, dy, dz);
        break;
      case CameraModel::kOrthographic:
        ox = hn::Add(ox, across(0));
        oy = hn::Add(oy, across(1));
        oz = hn::Add(oz, across(2));
        break;
      case CameraModel::kEquirectangular: {
        V sin_x, cos_x, sin_y, cos_y;
        SinCos(d, hn::Mul(a, hn::Set(d, camera.turns_x)), sin_x, cos_x);
        SinCos(d, hn::Mul(b, hn::Set(d, camera.turns_y)), sin_y, cos_y);
        const auto toward = [&](V forward, int axis) SHEAF_LAMBDA {
          const V level =
              hn::Add(hn::Mul(forward, cos_x), hn::Mul(hn::Set(d, camera.right[axis]), sin_x));
          return hn::Add(hn::Mul(level, cos_y), hn::Mul(hn::Set(d, camera.up[axis]), sin_y));
        };
        dx = toward(dx, 0);
        dy = toward(dy, 1);
        dz = toward(dz, 2);
        Normalize(d, dx, dy, dz);
        break;
      }
      case CameraModel::kFisheye: {
        const V distance = hn::Sqrt(hn::Add(hn::Mul(a, a), hn::Mul(b, b)));
        V sin, cos;
        SinCos(d, hn::Mul(distance, hn::Set(d, camera.turns_y)), sin, cos);
        const V zero = hn::Zero(d);
        const V scale = hn::IfThenElse(hn::Gt(distance, zero), hn::Div(sin, distance), zero);
        dx = hn::Add(hn::Mul(dx, cos), hn::Mul(across(0), scale));
        dy = hn::Add(hn::Mul(dy, cos), hn::Mul(across(1), scale));
        dz = hn::Add(hn::Mul(dz, cos), hn::Mul(across(2), scale));
        Normalize(d, dx, dy, dz);
        break;
      }
    }
    if (camera.lens != LensUse::kNone) {
      LookThroughLens(d, camera, hn::LoadU(d, lens.u + i), hn::LoadU(d, lens.v + i), ox, oy, oz, dx,
                      dy, dz);
    }
    hn::StoreU(ox, d, rays.origin_x + i);
    hn::StoreU(oy, d, rays.origin_y + i);
    hn::StoreU(oz, d, rays.origin_z + i);
    hn::StoreU(dx, d, rays.direction_x + i);
    hn::StoreU(dy, d, rays.direction_y + i);
    hn::StoreU(dz, d, rays.direction_z + i);
  }
}
SHEAF_NAME_KERNELS(GeneratePrimary);

}  // namespace sheaf::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sheaf::simd {
SHEAF_EXPORT(GeneratePrimary);
}  // namespace sheaf::simd
#endif  // HWY_ONCE
