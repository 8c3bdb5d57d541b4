// A packet of rays against a whole geometry: every primitive in turn.
#if defined(SHEAF_SIMD_HITS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SHEAF_SIMD_HITS_INL_H_
#undef SHEAF_SIMD_HITS_INL_H_
#else
#define SHEAF_SIMD_HITS_INL_H_
#endif

#include "simd/ray-inl.h"
#include "simd/sphere-inl.h"
#include "simd/triangle-inl.h"

HWY_BEFORE_NAMESPACE();
namespace sheaf::simd::HWY_NAMESPACE {

// Calls visit(hit, id, t, u, v) for every primitive that one of `lanes` of the packet at `i` hits
// within [t_min, t_max]. The visitor may lower t_max and clear lanes, both passed by reference;
// with none left, the search ends.
template <class D, class V, class M, class Visit, typename Real = hn::TFromD<D>>
HWY_INLINE void ForEachHit(D d, const GeometryView<Real>& geometry, const RayView<Real>& rays,
                           std::uint32_t i, V t_min, V& t_max, M& lanes, Visit visit) {
  const IdLanes<D> di;
  const V ox = hn::LoadU(d, rays.origin_x + i);
  const V oy = hn::LoadU(d, rays.origin_y + i);
  const V oz = hn::LoadU(d, rays.origin_z + i);
  const V dx = hn::LoadU(d, rays.direction_x + i);
  const V dy = hn::LoadU(d, rays.direction_y + i);
  const V dz = hn::LoadU(d, rays.direction_z + i);
  const auto source = LoadSources(d, rays, i);
  lanes = hn::And(lanes, IsTraceable(d, ox, oy, oz, dx, dy, dz, t_min, t_max));
  if (hn::AllFalse(d, lanes)) return;

  V t = t_max, u = t_max, v = hn::Zero(d);
  const V scale = ScreenScale(d, dx, dy, dz);
  for (std::uint32_t index = 0; index < geometry.spheres.count; ++index) {
    const M near_line = hn::And(
        lanes, MayHitSphere(d, ox, oy, oz, dx, dy, dz, scale, source, geometry.spheres, index));
    if (hn::AllFalse(d, near_line)) continue;
    const M hit =
        HitSphere(d, rays, i, source, t_min, t_max, geometry.spheres, index, near_line, t, u);
    if (hn::AllFalse(d, hit)) continue;
    visit(hit, geometry.spheres.id[index], t, u, hn::Zero(d));
    if (hn::AllFalse(d, lanes)) return;
  }

  if (geometry.triangles.count == 0) return;
  // A packet's rays mostly share their dominant axis; where they do not, each axis takes its lanes.
  const auto source_id = hn::And(source, hn::Set(di, hn::TFromD<IdLanes<D>>{~kInsideBit}));
  for (int kz = 0; kz < 3; ++kz) {
    M axis_lanes = hn::And(lanes, DominatedBy(d, kz, dx, dy, dz));
    if (hn::AllFalse(d, axis_lanes)) continue;
    const V okx = kz == 0 ? oy : kz == 1 ? oz : ox, dkx = kz == 0 ? dy : kz == 1 ? dz : dx;
    const V oky = kz == 0 ? oz : kz == 1 ? ox : oy, dky = kz == 0 ? dz : kz == 1 ? dx : dy;
    const V okz = kz == 0 ? ox : kz == 1 ? oy : oz, dkz = kz == 0 ? dx : kz == 1 ? dy : dz;
    const V sx = hn::Div(dkx, dkz), sy = hn::Div(dky, dkz);
    const ShearedVertices<Real> vertices(geometry.triangles, kz);
    for (std::uint32_t index = 0; index < geometry.triangles.count; ++index) {
      const std::uint32_t id = geometry.triangles.id[index];
      M hit = HitTriangle(d, okx, oky, okz, sx, sy, dkz, vertices, index, axis_lanes, t, u, v);
      if (hn::AllFalse(d, hit)) continue;
      const M elsewhere = hn::RebindMask(d, hn::Ne(source_id, hn::Set(di, id)));
      hit = hn::And(hn::And(hit, elsewhere), hn::And(hn::Le(t_min, t), hn::Le(t, t_max)));
      if (hn::AllFalse(d, hit)) continue;
      visit(hit, id, t, u, v);
      axis_lanes = hn::And(axis_lanes, lanes);
      if (hn::AllFalse(d, axis_lanes)) break;
    }
  }
}

}  // namespace sheaf::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // SHEAF_SIMD_HITS_INL_H_
