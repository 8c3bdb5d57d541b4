// A sheet: as many packets as the target has lanes, with one direction, through the tree together:
// the rays of a directional light or of an orthographic camera.
//
// A lane of the beam is a packet. It enters a box where the first of its rays does, and leaves it
// where the last does. In leaves the packets go on one by one.
#if defined(SHEAF_SIMD_TRACE_SHEET_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SHEAF_SIMD_TRACE_SHEET_INL_H_
#undef SHEAF_SIMD_TRACE_SHEET_INL_H_
#else
#define SHEAF_SIMD_TRACE_SHEET_INL_H_
#endif

#include "simd/query.h"
#include "simd/trace_packet-inl.h"
#include "simd/tree.h"

HWY_BEFORE_NAMESPACE();
namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE {

// Up to so many packets of a sheet go on as packets.
template <Query kQuery, typename Real>
HWY_INLINE std::uint32_t FewPacketsOfSheet() {
  return std::max(1u, LaneCount(Lanes<Real>()) / (kQuery == Query::kOccluded ? 2 : 8));
}

template <typename Real>
struct alignas(kAlignment) Sheet {
  Packet<Real> packets[kPacketSize<Real>];
  std::uint32_t count;  // packets in use
  Beam<Real> beam;
};

// Whether all open rays have one direction, to the bit.
template <typename Real>
HWY_INLINE bool HasOneDirection(const Sheet<Real>& sheet) {
  const Lanes<Real> d;
  const Packet<Real>& first = sheet.packets[0];
  const std::uint32_t open_in_first = OpenLanes(first);
  if (open_in_first == 0) return false;
  const int one = std::countr_zero(open_in_first);
  for (std::uint32_t k = 0; k < sheet.count; ++k) {
    const Packet<Real>& packet = sheet.packets[k];
    auto alike = AllLanes(d);
    for (int axis = 0; axis < 3; ++axis) {
      alike = hn::And(alike, hn::Eq(hn::Load(d, packet.direction[axis]),
                                    hn::Set(d, first.direction[axis][one])));
    }
    if (!hn::AllFalse(d, hn::AndNot(alike, OpenMask(d, packet)))) return false;
  }
  return true;
}

// The largest t at which an open ray of the packet may still hit.
template <typename Real>
HWY_INLINE Real LastT(const Packet<Real>& packet) {
  const Lanes<Real> d;
  const Real t = hn::GetLane(hn::MaxOfLanes(d, hn::Load(d, packet.t_best)));
  return std::min(t * Real(kBoxFarFactor), kDefaultTMax<Real>);
}

// Returns whether the packets' rays can go as a sheet. Then their box terms and the beam are ready.
template <typename Real>
HWY_INLINE bool PrepareSheet(const TreeView<Real>& tree, Sheet<Real>& sheet) {
  if (!HasOneDirection(sheet)) return false;
  const Lanes<Real> d;
  Beam<Real>& beam = sheet.beam;
  const Packet<Real>& first = sheet.packets[0];
  const int one = std::countr_zero(OpenLanes(first));
  std::uint32_t unfit = 0;
  for (std::uint32_t k = 0; k < sheet.count; ++k) {
    Packet<Real>& packet = sheet.packets[k];
    PrepareBoxes(tree, packet);
    // +0 and -0 are equal but of different octants.
    for (std::uint32_t lane = 0; lane < LaneCount(d); ++lane) {
      unfit |= static_cast<std::uint32_t>(packet.octant[lane] != first.octant[one]) << lane &
               OpenLanes(packet);
    }
    unfit |= packet.without_boxes;
  }
  if (unfit != 0) return false;

  beam.octant = first.octant[one];
  Real of_packets = 0, of_sheet = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const bool backward = beam.octant >> axis & 1;
    Real lowest_of_all = kDefaultTMax<Real>, highest_of_all = -lowest_of_all;
    const Real scale = first.scale[axis][one];
    Real furthest = backward ? kDefaultTMax<Real> : -kDefaultTMax<Real>, rearmost = -furthest;
    for (std::uint32_t k = 0; k < LaneCount(d); ++k) {
      beam.enter_scale[axis][k] = beam.leave_scale[axis][k] = scale;
      beam.enter[axis][k] = beam.leave[axis][k] = 0;
      const std::uint32_t open = k < sheet.count ? OpenLanes(sheet.packets[k]) : 0;
      if (open == 0) continue;
      const auto lanes = LanesFromBits(d, open);
      const Packet<Real>& packet = sheet.packets[k];
      const auto origin = hn::Load(d, packet.origin[axis]);
      const auto most = hn::Set(d, kDefaultTMax<Real>);
      const auto lowest = [&](auto v) SHEAF_LAMBDA {
        return hn::GetLane(hn::MinOfLanes(d, hn::IfThenElse(lanes, v, most)));
      };
      const auto highest = [&](auto v) SHEAF_LAMBDA {
        return hn::GetLane(hn::MaxOfLanes(d, hn::IfThenElse(lanes, v, hn::Neg(most))));
      };
      beam.enter[axis][k] = lowest(hn::Load(d, packet.enter[axis]));
      beam.leave[axis][k] = highest(hn::Load(d, packet.leave[axis]));
      const Real low = lowest(origin), high = highest(origin);
      of_packets += high - low;
      lowest_of_all = std::min(lowest_of_all, low);
      highest_of_all = std::max(highest_of_all, high);
      const auto ahead = hn::Add(origin, hn::Load(d, packet.slack[axis]));
      const auto behind = hn::Sub(origin, hn::Load(d, packet.slack[axis]));
      furthest = backward ? std::min(furthest, lowest(ahead)) : std::max(furthest, highest(ahead));
      rearmost =
          backward ? std::max(rearmost, highest(behind)) : std::min(rearmost, lowest(behind));
    }
    beam.all_enter[axis] = furthest;
    beam.all_leave[axis] = rearmost;
    beam.all_enter_scale[axis] = beam.all_leave_scale[axis] = scale;
    of_sheet += highest_of_all - lowest_of_all;
  }
  // A packet whose rays start all over the sheet would meet as many boxes as the sheet does.
  if (2 * of_packets > of_sheet * static_cast<Real>(sheet.count)) return false;
  for (std::uint32_t k = 0; k < LaneCount(d); ++k) {
    beam.t_min[k] = 0;
    beam.t_last[k] = k < sheet.count ? LastT(sheet.packets[k]) : kDone<Real>;
  }
  beam.all_t_min = 0;
  return true;
}

// PrepareSheet has returned true.
template <Query kQuery, typename Real>
HWY_NOINLINE void TraceSheet(const TreeView<Real>& tree, BeamStack<Real>& stack,
                             Sheet<Real>& sheet) {
  const Lanes<Real> d;
  TraceBeam(tree, stack, sheet.beam, 0, [&](std::uint32_t child, auto met) SHEAF_LAMBDA {
    std::uint32_t packets = MaskBits(d, met);
    const bool are_few =
        static_cast<std::uint32_t>(std::popcount(packets)) <= FewPacketsOfSheet<kQuery, Real>();
    if (!IsLeaf(child) && !are_few) return Visit::kDescend;
    for (; packets != 0; packets &= packets - 1) {
      const auto k = static_cast<std::uint32_t>(std::countr_zero(packets));
      Packet<Real>& packet = sheet.packets[k];
      TracePacket<kQuery>(tree, stack, packet, OpenLanes(packet), child);
      sheet.beam.t_last[k] = LastT(packet);
    }
    return Visit::kDone;
  });
}

}  // namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // SHEAF_SIMD_TRACE_SHEET_INL_H_
