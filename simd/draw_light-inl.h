// Points drawn on lights that have a size, as surfaces see them: src/scalar/incidence.h.
#if defined(SHEAF_SIMD_DRAW_LIGHT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SHEAF_SIMD_DRAW_LIGHT_INL_H_
#undef SHEAF_SIMD_DRAW_LIGHT_INL_H_
#else
#define SHEAF_SIMD_DRAW_LIGHT_INL_H_
#endif

#include <limits>

#include "simd/frame-inl.h"
#include "simd/shading.h"
#include "simd/streams.h"
#include "simd/warp-inl.h"

HWY_BEFORE_NAMESPACE();
namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE {

template <class D, class V>
HWY_INLINE hn::Mask<D> IsNormalSquare(D d, V squared) {
  return hn::Ge(squared, hn::Set(d, std::numeric_limits<hn::TFromD<D>>::min()));
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE V SqrtOfPositive(D d, V x) {
  return hn::Sqrt(hn::IfThenElseZero(hn::Gt(x, hn::Zero(d)), x));
}

// LookAtFlat. Leaves the point in (ex, ey, ez) and the unit vector to it in (lx, ly, lz); returns
// which lanes get light.
template <class D, class V = hn::Vec<D>, typename Real = hn::TFromD<D>>
HWY_INLINE hn::Mask<D> LookAtFlat(D d, const LightData<Real>& light,
                                  const SurfaceView<Real>& surfaces, std::uint32_t i, V u, V v,
                                  V& lx, V& ly, V& lz, V& ex, V& ey, V& ez, V& falloff) {
  V a = hn::Sub(u, hn::Set(d, Real(0.5))), b = hn::Sub(v, hn::Set(d, Real(0.5)));
  if (light.shape == LightShape::kDisk) {
    DiskPoint(d, u, v, a, b);
  }
  const auto end = [&](int axis) SHEAF_LAMBDA {
    const V across = hn::Add(hn::Mul(hn::Set(d, light.across_u[axis]), a),
                             hn::Mul(hn::Set(d, light.across_v[axis]), b));
    return hn::Add(hn::Set(d, light.vector[axis]), across);
  };
  ex = end(0);
  ey = end(1);
  ez = end(2);
  lx = hn::Sub(ex, hn::LoadU(d, surfaces.position_x + i));
  ly = hn::Sub(ey, hn::LoadU(d, surfaces.position_y + i));
  lz = hn::Sub(ez, hn::LoadU(d, surfaces.position_z + i));
  const V squared = Dot(d, lx, ly, lz, lx, ly, lz);
  const V distance = hn::Sqrt(squared);
  lx = hn::Div(lx, distance);
  ly = hn::Div(ly, distance);
  lz = hn::Div(lz, distance);
  const V cosine = hn::Neg(Dot(d, lx, ly, lz, hn::Set(d, light.axis[0]), hn::Set(d, light.axis[1]),
                               hn::Set(d, light.axis[2])));
  falloff = hn::Div(squared, cosine);
  return hn::And(IsNormalSquare(d, squared), hn::Gt(cosine, hn::Zero(d)));
}

// LookAtSphere, as LookAtFlat.
template <class D, class V = hn::Vec<D>, typename Real = hn::TFromD<D>>
HWY_INLINE hn::Mask<D> LookAtSphere(D d, const LightData<Real>& light,
                                    const SurfaceView<Real>& surfaces, std::uint32_t i, V u, V v,
                                    V& lx, V& ly, V& lz, V& ex, V& ey, V& ez, V& falloff) {
  const V one = hn::Set(d, Real(1)), zero = hn::Zero(d);
  const V px = hn::LoadU(d, surfaces.position_x + i);
  const V py = hn::LoadU(d, surfaces.position_y + i);
  const V pz = hn::LoadU(d, surfaces.position_z + i);
  V ax = hn::Sub(hn::Set(d, light.vector[0]), px);
  V ay = hn::Sub(hn::Set(d, light.vector[1]), py);
  V az = hn::Sub(hn::Set(d, light.vector[2]), pz);
  const V squared = Dot(d, ax, ay, az, ax, ay, az), distance = hn::Sqrt(squared);
  ax = hn::Div(ax, distance);
  ay = hn::Div(ay, distance);
  az = hn::Div(az, distance);
  const V square_radius = hn::Set(d, light.extent * light.extent);
  const V sine2 = hn::Div(square_radius, squared);
  const V rest = hn::Sub(one, sine2);
  const V half_cosine = SqrtOfPositive(d, rest);
  V xx, xy, xz, yx, yy, yz, cosine, sine;
  MakeFrame(d, ax, ay, az, xx, xy, xz, yx, yy, yz);
  DrawInCone(d, ax, ay, az, xx, xy, xz, yx, yy, yz, hn::Div(sine2, hn::Add(one, half_cosine)), u, v,
             lx, ly, lz, cosine, sine);
  const V beside = hn::Mul(distance, sine);
  const V depth = SqrtOfPositive(d, hn::Sub(square_radius, hn::Mul(beside, beside)));
  const V length = hn::Sub(hn::Mul(distance, cosine), depth);
  ex = hn::Add(px, hn::Mul(lx, length));
  ey = hn::Add(py, hn::Mul(ly, length));
  ez = hn::Add(pz, hn::Mul(lz, length));
  falloff = hn::Mul(hn::Mul(squared, hn::Add(one, half_cosine)), hn::Set(d, Real(0.5)));
  return hn::And(IsNormalSquare(d, squared), hn::Gt(rest, zero));
}

// LookAtSun, whose point is the direction.
template <class D, class V = hn::Vec<D>, typename Real = hn::TFromD<D>>
HWY_INLINE void LookAtSun(D d, const LightData<Real>& light, V u, V v, V& lx, V& ly, V& lz,
                          V& falloff) {
  const auto all = [&](Real number) SHEAF_LAMBDA { return hn::Set(d, number); };
  V cosine, sine;
  DrawInCone(d, all(light.vector[0]), all(light.vector[1]), all(light.vector[2]),
             all(light.across_u[0]), all(light.across_u[1]), all(light.across_u[2]),
             all(light.across_v[0]), all(light.across_v[1]), all(light.across_v[2]),
             all(light.extent), u, v, lx, ly, lz, cosine, sine);
  falloff = hn::Set(d, Real(1));
}

// IncidenceOf with LookAt, for lights that have a size: the unit vector to the point drawn, its
// cosine with the normal (0 where there is no light) and what the light is divided by. Stores the
// points.
template <class D, class V = hn::Vec<D>, typename Real = hn::TFromD<D>>
HWY_INLINE void DrawIncidence(D d, const LightData<Real>& light, const SurfaceView<Real>& surfaces,
                              const SampleView<Real>& points, std::uint32_t i, V& lx, V& ly, V& lz,
                              V& n_dot_l, V& falloff, const IncidenceOutput<Real>& incidence) {
  const V u = hn::LoadU(d, points.u + i), v = hn::LoadU(d, points.v + i);
  V ex = hn::Zero(d), ey = ex, ez = ex;
  auto is_light = AllLanes(d);
  if (light.shape == LightShape::kSun) {
    LookAtSun(d, light, u, v, lx, ly, lz, falloff);
    ex = lx, ey = ly, ez = lz;
  } else if (light.shape == LightShape::kSphere) {
    is_light = LookAtSphere(d, light, surfaces, i, u, v, lx, ly, lz, ex, ey, ez, falloff);
  } else {
    is_light = LookAtFlat(d, light, surfaces, i, u, v, lx, ly, lz, ex, ey, ez, falloff);
  }
  const V cosine = Dot(d, hn::LoadU(d, surfaces.normal_x + i), hn::LoadU(d, surfaces.normal_y + i),
                       hn::LoadU(d, surfaces.normal_z + i), lx, ly, lz);
  n_dot_l = hn::IfThenElseZero(is_light, cosine);
  hn::StoreU(ex, d, incidence.end_x + i);
  hn::StoreU(ey, d, incidence.end_y + i);
  hn::StoreU(ez, d, incidence.end_z + i);
}

}  // namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // SHEAF_SIMD_DRAW_LIGHT_INL_H_
