// A sheet: as many packets as the target has lanes, with one direction, through the tree together:
// the rays of a directional light or of an orthographic camera.
//
// A lane of the bundle is a packet: it enters a box where the first of its rays does, and leaves it
// where the last does. Packets part at the leaves.
#if defined(SHEAF_SIMD_TRACE_SHEET_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SHEAF_SIMD_TRACE_SHEET_INL_H_
#undef SHEAF_SIMD_TRACE_SHEET_INL_H_
#else
#define SHEAF_SIMD_TRACE_SHEET_INL_H_
#endif

#include "simd/trace_tile-inl.h"

HWY_BEFORE_NAMESPACE();
namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE {

// Whether all open rays have one direction, to the bit.
template <typename Real>
HWY_INLINE bool HasOneDirection(const Tile<Real>& tile) {
  const Lanes<Real> d;
  const Packet<Real>& first = tile.packets[0];
  const std::uint32_t open_in_first = OpenLanes(first);
  if (open_in_first == 0) return false;
  const int one = std::countr_zero(open_in_first);
  for (std::uint32_t k = 0; k < tile.count; ++k) {
    const Packet<Real>& packet = tile.packets[k];
    auto alike = AllLanes(d);
    for (int axis = 0; axis < 3; ++axis) {
      alike = hn::And(alike, hn::Eq(hn::Load(d, packet.direction[axis]),
                                    hn::Set(d, first.direction[axis][one])));
    }
    if (!hn::AllFalse(d, hn::AndNot(alike, OpenMask(d, packet)))) return false;
  }
  return true;
}

// The furthest that an open ray of the packet still goes.
template <typename Real>
HWY_INLINE Real LastT(const Packet<Real>& packet) {
  const Lanes<Real> d;
  const Real t = hn::GetLane(hn::MaxOfLanes(d, hn::Load(d, packet.t_best)));
  return std::min(t * Real(kBoxFarFactor), kDefaultTMax<Real>);
}

// Whether the packets' rays can go as a sheet: then their boxes and the bundle are ready.
template <typename Real>
HWY_INLINE bool PrepareSheet(const TreeView<Real>& tree, Tile<Real>& tile) {
  if (!HasOneDirection(tile)) return false;
  const Lanes<Real> d;
  Bundle<Real>& bundle = tile.bundle;
  const Packet<Real>& first = tile.packets[0];
  const int one = std::countr_zero(OpenLanes(first));
  std::uint32_t unfit = 0;
  for (std::uint32_t k = 0; k < tile.count; ++k) {
    Packet<Real>& packet = tile.packets[k];
    PrepareBoxes(tree, packet);
    // +0 and -0 are equal but of different octants.
    for (std::uint32_t lane = 0; lane < LaneCount(d); ++lane) {
      unfit |= static_cast<std::uint32_t>(packet.octant[lane] != first.octant[one]) << lane &
               OpenLanes(packet);
    }
    unfit |= packet.without_boxes;
  }
  if (unfit != 0) return false;

  bundle.octant = first.octant[one];
  for (int axis = 0; axis < 3; ++axis) {
    const bool backward = bundle.octant >> axis & 1;
    const Real scale = first.scale[axis][one];
    Real furthest = backward ? kDefaultTMax<Real> : -kDefaultTMax<Real>, rearmost = -furthest;
    for (std::uint32_t k = 0; k < LaneCount(d); ++k) {
      bundle.enter_scale[axis][k] = bundle.leave_scale[axis][k] = scale;
      bundle.enter[axis][k] = bundle.leave[axis][k] = 0;
      const std::uint32_t open = k < tile.count ? OpenLanes(tile.packets[k]) : 0;
      if (open == 0) continue;
      const auto lanes = LanesFromBits(d, open);
      const Packet<Real>& packet = tile.packets[k];
      const auto origin = hn::Load(d, packet.origin[axis]);
      const auto most = hn::Set(d, kDefaultTMax<Real>);
      const auto lowest = [&](auto v) SHEAF_LAMBDA {
        return hn::GetLane(hn::MinOfLanes(d, hn::IfThenElse(lanes, v, most)));
      };
      const auto highest = [&](auto v) SHEAF_LAMBDA {
        return hn::GetLane(hn::MaxOfLanes(d, hn::IfThenElse(lanes, v, hn::Neg(most))));
      };
      bundle.enter[axis][k] = lowest(hn::Load(d, packet.enter[axis]));
      bundle.leave[axis][k] = highest(hn::Load(d, packet.leave[axis]));
      const auto ahead = hn::Add(origin, hn::Load(d, packet.slack[axis]));
      const auto behind = hn::Sub(origin, hn::Load(d, packet.slack[axis]));
      furthest = backward ? std::min(furthest, lowest(ahead)) : std::max(furthest, highest(ahead));
      rearmost =
          backward ? std::max(rearmost, highest(behind)) : std::min(rearmost, lowest(behind));
    }
    bundle.all_enter[axis] = furthest;
    bundle.all_leave[axis] = rearmost;
    bundle.all_enter_scale[axis] = bundle.all_leave_scale[axis] = scale;
  }
  for (std::uint32_t k = 0; k < LaneCount(d); ++k) {
    bundle.t_min[k] = 0;
    bundle.t_last[k] = k < tile.count ? LastT(tile.packets[k]) : kDone<Real>;
  }
  bundle.all_t_min = 0;
  return true;
}

// PrepareSheet has said yes.
template <Query kQuery, typename Real>
HWY_NOINLINE void TraceSheet(const TreeView<Real>& tree, Tile<Real>& tile) {
  const Lanes<Real> d;
  TraceBundle(tree, tile.bundle, 0, [&](std::uint32_t child, auto met) SHEAF_LAMBDA {
    std::uint32_t packets = MaskBits(d, met);
    const bool are_few =
        static_cast<std::uint32_t>(std::popcount(packets)) <= FewPackets<kQuery, Real>();
    if (!IsLeaf(child) && !are_few) return Visit::kDescend;
    for (; packets != 0; packets &= packets - 1) {
      const auto k = static_cast<std::uint32_t>(std::countr_zero(packets));
      Packet<Real>& packet = tile.packets[k];
      TracePacket<kQuery>(tree, packet, OpenLanes(packet), child);
      tile.bundle.t_last[k] = LastT(packet);
    }
    return Visit::kDone;
  });
}

}  // namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // SHEAF_SIMD_TRACE_SHEET_INL_H_
