// Traces a crowd: rays of one octant, each of which goes its own way. Every node has the list of
// those that may meet it. A vector of them at a time is tested against its children, so that all
// lanes work however far neighbours have gone apart, and each child gets its own list. Lists that
// have become short go on ray by ray. After Barringer and Akenine-Möller, "Dynamic Ray Stream
// Traversal" (2014), which tests one ray at a time.
#if defined(SHEAF_SIMD_TRACE_CROWD_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SHEAF_SIMD_TRACE_CROWD_INL_H_
#undef SHEAF_SIMD_TRACE_CROWD_INL_H_
#else
#define SHEAF_SIMD_TRACE_CROWD_INL_H_
#endif

#include <algorithm>
#include <bit>
#include <cstdint>
#include <memory>
#include <new>

#include "simd/compact-inl.h"
#include "simd/query.h"
#include "simd/stray_rays-inl.h"
#include "simd/trace_ray-inl.h"
#include "simd/tree.h"

HWY_BEFORE_NAMESPACE();
namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE {

// So many rays of a list, or fewer, go on one by one: at nodes, and at leaves.
inline constexpr std::uint32_t kFewAtNode = 4;
inline constexpr std::uint32_t kFewAtLeaf = 5;

// Rays, packet by packet, and the lists of them. A ray's slot is how far its lane's numbers are
// from those of the first packet's first lane, in numbers: what gathers ask for.
template <typename Real>
struct Crowd {
  static constexpr std::uint32_t kPackets = StrayRays::kMany / kPacketSize<Real>;
  static constexpr std::uint32_t kStride = sizeof(Packet<Real>) / sizeof(Real);
  static_assert(sizeof(Packet<Real>) % sizeof(Real) == 0);
  static constexpr std::uint32_t kMostListed = 1024;  // rays that the root's list has at most
  // Room for the lists of two levels even if every ray meets every child. Where lists are longer,
  // rays go on one by one.
  static constexpr std::uint32_t kEntries = 3 * kTreeWidth * kMostListed;

  Packet<Real> packets[kPackets];
  // Slots of the rays of each list, and where they enter the child that it belongs to.
  std::uint32_t slot[kEntries + kMaxLanes];
  Real enter[kEntries + kMaxLanes];
  std::uint32_t open[kMostListed];  // slots of rays that a leaf is tested against
  // Of strays that wait.
  std::uint16_t offsets[StrayRays::kMany];
  std::uint8_t classes[StrayRays::kMany];

  HWY_INLINE Packet<Real>& packet(std::uint32_t of_slot) { return packets[of_slot / kStride]; }
  static HWY_INLINE std::uint32_t lane(std::uint32_t of_slot) { return of_slot % kStride; }
};

// A crowd for this thread, with anything in it; null where there is no memory. Some threads' stacks
// have no room for it, and make_unique would write all of it.
template <typename Real>
HWY_INLINE Crowd<Real>* CrowdOfThread() {
  static thread_local std::unique_ptr<Crowd<Real>> crowd;
  if (!crowd) crowd.reset(new (std::nothrow) Crowd<Real>);
  return crowd.get();
}

// A child to be visited by the rays of entries [begin, begin + count).
struct RayList {
  std::uint32_t child, begin, count;
};

// Takes every ray of the list to its child, a node, alone.
template <Query kQuery, typename Real>
HWY_INLINE void VisitAlone(const TreeView<Real>& tree, Crowd<Real>& crowd, const RayList& list) {
  for (std::uint32_t k = list.begin; k < list.begin + list.count; ++k) {
    const std::uint32_t lane = crowd.lane(crowd.slot[k]);
    Packet<Real>& packet = crowd.packet(crowd.slot[k]);
    if (!(crowd.enter[k] <= LaneSlabs<Real>::LastOf(packet.t_best[lane]))) continue;
    TraceRay<kQuery, LaneSlabs<Real>>(tree, packet, lane, list.child);
  }
}

// Up to a vector of rays against a leaf, as a packet of their own.
template <Query kQuery, typename Real>
HWY_NOINLINE void LeafTogether(const TreeView<Real>& tree, std::uint32_t leaf, Crowd<Real>& crowd,
                               const std::uint32_t* slots, std::uint32_t count) {
  const Lanes<Real> d;
  const std::uint32_t lanes = LaneCount(d);
  const auto wanted = LanesBelow(d, 0, count);
  alignas(kAlignment) std::uint32_t slot[kMaxLanes];
  for (std::uint32_t k = 0; k < lanes; ++k) slot[k] = slots[k < count ? k : 0];
  const auto at = LoadIds(d, slot);
  Packet<Real>& all = crowd.packets[0];
  Packet<Real> packet;
  ForgetHits(packet);
  const auto gather = [&](const Real* from, Real* to)
                          SHEAF_LAMBDA { hn::Store(GatherAt(d, from, at), d, to); };
  for (int axis = 0; axis < 3; ++axis) {
    gather(all.origin[axis], packet.origin[axis]);
    gather(all.direction[axis], packet.direction[axis]);
  }
  gather(all.t_min, packet.t_min);
  gather(all.t_best, packet.t_best);
  gather(all.shear_x, packet.shear_x);
  gather(all.shear_y, packet.shear_y);
  if (HasScreened(tree)) gather(all.screen, packet.screen);
  alignas(kAlignment) std::uint32_t id[kMaxLanes];
  for (std::uint32_t k = 0; k < lanes; ++k) {
    const Packet<Real>& from = crowd.packet(slot[k]);
    const std::uint32_t lane = crowd.lane(slot[k]);
    packet.source[k] = from.source[lane];
    packet.axis[k] = from.axis[lane];
    packet.id[k] = id[k] = from.id[lane];
  }
  LeafAgainstPacket<kQuery>(d, tree, leaf, (1u << LeafCount(leaf)) - 1, packet, wanted);
  // A ray never has another hit with the id of the one that it had.
  const auto kept = hn::RebindMask(d, hn::Eq(LoadIds(d, id), LoadIds(d, packet.id)));
  for (std::uint32_t bits = MaskBits(d, hn::AndNot(kept, wanted)); bits != 0; bits &= bits - 1) {
    const auto k = static_cast<std::uint32_t>(std::countr_zero(bits));
    const std::uint32_t lane = crowd.lane(slot[k]);
    Packet<Real>& to = crowd.packet(slot[k]);
    to.t_best[lane] = packet.t_best[k];
    to.id[lane] = packet.id[k];
    to.u[lane] = packet.u[k];
    to.v[lane] = packet.v[k];
    to.det[lane] = packet.det[k];
  }
}

template <Query kQuery, typename Real>
HWY_INLINE void VisitLeaf(const TreeView<Real>& tree, Crowd<Real>& crowd, const RayList& list) {
  const std::uint32_t lanes = LaneCount(Lanes<Real>());
  // Since the list was made, rays may have come to their end.
  std::uint32_t count = 0;
  for (std::uint32_t k = list.begin; k < list.begin + list.count; ++k) {
    const std::uint32_t slot = crowd.slot[k];
    crowd.open[count] = slot;
    const Real t_best = crowd.packet(slot).t_best[crowd.lane(slot)];
    count += crowd.enter[k] <= LaneSlabs<Real>::LastOf(t_best) ? 1 : 0;
  }
  std::uint32_t k = 0;
  for (; count - k > kFewAtLeaf; k += std::min(lanes, count - k)) {
    LeafTogether<kQuery>(tree, list.child, crowd, crowd.open + k, std::min(lanes, count - k));
  }
  for (; k < count; ++k) {
    LeafAgainstRay<kQuery>(tree, list.child, crowd.packet(crowd.open[k]),
                           crowd.lane(crowd.open[k]));
  }
}

// Lists the rays that meet each child of a node, counts[k] of them from entry `top` + k * `stride`
// on for the k-th child from behind. Lists have room for whole vectors.
template <typename Real>
HWY_INLINE void ListByChild(const TreeNode& node, std::uint32_t octant, const RayList& list,
                            std::uint32_t top, std::uint32_t stride, Crowd<Real>& crowd,
                            std::uint32_t (&counts)[kTreeWidth]) {
  const Lanes<Real> d;
  const IdLanes<Lanes<Real>> di;
  const SlabRows rows(octant);
  const auto far_factor = hn::Set(d, Real(kBoxFarFactor));
  const Packet<Real>& all = crowd.packets[0];
  for (std::uint32_t& count : counts) count = 0;
  for (std::uint32_t i = 0; i < list.count; i += LaneCount(d)) {
    const auto lanes = LanesBelow(d, i, list.count);
    const auto slots = LoadIds(d, crowd.slot + list.begin + i);
    const auto at = hn::IfThenElseZero(hn::RebindMask(di, lanes), slots);
    const auto gather = [&](const Real* field) SHEAF_LAMBDA { return GatherAt(d, field, at); };
    const auto scale_x = gather(all.scale[0]), scale_y = gather(all.scale[1]),
               scale_z = gather(all.scale[2]);
    const auto enter_x = gather(all.enter[0]), enter_y = gather(all.enter[1]),
               enter_z = gather(all.enter[2]);
    const auto leave_x = gather(all.leave[0]), leave_y = gather(all.leave[1]),
               leave_z = gather(all.leave[2]);
    const auto t_min = gather(all.t_min);
    const auto last =
        hn::IfThenElse(lanes, hn::Mul(gather(all.t_best), far_factor), hn::Set(d, kDone<Real>));
    std::uint32_t order = node.order[octant];
    for (std::uint32_t k = 0; k < kTreeWidth; ++k) {
      const std::uint32_t child = order >> 28;
      order <<= 4;
      const auto plane = [&](std::size_t row) SHEAF_LAMBDA {
        return hn::Set(d, static_cast<Real>(node.bounds[row][child]));
      };
      const auto enter = hn::Max(hn::Max(hn::MulAdd(plane(rows.in_x), scale_x, enter_x),
                                         hn::MulAdd(plane(rows.in_y), scale_y, enter_y)),
                                 hn::Max(hn::MulAdd(plane(rows.in_z), scale_z, enter_z), t_min));
      const auto leave = hn::Min(hn::Min(hn::MulAdd(plane(rows.out_x), scale_x, leave_x),
                                         hn::MulAdd(plane(rows.out_y), scale_y, leave_y)),
                                 hn::MulAdd(plane(rows.out_z), scale_z, leave_z));
      const auto meets = hn::Le(enter, hn::Min(hn::Mul(leave, far_factor), last));
      const auto compact = CompactOrder(d, meets);
      const std::uint32_t to = top + k * stride + counts[k];
      CompactStore(d, enter, compact, crowd.enter + to);
      CompactStoreIds(d, slots, compact, crowd.slot + to);
      counts[k] += CountLanes(d, meets);
    }
  }
}

// Moves `count` entries of lists to an earlier place, which they may overlap.
template <typename Real>
HWY_INLINE void MoveEntries(Crowd<Real>& crowd, std::uint32_t from, std::uint32_t count,
                            std::uint32_t to) {
  const Lanes<Real> d;
  for (std::uint32_t i = 0; i < count; i += LaneCount(d)) {
    hn::StoreU(hn::LoadU(d, crowd.enter + from + i), d, crowd.enter + to + i);
    StoreIds(d, LoadIds(d, crowd.slot + from + i), crowd.slot + to + i);
  }
}

// Traces the rays of the crowd's first list of `count`, all of `octant`.
template <Query kQuery, typename Real>
HWY_NOINLINE void TraceList(const TreeView<Real>& tree, Crowd<Real>& crowd, std::uint32_t count,
                            std::uint32_t octant) {
  const std::uint32_t lanes = LaneCount(Lanes<Real>());
  RayList stack[kTreeStackSize];
  std::uint32_t size = 0;
  stack[size++] = {0, 0, count};
  while (size > 0) {
    const RayList list = stack[--size];
    if (IsLeaf(list.child)) {
      VisitLeaf<kQuery>(tree, crowd, list);
      continue;
    }
    const std::uint32_t top = list.begin + list.count;
    const std::uint32_t stride = (list.count + lanes - 1) / lanes * lanes;
    const bool has_room = top + kTreeWidth * stride <= Crowd<Real>::kEntries;
    if (list.count <= kFewAtNode || !has_room) {
      VisitAlone<kQuery>(tree, crowd, list);
      continue;
    }
    const TreeNode& node = tree.nodes[list.child];
    std::uint32_t counts[kTreeWidth];
    ListByChild(node, octant, list, top, stride, crowd, counts);
    // The lists take the place of the node's. The nearest child's comes last.
    std::uint32_t order = node.order[octant], to = list.begin;
    for (std::uint32_t k = 0; k < kTreeWidth; ++k) {
      const std::uint32_t child = node.child[order >> 28];
      order <<= 4;
      if (counts[k] == 0) continue;
      MoveEntries(crowd, top + k * stride, counts[k], to);
      stack[size++] = {child, to, counts[k]};
      to += counts[k];
      FetchAhead(tree, child);
    }
  }
}

// Traces `count` rays that fill the crowd's packets one after the other, sorted by octant, but for
// those that box tests do not hold for.
template <Query kQuery, typename Real>
HWY_NOINLINE void TraceCrowd(const TreeView<Real>& tree, Crowd<Real>& crowd, std::uint32_t count) {
  const std::uint32_t lanes = LaneCount(Lanes<Real>());
  std::uint32_t listed = 0, octant = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t lane = i % lanes;
    const Packet<Real>& packet = crowd.packets[i / lanes];
    if ((packet.without_boxes >> lane & 1) != 0) continue;
    if (listed == Crowd<Real>::kMostListed || (listed > 0 && packet.octant[lane] != octant)) {
      TraceList<kQuery>(tree, crowd, listed, octant);
      listed = 0;
    }
    octant = packet.octant[lane];
    crowd.slot[listed] = i / lanes * Crowd<Real>::kStride + lane;
    crowd.enter[listed] = packet.t_min[lane];
    ++listed;
  }
  if (listed > 0) TraceList<kQuery>(tree, crowd, listed, octant);
}

}  // namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // SHEAF_SIMD_TRACE_CROWD_INL_H_
