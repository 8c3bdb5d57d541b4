#include "simd/scatter_diffuse.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simd/scatter_diffuse.cc"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "hwy/highway.h"
#include "simd/children-inl.h"
#include "simd/compact-inl.h"
#include "simd/dispatch.h"
#include "simd/frame-inl.h"
#include "simd/material-inl.h"
#include "simd/sample_terms.h"
#include "simd/warp-inl.h"

HWY_BEFORE_NAMESPACE();
namespace sheaf::simd::HWY_NAMESPACE {

// A unit vector about the normal as often as its cosine with it, which is returned.
template <class D, class V = hn::Vec<D>, typename Real = hn::TFromD<D>>
HWY_INLINE V DrawByCosine(D d, V nx, V ny, V nz, V u, V v, V& x, V& y, V& z) {
  V xx, xy, xz, yx, yy, yz, a, b;
  MakeFrame(d, nx, ny, nz, xx, xy, xz, yx, yy, yz);
  DiskPoint(d, u, v, a, b);
  const V c = hn::Sqrt(hn::Sub(hn::Set(d, Real(1)), u));
  x = hn::Add(hn::Add(hn::Mul(xx, a), hn::Mul(yx, b)), hn::Mul(nx, c));
  y = hn::Add(hn::Add(hn::Mul(xy, a), hn::Mul(yy, b)), hn::Mul(ny, c));
  z = hn::Add(hn::Add(hn::Mul(xz, a), hn::Mul(yz, b)), hn::Mul(nz, c));
  return c;
}

template <typename Real>
std::uint32_t ScatterDiffuseLanes(const MaterialData<Real>& material,
                                  const SurfaceView<Real>& surfaces, std::uint32_t count,
                                  const PathView<Real>& parents, const SampleView<Real>& points,
                                  Real min_throughput, const RayOutput<Real>& rays,
                                  const PathOutput<Real>& paths) {
  const Lanes<Real> d;
  const IdLanes<Lanes<Real>> di;
  using V = hn::Vec<Lanes<Real>>;
  const V zero = hn::Zero(d), one = hn::Set(d, Real(1)), least = hn::Set(d, min_throughput);
  std::uint32_t at = 0;
  for (std::uint32_t i = 0; i < count; i += LaneCount(d)) {
    const V share = hn::LoadU(d, surfaces.choice_diffuse + i);
    const auto lanes = hn::And(LanesBelow(d, i, count), hn::Gt(share, zero));
    if (hn::AllFalse(d, lanes)) continue;
    const auto parent = LoadIds(d, surfaces.ray + i);
    const auto safe_parent = hn::IfThenElseZero(hn::RebindMask(di, lanes), parent);
    V r = zero, g = zero, b = zero;
    LoadBaseColour(d, material, surfaces, i, r, g, b);
    const V kd = LoadTerm(d, material, material.kd, surfaces.kd, i);
    const auto throughput = [&](const Real* HWY_RESTRICT throughputs, V base) HWY_ATTR {
      const V arrived = throughputs ? GatherAt(d, throughputs, safe_parent) : one;
      return hn::Mul(hn::Mul(arrived, hn::Mul(kd, base)), share);
    };
    const V wr = throughput(parents.throughput_r, r);
    const V wg = throughput(parents.throughput_g, g);
    const V wb = throughput(parents.throughput_b, b);
    const auto counts = hn::Or(hn::Or(hn::Gt(wr, least), hn::Gt(wg, least)), hn::Gt(wb, least));
    const auto kept = hn::And(lanes, counts);
    if (hn::AllFalse(d, kept)) continue;
    const V nx = hn::LoadU(d, surfaces.normal_x + i);
    const V ny = hn::LoadU(d, surfaces.normal_y + i);
    const V nz = hn::LoadU(d, surfaces.normal_z + i);
    const V fx = hn::LoadU(d, surfaces.face_x + i);
    const V fy = hn::LoadU(d, surfaces.face_y + i);
    const V fz = hn::LoadU(d, surfaces.face_z + i);
    const V offset = hn::LoadU(d, surfaces.offset + i);
    V x, y, z;
    const V cosine = DrawByCosine(d, nx, ny, nz, hn::LoadU(d, points.u + i),
                                  hn::LoadU(d, points.v + i), x, y, z);
    const V density =
        hn::Mul(hn::LoadU(d, surfaces.scatter + i), hn::Mul(cosine, hn::Set(d, kInversePi<Real>)));
    FinishDirection(d, material, fx, fy, fz, nx, ny, nz, one, x, y, z);
    const auto order = CompactOrder(d, kept);
    const auto store = [&](V v, Real* HWY_RESTRICT field)
                           HWY_ATTR { CompactStore(d, v, order, field + at); };
    const auto start = [&](V face, const Real* position) HWY_ATTR {
      return hn::Add(hn::LoadU(d, position + i), hn::Mul(face, offset));
    };
    store(start(fx, surfaces.position_x), rays.origin_x);
    store(start(fy, surfaces.position_y), rays.origin_y);
    store(start(fz, surfaces.position_z), rays.origin_z);
    store(x, rays.direction_x);
    store(y, rays.direction_y);
    store(z, rays.direction_z);
    CompactStoreIds(d, LoadIds(d, surfaces.source + i), order, rays.source + at);
    CompactStoreIds(d, parent, order, paths.parent + at);
    store(wr, paths.throughput_r);
    store(wg, paths.throughput_g);
    store(wb, paths.throughput_b);
    store(density, paths.density);
    if (material.needs & kNeedsWidth) store(hn::LoadU(d, surfaces.width + i), paths.width);
    at += CountLanes(d, kept);
  }
  return at;
}
SHEAF_NAME_KERNELS(ScatterDiffuse);

}  // namespace sheaf::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sheaf::simd {
SHEAF_EXPORT(ScatterDiffuse);
}  // namespace sheaf::simd
#endif  // HWY_ONCE
