// Traces a packet: together while enough of its rays go the same way, then ray by ray.
#if defined(SHEAF_SIMD_TRACE_PACKET_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SHEAF_SIMD_TRACE_PACKET_INL_H_
#undef SHEAF_SIMD_TRACE_PACKET_INL_H_
#else
#define SHEAF_SIMD_TRACE_PACKET_INL_H_
#endif

#include "simd/query.h"
#include "simd/trace_beam-inl.h"
#include "simd/tree.h"

HWY_BEFORE_NAMESPACE();
namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE {

// With this many rays left, or fewer, they go on one by one.
template <typename Real>
HWY_INLINE std::uint32_t FewRays() {
  return std::max(1u, LaneCount(Lanes<Real>()) / 4);
}

// The beam whose lanes are the rays of `lanes` (bits), all of one octant.
template <typename Real>
HWY_INLINE void MakeBeam(const Packet<Real>& packet, std::uint32_t lanes, Beam<Real>& beam) {
  const Lanes<Real> d;
  const auto first = std::countr_zero(lanes);
  const auto in_beam = LanesFromBits(d, lanes);
  const auto others_as_first = [&](const Real(&values)[kPacketSize<Real>]) SHEAF_LAMBDA {
    return hn::IfThenElse(in_beam, hn::Load(d, values), hn::Set(d, values[first]));
  };
  const auto lowest = [&](auto v) SHEAF_LAMBDA { return hn::GetLane(hn::MinOfLanes(d, v)); };
  const auto highest = [&](auto v) SHEAF_LAMBDA { return hn::GetLane(hn::MaxOfLanes(d, v)); };
  beam.octant = packet.octant[first];
  for (int axis = 0; axis < 3; ++axis) {
    const auto scale = hn::Load(d, packet.scale[axis]);
    hn::Store(scale, d, beam.enter_scale[axis]);
    hn::Store(scale, d, beam.leave_scale[axis]);
    hn::Store(hn::Load(d, packet.enter[axis]), d, beam.enter[axis]);
    hn::Store(hn::Load(d, packet.leave[axis]), d, beam.leave[axis]);

    const auto scales = others_as_first(packet.scale[axis]);
    const auto origins = others_as_first(packet.origin[axis]);
    const auto slack = others_as_first(packet.slack[axis]);
    const auto ahead = hn::Add(origins, slack), behind = hn::Sub(origins, slack);
    if (beam.octant >> axis & 1) {
      beam.all_enter[axis] = lowest(ahead);
      beam.all_leave[axis] = highest(behind);
      beam.all_enter_scale[axis] = highest(scales);
      beam.all_leave_scale[axis] = lowest(scales);
    } else {
      beam.all_enter[axis] = highest(ahead);
      beam.all_leave[axis] = lowest(behind);
      beam.all_enter_scale[axis] = lowest(scales);
      beam.all_leave_scale[axis] = highest(scales);
    }
  }
  const auto t_min = others_as_first(packet.t_min);
  hn::Store(t_min, d, beam.t_min);
  beam.all_t_min = lowest(t_min);
}

template <typename Real>
HWY_INLINE void UpdateRayEnds(const Packet<Real>& packet, std::uint32_t lanes, Beam<Real>& beam) {
  const Lanes<Real> d;
  // Finite, so that a box whose entry is infinite is never met.
  const auto last = hn::Min(hn::Mul(hn::Load(d, packet.t_best), hn::Set(d, Real(kBoxFarFactor))),
                            hn::Set(d, kDefaultTMax<Real>));
  hn::Store(hn::IfThenElse(LanesFromBits(d, lanes), last, hn::Set(d, kDone<Real>)), d, beam.t_last);
}

// Bits of the leaf's primitives whose boxes the beam may meet.
template <typename Real>
HWY_NOINLINE std::uint32_t CullLeaf(const TreeView<Real>& tree, std::uint32_t leaf,
                                    const Beam<Real>& beam) {
  const Lanes<Real> d;
  const LeafLanes<Real> d8;
  const std::uint32_t n = LeafCount(leaf);
  const auto t_last = hn::Set(d8, hn::GetLane(hn::MaxOfLanes(d, hn::Load(d, beam.t_last))));
  const auto growth = hn::Set(d8, Real(kBoxGrowth));
  std::uint32_t met = 0;
  // Of anything but triangles the first four fields are a sphere around it.
  const bool are_triangles = HasTriangles(leaf);
  const Real* first_field = BlockOf(tree, leaf);
  for (std::uint32_t i = 0; i < n; i += LaneCount(d8)) {
    const Real* block = first_field + i;
    const auto field = [&](int k) SHEAF_LAMBDA { return hn::LoadU(d8, block + k * n); };
    const auto low = [&](int axis) SHEAF_LAMBDA {
      if (!are_triangles) return hn::Sub(field(axis), field(3));
      return hn::Min(hn::Min(field(axis), field(3 + axis)), field(6 + axis));
    };
    const auto high = [&](int axis) SHEAF_LAMBDA {
      if (!are_triangles) return hn::Add(field(axis), field(3));
      return hn::Max(hn::Max(field(axis), field(3 + axis)), field(6 + axis));
    };
    const auto lower = [&](int axis) SHEAF_LAMBDA {
      return hn::NegMulAdd(hn::Sub(high(axis), low(axis)), growth, low(axis));
    };
    const auto upper = [&](int axis) SHEAF_LAMBDA {
      return hn::MulAdd(hn::Sub(high(axis), low(axis)), growth, high(axis));
    };
    const auto in = [&](int axis) SHEAF_LAMBDA {
      return beam.octant >> axis & 1 ? upper(axis) : lower(axis);
    };
    const auto out = [&](int axis) SHEAF_LAMBDA {
      return beam.octant >> axis & 1 ? lower(axis) : upper(axis);
    };
    met |= MaskBits(d8, BeamMeets(d8, beam, in(0), in(1), in(2), out(0), out(1), out(2), t_last))
           << i;
  }
  return met & ((1u << n) - 1);
}

// Traces the rays of `lanes` (bits), all of one octant, through the subtree of the child `start`.
template <Query kQuery, typename Real>
HWY_NOINLINE void TracePacketFrom(const TreeView<Real>& tree, BeamStack<Real>& stack,
                                  Packet<Real>& packet, std::uint32_t lanes, std::uint32_t start) {
  const Lanes<Real> d;
  Beam<Real> beam;
  MakeBeam(packet, lanes, beam);
  UpdateRayEnds(packet, lanes, beam);
  TraceBeam(tree, stack, beam, start, [&](std::uint32_t child, auto met) SHEAF_LAMBDA {
    const std::uint32_t bits = MaskBits(d, met);
    if (static_cast<std::uint32_t>(std::popcount(bits)) <= FewRays<Real>()) {
      TraceRays<kQuery, LaneSlabs<Real>>(tree, packet, bits, child);
    } else if (IsLeaf(child)) {
      LeafAgainstPacket<kQuery>(d, tree, child, CullLeaf(tree, child, beam), packet, met);
    } else {
      return Visit::kDescend;
    }
    UpdateRayEnds(packet, lanes, beam);
    return Visit::kDone;
  });
}

// Tests the packet's rays of `lanes` against every leaf. For scenes of few primitives, and for rays
// outside the limits of all box tests.
template <Query kQuery, typename Real>
HWY_NOINLINE void TraceEveryLeaf(const TreeView<Real>& tree, Packet<Real>& packet,
                                 std::uint32_t lanes) {
  const Lanes<Real> d;
  for (std::uint32_t i = 0; i < tree.node_count; ++i) {
    for (const std::uint32_t child : tree.nodes[i].child) {
      if (!IsLeaf(child) || child == kNoChild) continue;
      lanes &= OpenLanes(packet);
      if (lanes == 0) return;
      LeafAgainstPacket<kQuery>(d, tree, child, (1u << LeafCount(child)) - 1, packet,
                                LanesFromBits(d, lanes));
    }
  }
}

// Traces the rays of `lanes` (bits) through the subtree of the child `start`, octant by octant. An
// octant of half a packet or less is too incoherent for a packet: its rays go one by one.
template <Query kQuery, typename Real>
HWY_INLINE void TracePacket(const TreeView<Real>& tree, BeamStack<Real>& stack,
                            Packet<Real>& packet, std::uint32_t lanes, std::uint32_t start) {
  const std::uint32_t lane_count = LaneCount(Lanes<Real>());
  while (lanes != 0) {
    const std::uint32_t octant = packet.octant[std::countr_zero(lanes)];
    std::uint32_t alike = 0;
    for (std::uint32_t lane = 0; lane < lane_count; ++lane) {
      alike |= static_cast<std::uint32_t>(packet.octant[lane] == octant) << lane;
    }
    alike &= lanes;
    lanes &= ~alike;
    if (static_cast<std::uint32_t>(std::popcount(alike)) <= lane_count / 2) {
      TraceRays<kQuery, LaneSlabs<Real>>(tree, packet, alike, start);
    } else {
      TracePacketFrom<kQuery>(tree, stack, packet, alike, start);
    }
  }
}

}  // namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // SHEAF_SIMD_TRACE_PACKET_INL_H_
