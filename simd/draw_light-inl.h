// Points drawn on lights that have a size, as surfaces see them: src/scalar/incidence.h.
#if defined(SHEAF_SIMD_DRAW_LIGHT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SHEAF_SIMD_DRAW_LIGHT_INL_H_
#undef SHEAF_SIMD_DRAW_LIGHT_INL_H_
#else
#define SHEAF_SIMD_DRAW_LIGHT_INL_H_
#endif

#include <limits>

#include "simd/frame-inl.h"
#include "simd/roundoffs.h"
#include "simd/sample_terms.h"
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
  Normalize(d, lx, ly, lz);
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
  Normalize(d, ax, ay, az);
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

// LookAtEmitters, as LookAtFlat, with the density of the points and their colours.
template <class D, class V = hn::Vec<D>, typename Real = hn::TFromD<D>>
HWY_INLINE hn::Mask<D> LookAtEmitters(D d, const EmitterView<Real>& emitters,
                                      const SurfaceView<Real>& surfaces, std::uint32_t i, V u, V v,
                                      V& lx, V& ly, V& lz, V& ex, V& ey, V& ez, V& falloff,
                                      V& density, const IncidenceOutput<Real>& incidence) {
  const hn::RebindToSigned<D> ds;
  const V one = hn::Set(d, Real(1));
  const V last = hn::Set(d, static_cast<Real>(emitters.count - 1));
  const V along = hn::Mul(u, hn::Set(d, static_cast<Real>(emitters.count)));
  const V floor = hn::Floor(along);
  const V cell = hn::IfThenElse(hn::Lt(floor, last), floor, last);
  const auto in_cell = hn::ConvertTo(ds, cell);
  const V part = hn::Sub(along, cell), threshold = GatherAt(d, emitters.threshold, in_cell);
  const auto is_own = hn::Lt(part, threshold);
  const V number = hn::IfThenElse(is_own, cell, GatherAt(d, emitters.alias, in_cell));
  const V above = hn::Div(hn::Sub(part, threshold), hn::Sub(one, threshold));
  const V rest = hn::IfThenElse(is_own, hn::Div(part, threshold), above);
  const auto at = hn::ConvertTo(ds, number);
  const V side = hn::Sqrt(rest), second = hn::Mul(side, v), first = hn::Sub(side, second);
  const auto drawn = [&](int axis) SHEAF_LAMBDA {
    const V across = hn::Add(hn::Mul(GatherAt(d, emitters.edge1[axis], at), first),
                             hn::Mul(GatherAt(d, emitters.edge2[axis], at), second));
    return hn::Add(GatherAt(d, emitters.corner[axis], at), across);
  };
  ex = drawn(0);
  ey = drawn(1);
  ez = drawn(2);
  lx = hn::Sub(ex, hn::LoadU(d, surfaces.position_x + i));
  ly = hn::Sub(ey, hn::LoadU(d, surfaces.position_y + i));
  lz = hn::Sub(ez, hn::LoadU(d, surfaces.position_z + i));
  const V nx = GatherAt(d, emitters.normal[0], at);
  const V ny = GatherAt(d, emitters.normal[1], at);
  const V nz = GatherAt(d, emitters.normal[2], at);
  const V error = hn::Mul(hn::Set(d, kLightRoundoffs<Real>), AbsDot(d, nx, ny, nz, lx, ly, lz));
  const V away = hn::Add(GatherAt(d, emitters.offset, at), error);
  const V squared = Dot(d, lx, ly, lz, lx, ly, lz);
  Normalize(d, lx, ly, lz);
  const V cosine = Dot(d, lx, ly, lz, nx, ny, nz), size = hn::Abs(cosine);
  const V offset = hn::CopySign(away, cosine);
  ex = hn::Sub(ex, hn::Mul(nx, offset));
  ey = hn::Sub(ey, hn::Mul(ny, offset));
  ez = hn::Sub(ez, hn::Mul(nz, offset));
  hn::StoreU(GatherAt(d, emitters.rgb[0], at), d, incidence.r + i);
  hn::StoreU(GatherAt(d, emitters.rgb[1], at), d, incidence.g + i);
  hn::StoreU(GatherAt(d, emitters.rgb[2], at), d, incidence.b + i);
  density = GatherAt(d, emitters.density, at);
  falloff = hn::Div(squared, size);
  return hn::And(IsNormalSquare(d, squared), hn::Gt(size, hn::Zero(d)));
}

// Multiplies the colours of emitters' light by the weight of having drawn it: PowerWeight.
template <class D, class V = hn::Vec<D>, typename Real = hn::TFromD<D>>
HWY_INLINE void WeighDrawn(D d, const SurfaceView<Real>& surfaces, std::uint32_t i, V n_dot_l,
                           V falloff, V density, const IncidenceOutput<Real>& incidence) {
  const V one = hn::Set(d, Real(1));
  const V ray_density =
      hn::Mul(hn::LoadU(d, surfaces.scatter + i), hn::Mul(n_dot_l, hn::Set(d, kInversePi<Real>)));
  const V other = hn::Div(ray_density, hn::Mul(density, falloff));
  const V power = hn::Div(one, hn::Add(one, hn::Mul(other, other)));
  const V weight = hn::IfThenElse(hn::Gt(ray_density, hn::Zero(d)), power, one);
  for (Real* const field : {incidence.r, incidence.g, incidence.b}) {
    hn::StoreU(hn::Mul(hn::LoadU(d, field + i), weight), d, field + i);
  }
}

// IncidenceOf with LookAt, for lights that have a size: the unit vector to the point drawn, its
// cosine with the normal (0 where there is no light) and what the light is divided by. Stores the
// points.
template <class D, class V = hn::Vec<D>, typename Real = hn::TFromD<D>>
HWY_INLINE void DrawIncidence(D d, const LightData<Real>& light, const SurfaceView<Real>& surfaces,
                              const SampleView<Real>& points, std::uint32_t i, V& lx, V& ly, V& lz,
                              V& n_dot_l, V& falloff, const IncidenceOutput<Real>& incidence) {
  const V u = hn::LoadU(d, points.u + i), v = hn::LoadU(d, points.v + i);
  V ex = hn::Zero(d), ey = ex, ez = ex, density = ex;
  auto is_light = AllLanes(d);
  if (light.shape == LightShape::kSun) {
    LookAtSun(d, light, u, v, lx, ly, lz, falloff);
    ex = lx, ey = ly, ez = lz;
  } else if (light.shape == LightShape::kEmitters) {
    is_light = LookAtEmitters(d, *light.emitters, surfaces, i, u, v, lx, ly, lz, ex, ey, ez,
                              falloff, density, incidence);
  } else if (light.shape == LightShape::kSphere) {
    is_light = LookAtSphere(d, light, surfaces, i, u, v, lx, ly, lz, ex, ey, ez, falloff);
  } else {
    is_light = LookAtFlat(d, light, surfaces, i, u, v, lx, ly, lz, ex, ey, ez, falloff);
  }
  const V cosine = Dot(d, hn::LoadU(d, surfaces.normal_x + i), hn::LoadU(d, surfaces.normal_y + i),
                       hn::LoadU(d, surfaces.normal_z + i), lx, ly, lz);
  n_dot_l = hn::IfThenElseZero(is_light, cosine);
  if (light.shape == LightShape::kEmitters) {
    WeighDrawn(d, surfaces, i, n_dot_l, falloff, density, incidence);
  }
  hn::StoreU(ex, d, incidence.end_x + i);
  hn::StoreU(ey, d, incidence.end_y + i);
  hn::StoreU(ez, d, incidence.end_z + i);
}

}  // namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // SHEAF_SIMD_DRAW_LIGHT_INL_H_
