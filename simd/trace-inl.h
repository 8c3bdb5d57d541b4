// Traces a batch of rays: as frusta, sheets, packets or single rays.
#if defined(SHEAF_SIMD_TRACE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SHEAF_SIMD_TRACE_INL_H_
#undef SHEAF_SIMD_TRACE_INL_H_
#else
#define SHEAF_SIMD_TRACE_INL_H_
#endif

#include "simd/query.h"
#include "simd/stray_rays-inl.h"
#include "simd/streams.h"
#include "simd/trace_frustum-inl.h"
#include "simd/trace_sheet-inl.h"
#include "simd/tree.h"

HWY_BEFORE_NAMESPACE();
namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE {

// Traces the packet's open rays without those of other packets.
template <Query kQuery, typename Real>
HWY_INLINE void TraceAlone(const TreeView<Real>& tree, Packet<Real>& packet) {
  PrepareBoxes(tree, packet);
  TraceEveryLeaf<kQuery>(tree, packet, packet.without_boxes);
  TracePacket<kQuery>(tree, packet, OpenLanes(packet) & ~packet.without_boxes, 0);
}

// Traces the strays, packet by packet.
template <class Output, typename Real>
HWY_NOINLINE void TraceStrays(const Batch<Output, Real>& batch, StrayRays& strays) {
  const std::uint32_t lanes = LaneCount(Lanes<Real>());
  std::uint32_t sorted[StrayRays::kCapacity + kMaxLanes];
  SortByDirection(strays, sorted);
  Packet<Real> packet;
  for (std::uint32_t i = 0; i < strays.count; i += lanes) {
    const std::uint32_t n = std::min(lanes, strays.count - i);
    GatherPacket(batch.rays, batch.intervals, sorted + i, n, packet);
    PrepareLeafTerms(batch.tree, packet);
    TraceAlone<Output::kQuery>(batch.tree, packet);
    batch.output.Scatter(packet, sorted + i, n);
  }
  strays.count = 0;
}

// Traces the rays [begin, end) as a sheet and returns true, where they can be one.
template <class Output, typename Real>
HWY_NOINLINE bool TraceAsSheet(const Batch<Output, Real>& batch, std::uint32_t begin,
                               std::uint32_t end) {
  const std::uint32_t lanes = LaneCount(Lanes<Real>());
  // Two rays rule most batches out.
  const RayView<Real>& rays = batch.rays;
  const std::uint32_t other = std::min(begin + 1, end - 1);
  if (rays.direction_x[begin] != rays.direction_x[other] ||
      rays.direction_y[begin] != rays.direction_y[other] ||
      rays.direction_z[begin] != rays.direction_z[other]) {
    return false;
  }
  Sheet<Real> sheet;
  sheet.count = 0;
  std::uint32_t i = begin;
  do {
    Packet<Real>& packet = sheet.packets[sheet.count++];
    LoadPacket(rays, batch.intervals, i, batch.count, packet);
    PrepareLeafTerms(batch.tree, packet);
    i += lanes;
  } while (i < end);
  if (!PrepareSheet(batch.tree, sheet)) return false;
  TraceSheet<Output::kQuery>(batch.tree, sheet);
  for (std::uint32_t k = 0; k < sheet.count; ++k) {
    batch.output.Store(sheet.packets[k], begin + k * lanes);
  }
  return true;
}

// Traces the rays [i, i + lanes) as a packet, or against every leaf where boxes do not pay.
template <class Output, typename Real>
HWY_NOINLINE void TraceOnePacket(const Batch<Output, Real>& batch, std::uint32_t i) {
  Packet<Real> packet;
  LoadPacket(batch.rays, batch.intervals, i, batch.count, packet);
  PrepareLeafTerms(batch.tree, packet);
  if (batch.tree.skips_boxes) {
    TraceEveryLeaf<Output::kQuery>(batch.tree, packet, OpenLanes(packet));
  } else {
    TraceAlone<Output::kQuery>(batch.tree, packet);
  }
  batch.output.Store(packet, i);
}

// Takes a square of packets at a time. They go as a frustum, as a sheet or packet by packet, or are
// set aside as strays to be sorted by direction.
template <class Output, typename Real>
HWY_INLINE void TraceBatch(const Batch<Output, Real>& batch, Coherence coherence) {
  const TreeView<Real>& tree = batch.tree;
  const std::uint32_t lanes = LaneCount(Lanes<Real>());
  Frustum<Real> frustum;
  StrayRays strays;
  // On one lane a frustum is a single ray. It gains nothing where boxes do not pay.
  const bool may_be_frustum =
      tree.node_count > 0 && !(tree.skips_boxes && lanes == 1) &&
      (coherence == Coherence::kUnknown || coherence == Coherence::kCommonOrigin);
  const bool may_be_sheet = coherence == Coherence::kUnknown && !tree.skips_boxes;
  const bool may_stray = coherence != Coherence::kCoherent && !tree.skips_boxes;
  for (std::uint32_t begin = 0; begin < batch.count; begin += lanes * lanes) {
    const std::uint32_t end = std::min(batch.count, begin + lanes * lanes);
    if (may_be_frustum && PrepareFrustum(batch, begin, frustum)) {
      TraceFrustum(batch, frustum);
      continue;
    }
    if (may_be_sheet && TraceAsSheet(batch, begin, end)) continue;
    if (strays.count + lanes * lanes > StrayRays::kCapacity) TraceStrays(batch, strays);
    for (std::uint32_t i = begin; i < end; i += lanes) {
      if (may_stray &&
          PutAside(batch.rays, batch.intervals, i, batch.count, strays) == Company::kStrays) {
        continue;
      }
      TraceOnePacket(batch, i);
    }
  }
  TraceStrays(batch, strays);
}

}  // namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // SHEAF_SIMD_TRACE_INL_H_
