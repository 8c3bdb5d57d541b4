// Traces a batch of rays: as frusta, sheets, packets, crowds or single rays.
#if defined(SHEAF_SIMD_TRACE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SHEAF_SIMD_TRACE_INL_H_
#undef SHEAF_SIMD_TRACE_INL_H_
#else
#define SHEAF_SIMD_TRACE_INL_H_
#endif

#include "simd/query.h"
#include "simd/stray_rays-inl.h"
#include "simd/streams.h"
#include "simd/trace_crowd-inl.h"
#include "simd/trace_frustum-inl.h"
#include "simd/trace_sheet-inl.h"
#include "simd/tree.h"

HWY_BEFORE_NAMESPACE();
namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE {

// FitsWideBoxes of src/scalar/ray_slabs.h, for the rays of `lanes`: the bits of those that pass.
template <typename Real>
HWY_INLINE std::uint32_t FitWideBoxes(const Packet<Real>& packet, std::uint32_t lanes) {
  std::uint32_t fit = 0;
  for (std::uint32_t rest = lanes; rest != 0; rest &= rest - 1) {
    const int lane = std::countr_zero(rest);
    Real size = 0, furthest = 0;
    for (int axis = 0; axis < 3; ++axis) {
      size = std::max(size, std::abs(packet.direction[axis][lane]));
      furthest = std::max(furthest, std::abs(packet.origin[axis][lane]));
    }
    const bool fits = furthest <= Real(kMaxBoxCoordinate) &&
                      static_cast<double>(size) >= kMinWideDirection &&
                      static_cast<double>(size) <= kMaxWideDirection;
    fit |= static_cast<std::uint32_t>(fits) << lane;
  }
  return fit;
}

// Traces the packet's rays of `lanes`, which box tests in Real do not hold for.
template <Query kQuery, typename Real>
HWY_NOINLINE void TraceOddRays(const TreeView<Real>& tree, Packet<Real>& packet,
                               std::uint32_t lanes) {
  const std::uint32_t fit = FitWideBoxes(packet, lanes);
  TraceRays<kQuery, WideSlabs<Real>>(tree, packet, fit, 0);
  TraceEveryLeaf<kQuery>(tree, packet, lanes & ~fit);
}

// Traces the packet's open rays without those of other packets.
template <Query kQuery, typename Real>
HWY_INLINE void TraceAlone(const TreeView<Real>& tree, BeamStack<Real>& stack,
                           Packet<Real>& packet) {
  PrepareBoxes(tree, packet);
  if (packet.without_boxes != 0) TraceOddRays<kQuery>(tree, packet, packet.without_boxes);
  TracePacket<kQuery>(tree, stack, packet, OpenLanes(packet) & ~packet.without_boxes, 0);
}

// Traces the strays at `sorted`, packet by packet.
template <class Output, typename Real>
HWY_NOINLINE void TraceStrayPackets(const Batch<Output, Real>& batch, const std::uint32_t* sorted,
                                    std::uint32_t count) {
  const std::uint32_t lanes = LaneCount(Lanes<Real>());
  Packet<Real> packet;
  for (std::uint32_t i = 0; i < count; i += lanes) {
    const std::uint32_t n = std::min(lanes, count - i);
    GatherPacket(batch.rays, batch.intervals, sorted + i, n, packet);
    PrepareLeafTerms(batch.tree, packet);
    TraceAlone<Output::kQuery>(batch.tree, batch.stack, packet);
    batch.output.Scatter(packet, sorted + i, n);
  }
}

// Traces as many of the strays at `sorted` as there is room for as a crowd. Returns their number.
template <class Output, typename Real>
HWY_NOINLINE std::uint32_t TraceStrayCrowd(const Batch<Output, Real>& batch,
                                           const std::uint32_t* sorted, std::uint32_t count,
                                           Crowd<Real>& crowd) {
  const std::uint32_t lanes = LaneCount(Lanes<Real>());
  count = std::min(count, Crowd<Real>::kPackets * lanes);
  for (std::uint32_t i = 0; i < count; i += lanes) {
    Packet<Real>& packet = crowd.packets[i / lanes];
    GatherPacket(batch.rays, batch.intervals, sorted + i, std::min(lanes, count - i), packet);
    PrepareLeafTerms(batch.tree, packet);
    PrepareBoxes(batch.tree, packet);
    if (packet.without_boxes != 0) {
      TraceOddRays<Output::kQuery>(batch.tree, packet, packet.without_boxes);
    }
  }
  TraceCrowd<Output::kQuery>(batch.tree, crowd, count);
  for (std::uint32_t i = 0; i < count; i += lanes) {
    batch.output.Scatter(crowd.packets[i / lanes], sorted + i, std::min(lanes, count - i));
  }
  return count;
}

// Whether strays are faster as a crowd than packet by packet: where few of them go the same way for
// long. In large trees they do not, and the less the more octants neighbours see. Measured
// (docs/benchmarking.md).
template <typename Real>
HWY_INLINE bool AreCrowd(const TreeView<Real>& tree, const StrayRays& strays) {
  constexpr std::uint32_t kLeastRays = 384;
  constexpr std::uint32_t kLeastNodes = 256, kLeastNodesInOrder = 1u << 14;
  const bool are_in_order = 2 * strays.octants < 5 * strays.vectors;
  // One lane has nothing to fill.
  return LaneCount(Lanes<Real>()) > 1 && strays.count >= kLeastRays &&
         tree.node_count >= (are_in_order ? kLeastNodesInOrder : kLeastNodes);
}

template <class Output, typename Real>
HWY_NOINLINE void TraceStrays(const Batch<Output, Real>& batch, StrayRays& strays) {
  std::uint32_t sorted[StrayRays::kMany + kMaxLanes];
  SortByDirection(strays, sorted);
  Crowd<Real>* const crowd = AreCrowd(batch.tree, strays) ? CrowdOfThread<Real>() : nullptr;
  if (crowd) {
    for (std::uint32_t i = 0; i < strays.count;) {
      i += TraceStrayCrowd(batch, sorted + i, strays.count - i, *crowd);
    }
  } else {
    TraceStrayPackets(batch, sorted, strays.count);
  }
  strays.count = strays.vectors = strays.octants = 0;
}

// Whether there is room for more strays now, because they are a crowd.
template <typename Real>
HWY_NOINLINE bool MakeRoom(const TreeView<Real>& tree, StrayRays& strays) {
  if (strays.capacity == StrayRays::kMany || !AreCrowd(tree, strays)) return false;
  Crowd<Real>* const crowd = CrowdOfThread<Real>();
  if (!crowd) return false;
  strays.MoveTo(crowd->offsets, crowd->classes);
  return true;
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
  TraceSheet<Output::kQuery>(batch.tree, batch.stack, sheet);
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
    TraceAlone<Output::kQuery>(batch.tree, batch.stack, packet);
  }
  batch.output.Store(packet, i);
}

// Traces the rays from `begin` on as a frustum and returns true, where they can be one.
template <class Output, typename Real>
HWY_NOINLINE bool TraceAsFrustum(const Batch<Output, Real>& batch, std::uint32_t begin) {
  Frustum<Real> frustum;
  if (!PrepareFrustum(batch, begin, frustum)) return false;
  TraceFrustum(batch, frustum);
  return true;
}

// Takes a square of packets at a time. They go as a frustum, as a sheet or packet by packet, or are
// set aside as strays to be sorted by direction.
template <class Output, typename Real>
HWY_INLINE void TraceBatch(const Batch<Output, Real>& batch, Coherence coherence) {
  const TreeView<Real>& tree = batch.tree;
  const std::uint32_t lanes = LaneCount(Lanes<Real>());
  StrayRays strays;
  // On one lane a frustum is a single ray. It gains nothing where boxes do not pay.
  const bool may_be_frustum =
      tree.node_count > 0 && !(tree.skips_boxes && lanes == 1) &&
      (coherence == Coherence::kUnknown || coherence == Coherence::kCommonOrigin);
  const bool may_be_sheet = coherence == Coherence::kUnknown && !tree.skips_boxes;
  const bool may_stray = coherence != Coherence::kCoherent && !tree.skips_boxes;
  for (std::uint32_t begin = 0; begin < batch.count; begin += lanes * lanes) {
    const std::uint32_t end = std::min(batch.count, begin + lanes * lanes);
    // So few rays go on one by one anyway.
    const bool has_company = end - begin > lanes / 4;
    if (may_be_frustum && has_company && TraceAsFrustum(batch, begin)) continue;
    if (may_be_sheet && has_company && TraceAsSheet(batch, begin, end)) continue;
    const bool is_full = strays.count + lanes * lanes > strays.capacity;
    const bool is_far = strays.count > 0 && end - strays.first > StrayRays::kSpan;
    if (is_far || (is_full && !MakeRoom(tree, strays))) TraceStrays(batch, strays);
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
