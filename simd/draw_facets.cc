#include "simd/draw_facets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simd/draw_facets.cc"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "hwy/highway.h"
#include "simd/dispatch.h"
#include "simd/frame-inl.h"
#include "simd/material-inl.h"
#include "simd/math-inl.h"
#include "simd/query.h"
#include "simd/sin_cos-inl.h"

HWY_BEFORE_NAMESPACE();
namespace sheaf::simd::HWY_NAMESPACE {

template <class D, class V = hn::Vec<D>, typename Real = hn::TFromD<D>>
HWY_INLINE void DrawFacet(D d, V width, V nx, V ny, V nz, V ox, V oy, V oz, V height, V u, V v,
                          V& fx, V& fy, V& fz) {
  const V one = hn::Set(d, Real(1)), zero = hn::Zero(d);
  V xx, xy, xz, yx, yy, yz;
  MakeFrame(d, nx, ny, nz, xx, xy, xz, yx, yy, yz);
  V sx = hn::Mul(Dot(d, xx, xy, xz, ox, oy, oz), width);
  V sy = hn::Mul(Dot(d, yx, yy, yz, ox, oy, oz), width);
  V sz = height;
  Normalize(d, sx, sy, sz);
  const V z = hn::Sub(hn::Mul(hn::Sub(one, v), hn::Add(one, sz)), sz);
  const V square = hn::Sub(one, hn::Mul(z, z));
  const V radius = hn::Sqrt(hn::IfThenElseZero(hn::Gt(square, zero), square));
  V sine, cosine;
  SinCos(d, hn::Mul(hn::Set(d, Real(4)), u), sine, cosine);
  V hx = hn::Mul(hn::Add(hn::Mul(radius, cosine), sx), width);
  V hy = hn::Mul(hn::Add(hn::Mul(radius, sine), sy), width);
  V hz = hn::Add(z, sz);
  Normalize(d, hx, hy, hz);
  const auto is_seen = hn::Gt(height, zero);
  const auto turned = [&](V x, V y, V n) SHEAF_LAMBDA {
    const V sum = hn::Add(hn::Add(hn::Mul(x, hx), hn::Mul(y, hy)), hn::Mul(n, hz));
    return hn::IfThenElse(is_seen, sum, n);
  };
  fx = turned(xx, yx, nx);
  fy = turned(xy, yy, ny);
  fz = turned(xz, yz, nz);
}

// The tables of both sides follow one another, and then those of other widths.
template <class D, class DI, class V = hn::Vec<D>, typename Real = hn::TFromD<D>>
HWY_INLINE V GlossAt(D d, DI di, const MaterialData<Real>& material, V width, V height,
                     hn::Vec<DI> source) {
  using Id = hn::TFromD<DI>;
  const V one = hn::Set(d, Real(1)), zero = hn::Zero(d);
  const V below_one = hn::IfThenElse(hn::Lt(height, one), height, one);
  const V clamped = hn::IfThenElseZero(hn::Gt(height, zero), below_one);
  const V along = hn::Mul(hn::Sqrt(clamped), hn::Set(d, Real(kGlossSteps))),
          step = hn::Floor(along);
  const auto bit = hn::Set(di, Id{kInsideBit});
  const auto inside = hn::Ne(hn::And(source, bit), hn::Zero(di));
  const auto side = hn::IfThenElseZero(inside, hn::Set(di, Id{kGlossEntries}));
  const hn::RebindToSigned<D> ds;
  const auto i = hn::Add(hn::BitCast(di, hn::ConvertTo(ds, step)), side);
  const auto between = [&](hn::Vec<DI> at) SHEAF_LAMBDA {
    const V low = GatherAt(d, material.gloss, at);
    const V high = GatherAt(d, material.gloss + 1, at);
    return hn::Add(low, hn::Mul(hn::Sub(high, low), hn::Sub(along, step)));
  };
  if (!material.finish.has_facets) return between(i);
  const V across = hn::Mul(hn::Sqrt(width), hn::Set(d, Real(kGlossRowSteps))),
          row = hn::Floor(across);
  // Multiplied as numbers, which are small: not every target multiplies long integers.
  const V before = hn::Mul(row, hn::Set(d, Real(2 * kGlossEntries)));
  const auto begin = hn::Add(i, hn::BitCast(di, hn::ConvertTo(ds, before)));
  const auto end = hn::Add(begin, hn::Set(di, Id{2 * kGlossEntries}));
  const V low = between(begin);
  return hn::Add(low, hn::Mul(hn::Sub(between(end), low), hn::Sub(across, row)));
}

template <typename Real>
void DrawFacetsLanes(const MaterialData<Real>& material, const SurfaceView<Real>& surfaces,
                     const SampleView<Real>& points, std::uint32_t count,
                     const SurfaceOutput<Real>& facets) {
  const Lanes<Real> d;
  const IdLanes<Lanes<Real>> di;
  using V = hn::Vec<Lanes<Real>>;
  for (std::uint32_t i = 0; i < count; i += LaneCount(d)) {
    const V nx = hn::LoadU(d, surfaces.normal_x + i);
    const V ny = hn::LoadU(d, surfaces.normal_y + i);
    const V nz = hn::LoadU(d, surfaces.normal_z + i);
    const V ox = hn::Neg(hn::LoadU(d, surfaces.direction_x + i));
    const V oy = hn::Neg(hn::LoadU(d, surfaces.direction_y + i));
    const V oz = hn::Neg(hn::LoadU(d, surfaces.direction_z + i));
    const V height = Dot(d, nx, ny, nz, ox, oy, oz);
    const V width = LoadTerm(d, material, material.slope_width, surfaces.slope_width, i);
    V fx, fy, fz;
    DrawFacet(d, width, nx, ny, nz, ox, oy, oz, height, hn::LoadU(d, points.u + i),
              hn::LoadU(d, points.v + i), fx, fy, fz);
    hn::StoreU(fx, d, facets.facet_x + i);
    hn::StoreU(fy, d, facets.facet_y + i);
    hn::StoreU(fz, d, facets.facet_z + i);
    hn::StoreU(GlossAt(d, di, material, width, height, LoadIds(d, surfaces.source + i)), d,
               facets.gloss + i);
  }
}
SHEAF_NAME_KERNELS(DrawFacets);

}  // namespace sheaf::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sheaf::simd {
SHEAF_EXPORT(DrawFacets);
}  // namespace sheaf::simd
#endif  // HWY_ONCE
