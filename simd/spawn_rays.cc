#include "simd/spawn_rays.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simd/spawn_rays.cc"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "hwy/highway.h"
#include "simd/children-inl.h"
#include "simd/compact-inl.h"
#include "simd/dispatch.h"
#include "simd/material-inl.h"
#include "simd/query.h"

HWY_BEFORE_NAMESPACE();
namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE {

// src/scalar/spawn.h; `n_dot_child` is the cosine of the child's direction and the normal.
template <class D, class V = hn::Vec<D>, typename Real = hn::TFromD<D>>
HWY_INLINE V GlossShare(D d, const MaterialData<Real>& material, const SurfaceView<Real>& surfaces,
                        std::uint32_t i, V n_dot_child, V side) {
  const V one = hn::Set(d, Real(1)), two = hn::Set(d, Real(2));
  const V cosine = hn::Mul(n_dot_child, side), square = hn::Mul(cosine, cosine);
  const V width = LoadTerm(d, material, material.slope_width, surfaces.slope_width, i);
  const V spread = hn::Mul(hn::Mul(width, width), hn::Sub(one, square));
  const V unmasked =
      hn::Div(hn::Mul(two, cosine), hn::Add(cosine, hn::Sqrt(hn::Add(square, spread))));
  const V above = hn::IfThenElseZero(hn::Gt(cosine, hn::Zero(d)), unmasked);
  return hn::Mul(above, hn::LoadU(d, surfaces.gloss + i));
}

template <typename Real>
SpawnCounts SpawnRaysLanes(const MaterialData<Real>& material, const SurfaceView<Real>& surfaces,
                           std::uint32_t count, const PathView<Real>& parents, Real min_throughput,
                           const RayOutput<Real>& reflected_rays,
                           const PathOutput<Real>& reflected_paths,
                           const RayOutput<Real>& refracted_rays,
                           const PathOutput<Real>& refracted_paths) {
  const Lanes<Real> d;
  const IdLanes<Lanes<Real>> di;
  using V = hn::Vec<Lanes<Real>>;
  using VI = hn::Vec<IdLanes<Lanes<Real>>>;
  const V zero = hn::Zero(d), one = hn::Set(d, Real(1)), least = hn::Set(d, min_throughput);
  const VI bit = hn::Set(di, hn::TFromD<decltype(di)>{kInsideBit});
  const bool transmits = (material.needs & kNeedsTransmission) != 0;
  SpawnCounts size{0, 0};
  Splits<Real> splits;
  for (std::uint32_t i = 0; i < count; i += LaneCount(d)) {
    const std::uint32_t in_block = i % kBlock;
    if (in_block == 0) FillBlock(material, surfaces, i, std::min(kBlock, count - i), splits);
    const auto lanes = LanesBelow(d, i, count);
    const V nx = hn::LoadU(d, surfaces.normal_x + i);
    const V ny = hn::LoadU(d, surfaces.normal_y + i);
    const V nz = hn::LoadU(d, surfaces.normal_z + i);
    const V dx = hn::LoadU(d, surfaces.direction_x + i);
    const V dy = hn::LoadU(d, surfaces.direction_y + i);
    const V dz = hn::LoadU(d, surfaces.direction_z + i);
    const V offset = hn::LoadU(d, surfaces.offset + i);
    // What rays are mirrored and bent at.
    V mx = nx, my = ny, mz = nz;
    if (material.needs & kNeedsGloss) {
      mx = hn::LoadU(d, surfaces.facet_x + i);
      my = hn::LoadU(d, surfaces.facet_y + i);
      mz = hn::LoadU(d, surfaces.facet_z + i);
    }
    const V fx = hn::LoadU(d, surfaces.face_x + i);
    const V fy = hn::LoadU(d, surfaces.face_y + i);
    const V fz = hn::LoadU(d, surfaces.face_z + i);
    const V away_x = hn::Mul(fx, offset), away_y = hn::Mul(fy, offset),
            away_z = hn::Mul(fz, offset);
    const V px = hn::LoadU(d, surfaces.position_x + i);
    const V py = hn::LoadU(d, surfaces.position_y + i);
    const V pz = hn::LoadU(d, surfaces.position_z + i);
    const VI source = LoadIds(d, surfaces.source + i);
    const VI parent = LoadIds(d, surfaces.ray + i);
    const VI safe_parent = hn::IfThenElseZero(hn::RebindMask(di, lanes), parent);
    const auto throughput = [&](const Real* HWY_RESTRICT throughputs) HWY_ATTR {
      return throughputs ? GatherAt(d, throughputs, safe_parent) : one;
    };
    const V throughput_r = throughput(parents.throughput_r);
    const V throughput_g = throughput(parents.throughput_g);
    const V throughput_b = throughput(parents.throughput_b);

    const V cos_i = hn::Load(d, splits.cos_i + in_block);
    V reflectance = zero, cos_t = zero, eta = one;
    auto is_total = hn::Eq(zero, zero);
    if (transmits) {
      eta = hn::Load(d, splits.eta + in_block);
      reflectance = hn::Load(d, splits.reflectance + in_block);
      const V marked = hn::Load(d, splits.cos_t + in_block);
      is_total = hn::Lt(marked, zero);
      cos_t = hn::IfThenZeroElse(is_total, marked);
    }

    const auto append = [&](V wr, V wg, V wb, V ox, V oy, V oz, V x, V y, V z, V side, VI from,
                            const Real* choice, const RayOutput<Real>& rays,
                            const PathOutput<Real>& paths, std::uint32_t& at) HWY_ATTR {
      if (material.needs & kNeedsGloss) {
        FinishDirection(d, material, fx, fy, fz, nx, ny, nz, side, x, y, z);
        const V rough = GlossShare(d, material, surfaces, i, Dot(d, x, y, z, nx, ny, nz), side);
        const auto goes_straight = hn::And(hn::Eq(eta, one), hn::Lt(side, zero));
        const V share = hn::IfThenElse(goes_straight, one, rough);
        wr = hn::Mul(wr, share), wg = hn::Mul(wg, share), wb = hn::Mul(wb, share);
      }
      if (material.needs & kNeedsChoice) {
        const V share = hn::LoadU(d, choice + i);
        wr = hn::Mul(wr, share), wg = hn::Mul(wg, share), wb = hn::Mul(wb, share);
      }
      const auto counts = hn::Or(hn::Or(hn::Gt(wr, least), hn::Gt(wg, least)), hn::Gt(wb, least));
      const auto kept = hn::And(lanes, counts);
      if (hn::AllFalse(d, kept)) return;
      if (!(material.needs & kNeedsGloss)) {
        FinishDirection(d, material, fx, fy, fz, nx, ny, nz, side, x, y, z);
      }
      const auto order = CompactOrder(d, kept);
      CompactStore(d, ox, order, rays.origin_x + at);
      CompactStore(d, oy, order, rays.origin_y + at);
      CompactStore(d, oz, order, rays.origin_z + at);
      CompactStore(d, x, order, rays.direction_x + at);
      CompactStore(d, y, order, rays.direction_y + at);
      CompactStore(d, z, order, rays.direction_z + at);
      CompactStoreIds(d, from, order, rays.source + at);
      CompactStoreIds(d, parent, order, paths.parent + at);
      CompactStore(d, wr, order, paths.throughput_r + at);
      CompactStore(d, wg, order, paths.throughput_g + at);
      CompactStore(d, wb, order, paths.throughput_b + at);
      if (material.needs & kNeedsWidth) {
        CompactStore(d, hn::LoadU(d, surfaces.width + i), order, paths.width + at);
      }
      at += CountLanes(d, kept);
    };

    const Real* const reflects[3] = {surfaces.reflect_r, surfaces.reflect_g, surfaces.reflect_b};
    const Real* const transmits_at[3] = {surfaces.transmit_r, surfaces.transmit_g,
                                         surfaces.transmit_b};
    const auto reflect = [&](int channel) HWY_ATTR {
      return LoadTerm(d, material, material.reflect[channel], reflects[channel], i);
    };
    const auto transmit = [&](int channel) HWY_ATTR {
      return LoadTerm(d, material, material.transmit[channel], transmits_at[channel], i);
    };
    const auto reflected_throughput = [&](V parent_throughput, int channel) HWY_ATTR {
      const V of_glass = hn::Mul(transmit(channel), reflectance);
      return hn::Mul(parent_throughput, hn::Add(reflect(channel), of_glass));
    };
    const V twice = hn::Mul(hn::Set(d, Real(2)), cos_i);
    append(reflected_throughput(throughput_r, 0), reflected_throughput(throughput_g, 1),
           reflected_throughput(throughput_b, 2), hn::Add(px, away_x), hn::Add(py, away_y),
           hn::Add(pz, away_z), hn::Add(dx, hn::Mul(mx, twice)), hn::Add(dy, hn::Mul(my, twice)),
           hn::Add(dz, hn::Mul(mz, twice)), one, source, surfaces.choice_reflect, reflected_rays,
           reflected_paths, size.reflected);

    if (hn::AllTrue(d, is_total)) continue;
    const auto refracted_throughput = [&](V parent_throughput, int channel) HWY_ATTR {
      const V share = hn::Mul(transmit(channel), hn::Sub(one, reflectance));
      return hn::IfThenZeroElse(is_total, hn::Mul(parent_throughput, share));
    };
    const V bend = hn::Sub(hn::Mul(eta, cos_i), cos_t);
    append(refracted_throughput(throughput_r, 0), refracted_throughput(throughput_g, 1),
           refracted_throughput(throughput_b, 2), hn::Sub(px, away_x), hn::Sub(py, away_y),
           hn::Sub(pz, away_z), hn::Add(hn::Mul(dx, eta), hn::Mul(mx, bend)),
           hn::Add(hn::Mul(dy, eta), hn::Mul(my, bend)),
           hn::Add(hn::Mul(dz, eta), hn::Mul(mz, bend)), hn::Neg(one), hn::Xor(source, bit),
           surfaces.choice_refract, refracted_rays, refracted_paths, size.refracted);
  }
  return size;
}
SHEAF_NAME_KERNELS(SpawnRays);

}  // namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sheaf::SHEAF_SIMD {
SHEAF_EXPORT(SpawnRays);
}  // namespace sheaf::SHEAF_SIMD
#endif  // HWY_ONCE
