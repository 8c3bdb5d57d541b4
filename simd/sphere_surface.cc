#include <algorithm>

#include "simd/surfaces.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simd/sphere_surface.cc"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "hwy/highway.h"
#include "simd/dispatch.h"
#include "simd/query.h"
#include "simd/roundoffs.h"
#include "simd/sphere-inl.h"

HWY_BEFORE_NAMESPACE();
namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE {

// Hits that are worked on together: the divisions and roots of several vectors overlap.
inline constexpr std::uint32_t kBlock = 2 * kMaxLanes;

// What the surfaces of a block are computed from.
template <typename Real>
struct HitBlock {
  alignas(kAlignment) Real origin[3][kBlock];
  alignas(kAlignment) Real direction[3][kBlock];
  alignas(kAlignment) Real center[3][kBlock];
  alignas(kAlignment) Real radius[kBlock];
  alignas(kAlignment) Real t[kBlock], t_rest[kBlock];
  alignas(kAlignment) Real leaves[kBlock];  // 1: the far root; 0: the near one
};

// Writes surfaces at `to`.
template <typename Real>
HWY_INLINE void StoreSurfaces(const HitBlock<Real>& block, std::uint32_t i, std::size_t to,
                              const SurfaceOutput<Real>& surfaces) {
  const WideLanes<Real> dw;
  const NarrowLanes<Real> dn;
  using Wide = hn::TFromD<WideLanes<Real>>;
  const auto wide = [&](const Real* column)
                        SHEAF_LAMBDA { return Widen(hn::Load(dn, column + i)); };
  const auto cx = wide(block.center[0]), cy = wide(block.center[1]), cz = wide(block.center[2]);
  const auto r = wide(block.radius);
  const auto leaves = hn::Ne(wide(block.leaves), hn::Zero(dw));
  const auto t = hn::Add(wide(block.t), wide(block.t_rest));
  const auto along = [&](int axis, auto c) SHEAF_LAMBDA {
    return hn::Add(hn::Sub(wide(block.origin[axis]), c), hn::Mul(wide(block.direction[axis]), t));
  };
  auto nx = along(0, cx), ny = along(1, cy), nz = along(2, cz);
  NormalizeWide(dw, nx, ny, nz);

  const auto px = hn::Add(cx, hn::Mul(nx, r));
  const auto py = hn::Add(cy, hn::Mul(ny, r));
  const auto pz = hn::Add(cz, hn::Mul(nz, r));
  const auto position_error = hn::Mul(hn::Set(dw, static_cast<Wide>(kPositionRoundoffs<Real>)),
                                      AbsDot(dw, nx, ny, nz, px, py, pz));
  const auto term_error = hn::Mul(hn::Set(dw, kTermRoundoffs<Wide>),
                                  AbsDot(dw, nx, ny, nz, hn::Add(hn::Abs(cx), r),
                                         hn::Add(hn::Abs(cy), r), hn::Add(hn::Abs(cz), r)));
  const auto store = [&](auto v, Real* HWY_RESTRICT field)
                         SHEAF_LAMBDA { hn::StoreU(Narrow<Real>(v), dn, field + to); };
  const auto facing = [&](auto n) SHEAF_LAMBDA { return hn::IfThenElse(leaves, hn::Neg(n), n); };
  store(px, surfaces.position_x);
  store(py, surfaces.position_y);
  store(pz, surfaces.position_z);
  store(facing(nx), surfaces.normal_x);
  store(facing(ny), surfaces.normal_y);
  store(facing(nz), surfaces.normal_z);
  store(hn::Add(position_error, term_error), surfaces.offset);
}

// A vector of hits to the block at `at`; what is only copied goes to the surfaces at once.
template <typename Real>
HWY_INLINE void FetchHits(const SphereArrays<Real>& spheres, const RayView<Real>& rays,
                          const HitView<Real>& hits, const HitBatch& batch, std::uint32_t i,
                          std::uint32_t needs, const SurfaceOutput<Real>& surfaces,
                          HitBlock<Real>& block, std::uint32_t at) {
  const Lanes<Real> d;
  const IdLanes<Lanes<Real>> di;
  // Lanes past the count gather element 0.
  const auto lanes = hn::RebindMask(di, LanesBelow(d, i, batch.count));
  const auto ray = hn::IfThenElseZero(lanes, LoadIds(d, batch.ray + i));
  const auto index = hn::IfThenElseZero(lanes, LoadIds(d, batch.index + i));
  const std::uint32_t wanted = batch.count - i;
  const IdPattern ray_pattern = PatternOf(batch.ray + i, LaneCount(d), wanted);
  const IdPattern index_pattern = PatternOf(batch.index + i, LaneCount(d), wanted);
  const auto of_ray = [&](const Real* array)
                          HWY_ATTR { return Fetch(d, ray_pattern, array, batch.ray[i], ray); };
  const auto of_primitive = [&](const Real* array) HWY_ATTR {
    return Fetch(d, index_pattern, array, batch.index[i], index);
  };
  const auto dx = of_ray(rays.direction_x);
  const auto dy = of_ray(rays.direction_y);
  const auto dz = of_ray(rays.direction_z);
  const Real* const hit_leaves = hits.u;  // a sphere's names for these two
  const Real* const hit_t_rest = hits.v;
  const auto leaves = hn::Ne(of_ray(hit_leaves), hn::Zero(d));
  hn::Store(of_ray(rays.origin_x), d, block.origin[0] + at);
  hn::Store(of_ray(rays.origin_y), d, block.origin[1] + at);
  hn::Store(of_ray(rays.origin_z), d, block.origin[2] + at);
  hn::Store(dx, d, block.direction[0] + at);
  hn::Store(dy, d, block.direction[1] + at);
  hn::Store(dz, d, block.direction[2] + at);
  hn::Store(of_primitive(spheres.center_x), d, block.center[0] + at);
  hn::Store(of_primitive(spheres.center_y), d, block.center[1] + at);
  hn::Store(of_primitive(spheres.center_z), d, block.center[2] + at);
  hn::Store(of_primitive(spheres.radius), d, block.radius + at);
  hn::Store(of_ray(hits.t), d, block.t + at);
  hn::Store(of_ray(hit_t_rest), d, block.t_rest + at);
  hn::Store(hn::IfThenElseZero(leaves, hn::Set(d, Real(1))), d, block.leaves + at);

  hn::StoreU(dx, d, surfaces.direction_x + i);
  hn::StoreU(dy, d, surfaces.direction_y + i);
  hn::StoreU(dz, d, surfaces.direction_z + i);
  if (needs & kNeedsCoordinates) {
    hn::StoreU(hn::Zero(d), d, surfaces.u + i);
    hn::StoreU(hn::Zero(d), d, surfaces.v + i);
  }
  const auto inside = hn::Set(di, hn::TFromD<decltype(di)>{kInsideBit});
  const auto id = LoadIds(d, batch.primitive + i);
  StoreIds(d, hn::Or(id, hn::IfThenElseZero(hn::RebindMask(di, leaves), inside)),
           surfaces.source + i);
  StoreIds(d, ray, surfaces.ray + i);
}

template <typename Real>
void SphereSurfacesLanes(const GeometryView<Real>& geometry, const RayView<Real>& rays,
                         const HitView<Real>& hits, const HitBatch& batch, std::uint32_t needs,
                         const SurfaceOutput<Real>& surfaces) {
  const std::uint32_t lanes = LaneCount(Lanes<Real>());
  const std::uint32_t wide_lanes = LaneCount(WideLanes<Real>());
  HitBlock<Real> block;
  for (std::uint32_t first = 0; first < batch.count; first += kBlock) {
    const std::uint32_t count = std::min(kBlock, batch.count - first);
    for (std::uint32_t i = 0; i < count; i += lanes) {
      FetchHits(geometry.spheres, rays, hits, batch, first + i, needs, surfaces, block, i);
    }
    for (std::uint32_t i = 0; i < count; i += wide_lanes) {
      StoreSurfaces(block, i, std::size_t{first} + i, surfaces);
    }
  }
}
SHEAF_NAME_KERNELS(SphereSurfaces);

}  // namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sheaf::SHEAF_SIMD {
SHEAF_EXPORT(SphereSurfaces);
}  // namespace sheaf::SHEAF_SIMD
#endif  // HWY_ONCE
