// Traces a frustum through the tree.
#if defined(SHEAF_SIMD_TRACE_FRUSTUM_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SHEAF_SIMD_TRACE_FRUSTUM_INL_H_
#undef SHEAF_SIMD_TRACE_FRUSTUM_INL_H_
#else
#define SHEAF_SIMD_TRACE_FRUSTUM_INL_H_
#endif

#include "simd/frustum_leaf-inl.h"

HWY_BEFORE_NAMESPACE();
namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE {

// With this many packets left, or fewer, a frustum goes on as packets.
template <Query kQuery, typename Real>
HWY_INLINE std::uint32_t FewPackets() {
  const std::uint32_t lanes = LaneCount(Lanes<Real>());
  return std::max(1u, kQuery == Query::kOccluded ? lanes * 3 / 16 : lanes / 8);
}

// Traces packet k alone through the subtree of `child`, as a packet of its own.
template <class Output, typename Real>
HWY_NOINLINE void TraceFrustumPacket(const Batch<Output, Real>& batch, Frustum<Real>& frustum,
                                     std::uint32_t k, std::uint32_t child) {
  const Lanes<Real> d;
  const std::uint32_t i = frustum.first + k * LaneCount(d);
  Packet<Real> packet;
  LoadPacket(batch.rays, batch.intervals, i, batch.count, packet);
  PrepareLeafTerms(batch.tree, packet);
  PrepareBoxes(batch.tree, packet);
  hn::Store(hn::Load(d, frustum.t_best[k]), d, packet.t_best);
  const HitSlots<Real> slots = batch.output.Slots(i, frustum.t_best[k], frustum.det[k]);
  StoreIds(d, LoadIds(d, slots.id), packet.id);
  if constexpr (Output::kQuery == Query::kClosest) {
    hn::Store(hn::LoadU(d, slots.u), d, packet.u);
    hn::Store(hn::LoadU(d, slots.v), d, packet.v);
    hn::Store(hn::LoadU(d, slots.det), d, packet.det);
  }
  TracePacketFrom<Output::kQuery>(batch.tree, batch.stack, packet, OpenLanes(packet), child);
  const auto ids = LoadIds(d, packet.id);
  StoreIds(d, ids, slots.id);
  if constexpr (Output::kQuery == Query::kClosest) {
    hn::StoreU(hn::Load(d, packet.u), d, slots.u);
    hn::StoreU(hn::Load(d, packet.v), d, slots.v);
    hn::StoreU(hn::Load(d, packet.det), d, slots.det);
  }
  hn::Store(hn::Load(d, packet.t_best), d, frustum.t_best[k]);
  const auto none = hn::Set(IdLanes<Lanes<Real>>(), kNoPrimitive);
  frustum.without_hit[k] &= MaskBits(d, hn::RebindMask(d, hn::Eq(ids, none)));
  frustum.beam.t_last[k] = LastDepth(batch, frustum, k);
}

// PrepareFrustum has returned true.
template <class Output, typename Real>
HWY_NOINLINE void TraceFrustum(const Batch<Output, Real>& batch, Frustum<Real>& frustum) {
  const Lanes<Real> d;
  TraceBeam(batch.tree, batch.stack, frustum.beam, 0,
            [&](std::uint32_t child, auto met) SHEAF_LAMBDA {
              std::uint32_t packets = MaskBits(d, met);
              if (IsLeaf(child)) {
                if (HasTriangles(child)) {
                  TrianglesAgainstFrustum(batch, child, frustum, packets);
                } else {
                  ScreenedAgainstFrustum(batch, child, frustum, packets);
                }
                return Visit::kDone;
              }
              if (static_cast<std::uint32_t>(std::popcount(packets)) >
                  FewPackets<Output::kQuery, Real>()) {
                return Visit::kDescend;
              }
              for (; packets != 0; packets &= packets - 1) {
                TraceFrustumPacket(batch, frustum,
                                   static_cast<std::uint32_t>(std::countr_zero(packets)), child);
              }
              return Visit::kDone;
            });
  for (std::uint32_t k = 0; k < frustum.count; ++k) {
    batch.output.Finish(d, frustum.first + k * LaneCount(d), frustum.t_best[k], frustum.det[k]);
  }
}

}  // namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // SHEAF_SIMD_TRACE_FRUSTUM_INL_H_
