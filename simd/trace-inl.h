// A batch of rays against a tree: which way its packets go.
#if defined(SHEAF_SIMD_TRACE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SHEAF_SIMD_TRACE_INL_H_
#undef SHEAF_SIMD_TRACE_INL_H_
#else
#define SHEAF_SIMD_TRACE_INL_H_
#endif

#include "simd/query.h"
#include "simd/stray_rays-inl.h"
#include "simd/streams.h"
#include "simd/trace_sheet-inl.h"
#include "simd/tree.h"

HWY_BEFORE_NAMESPACE();
namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE {

// The packet's open rays as rays, or in a packet as far as they go together.
template <Query kQuery, typename Real>
HWY_INLINE void TraceAlone(const TreeView<Real>& tree, Packet<Real>& packet) {
  PrepareBoxes(tree, packet);
  TraceEveryLeaf<kQuery>(tree, packet, packet.without_boxes);
  TracePacket<kQuery>(tree, packet, OpenLanes(packet) & ~packet.without_boxes, 0);
}

// Traces the strays, and calls finish.Scatter(packet, positions, n) for every n of them.
template <Query kQuery, typename Real, class Finish>
HWY_NOINLINE void TraceStrays(const TreeView<Real>& tree, const RayView<Real>& rays,
                              const RayIntervals<Real>& intervals, StrayRays& strays,
                              const Finish& finish) {
  const std::uint32_t lanes = LaneCount(Lanes<Real>());
  std::uint32_t sorted[StrayRays::kCapacity];
  SortByDirection(strays, sorted);
  Packet<Real> packet;
  for (std::uint32_t i = 0; i < strays.count; i += lanes) {
    const std::uint32_t n = std::min(lanes, strays.count - i);
    GatherPacket(rays, intervals, sorted + i, n, packet);
    PrepareLeafTerms(tree, packet);
    TraceAlone<kQuery>(tree, packet);
    finish.Scatter(packet, sorted + i, n);
  }
  strays.count = 0;
}

// Calls finish.Store(packet, i) for every packet of the batch once its rays are traced; i is the
// position of its first ray. What becomes of strays comes later, through finish.Scatter.
template <Query kQuery, typename Real, class Finish>
HWY_INLINE void TraceBatch(const TreeView<Real>& tree, const RayView<Real>& rays,
                           const RayIntervals<Real>& intervals, std::uint32_t count,
                           Coherence coherence, const Finish& finish) {
  const std::uint32_t lanes = LaneCount(Lanes<Real>());
  Frustum<Real> frustum;
  StrayRays strays;
  // On one lane a frustum is one ray, which gains nothing where boxes do not pay.
  const bool may_be_frustum =
      tree.node_count > 0 && !(tree.skips_boxes && lanes == 1) &&
      (coherence == Coherence::kUnknown || coherence == Coherence::kCommonOrigin);
  const bool may_be_sheet = coherence == Coherence::kUnknown;
  for (std::uint32_t begin = 0; begin < count; begin += lanes * lanes) {
    frustum.count = 0;
    for (std::uint32_t i = begin; i < count && frustum.count < lanes; i += lanes) {
      Packet<Real>& packet = frustum.packets[frustum.count++];
      LoadPacket(rays, intervals, i, count, packet);
      PrepareLeafTerms(tree, packet);
    }
    if (may_be_frustum && PrepareFrustum(tree, frustum)) {
      TraceFrustum<kQuery>(tree, frustum);
    } else if (tree.skips_boxes) {
      for (std::uint32_t k = 0; k < frustum.count; ++k) {
        TraceEveryLeaf<kQuery>(tree, frustum.packets[k], OpenLanes(frustum.packets[k]));
      }
    } else if (may_be_sheet && PrepareSheet(tree, frustum)) {
      TraceSheet<kQuery>(tree, frustum);
    } else {
      if (strays.count + lanes * lanes > StrayRays::kCapacity) {
        TraceStrays<kQuery>(tree, rays, intervals, strays, finish);
      }
      for (std::uint32_t k = 0; k < frustum.count; ++k) {
        Packet<Real>& packet = frustum.packets[k];
        const bool is_aside =
            coherence != Coherence::kCoherent && PutAside(packet, begin + k * lanes, strays);
        if (!is_aside) TraceAlone<kQuery>(tree, packet);
      }
    }
    for (std::uint32_t k = 0; k < frustum.count; ++k)
      finish.Store(frustum.packets[k], begin + k * lanes);
  }
  TraceStrays<kQuery>(tree, rays, intervals, strays, finish);
}

}  // namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // SHEAF_SIMD_TRACE_INL_H_
