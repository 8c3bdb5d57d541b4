#include "simd/blend_vertices.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simd/blend_vertices.cc"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "hwy/highway.h"
#include "simd/dispatch.h"
#include "simd/math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace sheaf::simd::HWY_NAMESPACE {

// The surface that smooth normals stand for, where `is_smooth`: Curve of src/scalar/triangle.h,
// from the positions and faces at `i`. Fetch(array) gives a number of the lanes' triangles.
template <typename Real, class Fetch, class W = hn::Vec<WideLanes<Real>>>
HWY_INLINE void StoreCurve(const TriangleArrays<Real>& triangles, const Fetch& fetch,
                           const W (&weights)[3], hn::Mask<WideLanes<Real>> is_smooth,
                           const SurfaceOutput<Real>& surfaces, std::uint32_t i) {
  const WideLanes<Real> dw;
  const NarrowLanes<Real> dn;
  const auto load = [&](const Real* field) HWY_ATTR { return Widen(hn::LoadU(dn, field + i)); };
  const W px = load(surfaces.position_x), py = load(surfaces.position_y),
          pz = load(surfaces.position_z);
  const W fx = load(surfaces.face_x), fy = load(surfaces.face_y), fz = load(surfaces.face_z);
  const W zero = hn::Zero(dw);
  W unit_x[3] = {fx, fx, fx}, unit_y[3] = {fy, fy, fy}, unit_z[3] = {fz, fz, fz};
  W lift_x = zero, lift_y = zero, lift_z = zero;
  for (int k = 0; k < 3; ++k) {
    W x = fetch(triangles.normal[k][0]), y = fetch(triangles.normal[k][1]),
      z = fetch(triangles.normal[k][2]);
    const auto has_normal = hn::Gt(Dot(dw, x, y, z, x, y, z), zero);  // false for NaN
    NormalizeWide(dw, x, y, z);
    const auto turn = hn::Lt(Dot(dw, x, y, z, fx, fy, fz), zero);
    const auto facing = [&](W n, W face) HWY_ATTR {
      return hn::IfThenElse(has_normal, hn::IfThenElse(turn, hn::Neg(n), n), face);
    };
    unit_x[k] = facing(x, fx), unit_y[k] = facing(y, fy), unit_z[k] = facing(z, fz);
    const W depth = Dot(
        dw, hn::Sub(fetch(triangles.vertex[k][0]), px), hn::Sub(fetch(triangles.vertex[k][1]), py),
        hn::Sub(fetch(triangles.vertex[k][2]), pz), unit_x[k], unit_y[k], unit_z[k]);
    const W weight = hn::Mul(hn::IfThenElseZero(hn::Gt(depth, zero), depth), weights[k]);
    lift_x = hn::Add(lift_x, hn::Mul(unit_x[k], weight));
    lift_y = hn::Add(lift_y, hn::Mul(unit_y[k], weight));
    lift_z = hn::Add(lift_z, hn::Mul(unit_z[k], weight));
  }
  W square = zero;
  for (int k = 0; k < 3; ++k) {
    const int next = (k + 1) % 3;
    const W x = hn::Sub(unit_x[next], unit_x[k]), y = hn::Sub(unit_y[next], unit_y[k]),
            z = hn::Sub(unit_z[next], unit_z[k]);
    const W turn = Dot(dw, x, y, z, x, y, z);
    square = hn::IfThenElse(hn::Lt(square, turn), turn, square);
  }
  const auto store = [&](W p, W lift, Real* HWY_RESTRICT to) HWY_ATTR {
    hn::StoreU(Narrow<Real>(hn::IfThenElse(is_smooth, hn::Add(p, lift), p)), dn, to + i);
  };
  store(px, lift_x, surfaces.shadow_x);
  store(py, lift_y, surfaces.shadow_y);
  store(pz, lift_z, surfaces.shadow_z);
  hn::StoreU(Narrow<Real>(hn::IfThenElseZero(is_smooth, hn::Sqrt(square))), dn, surfaces.bend + i);
}

// The mean of what the vertices have at `axis`.
template <class W, class Values, class Fetch>
HWY_INLINE W MeanOf(const Values& values, int axis, const Fetch& fetch, const W (&weights)[3]) {
  return hn::Add(hn::Add(hn::Mul(fetch(values[0][axis]), weights[0]),
                         hn::Mul(fetch(values[1][axis]), weights[1])),
                 hn::Mul(fetch(values[2][axis]), weights[2]));
}

// Keeps the faces' normals at `i` and puts the shading normals in their place.
template <typename Real, class Fetch, class W = hn::Vec<WideLanes<Real>>>
HWY_INLINE void BlendNormals(const TriangleArrays<Real>& triangles, const Fetch& fetch,
                             const W (&weights)[3], std::uint32_t needs,
                             const SurfaceOutput<Real>& surfaces, std::uint32_t i) {
  const WideLanes<Real> dw;
  const NarrowLanes<Real> dn;
  const bool has_normals = triangles.normal[0][0] != nullptr;
  const auto face_x = hn::LoadU(dn, surfaces.normal_x + i);
  const auto face_y = hn::LoadU(dn, surfaces.normal_y + i);
  const auto face_z = hn::LoadU(dn, surfaces.normal_z + i);
  hn::StoreU(face_x, dn, surfaces.face_x + i);
  hn::StoreU(face_y, dn, surfaces.face_y + i);
  hn::StoreU(face_z, dn, surfaces.face_z + i);
  if (!has_normals && NeedsCurves(needs)) {
    hn::StoreU(hn::LoadU(dn, surfaces.position_x + i), dn, surfaces.shadow_x + i);
    hn::StoreU(hn::LoadU(dn, surfaces.position_y + i), dn, surfaces.shadow_y + i);
    hn::StoreU(hn::LoadU(dn, surfaces.position_z + i), dn, surfaces.shadow_z + i);
    hn::StoreU(hn::Zero(dn), dn, surfaces.bend + i);
  }
  if (has_normals) {
    W x = MeanOf<W>(triangles.normal, 0, fetch, weights),
      y = MeanOf<W>(triangles.normal, 1, fetch, weights),
      z = MeanOf<W>(triangles.normal, 2, fetch, weights);
    // False for NaN too: lanes past the count may hold anything.
    const auto is_smooth = hn::Gt(Dot(dw, x, y, z, x, y, z), hn::Zero(dw));
    NormalizeWide(dw, x, y, z);
    const auto turn =
        hn::Lt(Dot(dw, x, y, z, Widen(face_x), Widen(face_y), Widen(face_z)), hn::Zero(dw));
    const auto store = [&](W n, decltype(face_x) face, Real* HWY_RESTRICT to) HWY_ATTR {
      const W normal = hn::IfThenElse(turn, hn::Neg(n), n);
      hn::StoreU(Narrow<Real>(hn::IfThenElse(is_smooth, normal, Widen(face))), dn, to + i);
    };
    store(x, face_x, surfaces.normal_x);
    store(y, face_y, surfaces.normal_y);
    store(z, face_z, surfaces.normal_z);
    if (NeedsCurves(needs)) StoreCurve<Real>(triangles, fetch, weights, is_smooth, surfaces, i);
  }
}

template <typename Real>
void BlendVerticesLanes(const TriangleArrays<Real>& triangles, const HitView<Real>& hits,
                        const HitBatch& batch, std::uint32_t needs,
                        const SurfaceOutput<Real>& surfaces) {
  const WideLanes<Real> dw;
  const NarrowLanes<Real> dn;
  const IdLanes<NarrowLanes<Real>> di;
  using W = hn::Vec<WideLanes<Real>>;
  using Wide = hn::TFromD<WideLanes<Real>>;
  const bool has_colours = triangles.colour[0][0] != nullptr;
  for (std::uint32_t i = 0; i < batch.count; i += LaneCount(dn)) {
    // Lanes past the count gather element 0.
    const auto lanes = hn::RebindMask(di, LanesBelow(dn, i, batch.count));
    const auto ray = hn::IfThenElseZero(lanes, LoadIds(dn, batch.ray + i));
    const auto index = hn::IfThenElseZero(lanes, LoadIds(dn, batch.index + i));
    const std::uint32_t wanted = batch.count - i;
    const IdPattern ray_pattern = PatternOf(batch.ray + i, LaneCount(dn), wanted);
    const IdPattern index_pattern = PatternOf(batch.index + i, LaneCount(dn), wanted);
    const auto of_ray = [&](const Real* array) HWY_ATTR {
      return Widen(Fetch(dn, ray_pattern, array, batch.ray[i], ray));
    };
    const auto of_primitive = [&](const Real* array) HWY_ATTR {
      return Widen(Fetch(dn, index_pattern, array, batch.index[i], index));
    };
    const W w1 = of_ray(hits.u), w2 = of_ray(hits.v);
    const W w0 = hn::Sub(hn::Sub(hn::Set(dw, Wide(1)), w1), w2);
    if (needs & kNeedsNormals) {
      BlendNormals<Real>(triangles, of_primitive, {w0, w1, w2}, needs, surfaces, i);
    }
    const auto blend = [&](const Real* at0, const Real* at1, const Real* at2) HWY_ATTR {
      const W first = of_primitive(at0);
      const W along1 = hn::Sub(of_primitive(at1), first);
      const W along2 = hn::Sub(of_primitive(at2), first);
      return Narrow<Real>(hn::Add(hn::Add(first, hn::Mul(along1, w1)), hn::Mul(along2, w2)));
    };
    if (needs & kNeedsTint) {
      const auto tint = [&](int channel) HWY_ATTR {
        if (!has_colours) return hn::Set(dn, Real(1));
        const auto& colour = triangles.colour;
        return blend(colour[0][channel], colour[1][channel], colour[2][channel]);
      };
      hn::StoreU(tint(0), dn, surfaces.tint_r + i);
      hn::StoreU(tint(1), dn, surfaces.tint_g + i);
      hn::StoreU(tint(2), dn, surfaces.tint_b + i);
    }
    if (needs & kNeedsVertexAlpha) {
      const auto zero = hn::Zero(dn), one = hn::Set(dn, Real(1));
      const auto& of = triangles.alpha;
      const auto alpha = blend(of[0][0], of[1][0], of[2][0]);
      const auto at_most_one = hn::IfThenElse(hn::Lt(alpha, one), alpha, one);
      hn::StoreU(hn::IfThenElse(hn::Gt(alpha, zero), at_most_one, zero), dn, surfaces.alpha + i);
    }
    if (needs & kNeedsSecondSet) {
      hn::StoreU(Narrow<Real>(MeanOf<W>(triangles.uv2, 0, of_primitive, {w0, w1, w2})), dn,
                 surfaces.u2 + i);
      hn::StoreU(Narrow<Real>(MeanOf<W>(triangles.uv2, 1, of_primitive, {w0, w1, w2})), dn,
                 surfaces.v2 + i);
    }
  }
}
SHEAF_NAME_KERNELS(BlendVertices);

}  // namespace sheaf::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sheaf::simd {
SHEAF_EXPORT(BlendVertices);
}  // namespace sheaf::simd
#endif  // HWY_ONCE
