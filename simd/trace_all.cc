#include "simd/trace_all.h"

#include <algorithm>
#include <vector>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simd/trace_all.cc"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "hwy/highway.h"
#include "simd/dispatch.h"
#include "simd/leaf-inl.h"
#include "simd/packet-inl.h"
#include "simd/slabs-inl.h"
#include "simd/trace-inl.h"

HWY_BEFORE_NAMESPACE();
namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE {

// One ray of a packet in every lane, so that the tests of a vector of rays take it against a vector
// of primitives, or against one of them. What they keep is the hit of each lane, to be collected.
template <typename Real>
struct alignas(kAlignment) RepeatedRay {
  static constexpr std::uint32_t kSize = kMaxLeafSize;
  using D = LeafLanes<Real>;

  Real origins[3][kSize], directions[3][kSize];
  Real shears[2][kSize], screens[kSize];
  Real t_min;
  int axis;
  std::uint32_t source;
  // Of the pair that is tested: see TestFrom.
  std::uint32_t tested_source;
  // As HitSlots has them.
  Real t[kSize], u[kSize], v[kSize], det[kSize];
  std::uint32_t id[kSize];

  HWY_INLINE RepeatedRay(const Packet<Real>& packet, std::uint32_t lane)
      : t_min(packet.t_min[lane]),
        axis(static_cast<int>(packet.axis[lane])),
        source(packet.source[lane]) {
    const D d;
    const auto repeat = [&](Real value, Real(&to)[kSize]) SHEAF_LAMBDA {
      for (std::uint32_t i = 0; i < kSize; i += LaneCount(d)) {
        hn::StoreU(hn::Set(d, value), d, to + i);
      }
    };
    for (int k = 0; k < 3; ++k) {
      repeat(packet.origin[k][lane], origins[k]);
      repeat(packet.direction[k][lane], directions[k]);
    }
    repeat(packet.shear_x[lane], shears[0]);
    repeat(packet.shear_y[lane], shears[1]);
    repeat(packet.screen[lane], screens);
  }

  // Forgets what is kept; hits up to `last` are wanted. Pairs go by the id 0, whatever primitive is
  // tested; a `from` of kInsideBit asks for the far root of a sphere alone.
  HWY_INLINE void TestFrom(std::uint32_t from, Real last) {
    const D d;
    tested_source = from;
    hn::StoreU(hn::Set(d, last), d, t);
    StoreIds(d, hn::Set(IdLanes<D>(), kNoPrimitive), id);
  }

  HWY_INLINE const Real* origin(int k) const { return origins[k]; }
  HWY_INLINE const Real* direction(int k) const { return directions[k]; }
  HWY_INLINE const Real* shear_x() const { return shears[0]; }
  HWY_INLINE const Real* shear_y() const { return shears[1]; }
  HWY_INLINE const Real* screen() const { return screens; }
  HWY_INLINE HitSlots<Real> slots() const {
    auto& self = const_cast<RepeatedRay&>(*this);
    return {self.t, self.u, self.v, self.det, self.id};
  }
  template <class DT>
  HWY_INLINE hn::Vec<DT> TMin(DT d) const {
    return hn::Set(d, t_min);
  }
  template <class DT>
  HWY_INLINE hn::Vec<IdLanes<DT>> Sources(DT /*d*/) const {
    return hn::Set(IdLanes<DT>(), hn::TFromD<IdLanes<DT>>{tested_source});
  }
};

// Neither a pair's id nor a far root's.
inline constexpr std::uint32_t kFromElsewhere = kNoPrimitive;

template <typename Real>
HWY_NOINLINE void CollectTriangles(const TreeView<Real>& tree, std::uint32_t leaf,
                                   RepeatedRay<Real>& ray, HitList<Real>& list) {
  const LeafLanes<Real> d;
  using V = hn::Vec<LeafLanes<Real>>;
  const std::uint32_t n = LeafCount(leaf);
  const std::uint32_t* ids = IdsOf<PrimitiveKind::kTriangle>(tree, leaf);
  const Real* block = BlockOf<PrimitiveKind::kTriangle>(tree, leaf);
  const int kx = (ray.axis + 1) % 3, ky = (ray.axis + 2) % 3;
  for (std::uint32_t i = 0; i < n; i += LaneCount(d)) {
    const auto relative = [&](int vertex, int k) SHEAF_LAMBDA -> V {
      return hn::Sub(hn::LoadU(d, block + (3 * vertex + k) * n + i), hn::Load(d, ray.origin(k)));
    };
    ray.TestFrom(kFromElsewhere, list.last());
    const auto hit = TriangleAgainstRays<Query::kClosest>(
        d, ray, ray.axis, relative(0, kx), relative(0, ky), relative(0, ray.axis), relative(1, kx),
        relative(1, ky), relative(1, ray.axis), relative(2, kx), relative(2, ky),
        relative(2, ray.axis), BlockColumns<Real>{block + i, n, 1}, 0, LanesBelow(d, i, n));
    for (std::uint32_t bits = MaskBits(d, hit); bits != 0; bits &= bits - 1) {
      const auto k = static_cast<std::uint32_t>(std::countr_zero(bits));
      if (ids[i + k] == (ray.source & ~kInsideBit)) continue;
      list.Add({ray.t[k], ids[i + k], ray.u[k] / ray.det[k], ray.v[k] / ray.det[k]});
    }
  }
}

// The hit of primitive `k` of a leaf that the screen let pass, if there is one.
template <class Test, typename Real>
HWY_INLINE bool TestOne(const TreeView<Real>& tree, std::uint32_t leaf, std::uint32_t k,
                        std::uint32_t from, Real last, RepeatedRay<Real>& ray) {
  const LeafLanes<Real> d;
  ray.TestFrom(from, last);
  return !hn::AllFalse(
      d, ScreenedAgainstRays<Query::kClosest, Test>(d, ray, BlockOf<Test::kKind>(tree, leaf),
                                                    LeafCount(leaf), k, 0, LanesBelow(d, 0, 1)));
}

template <class Test, typename Real>
HWY_NOINLINE void CollectScreened(const TreeView<Real>& tree, std::uint32_t leaf,
                                  RepeatedRay<Real>& ray, HitList<Real>& list) {
  const LeafLanes<Real> d;
  const std::uint32_t n = LeafCount(leaf);
  const Real* block = BlockOf<Test::kKind>(tree, leaf);
  const std::uint32_t* ids = IdsOf<Test::kKind>(tree, leaf);
  for (std::uint32_t i = 0; i < n; i += LaneCount(d)) {
    const auto relative = [&](int k) SHEAF_LAMBDA {
      return hn::Sub(hn::Load(d, ray.origin(k)), hn::LoadU(d, block + k * n + i));
    };
    const auto met = MayHitSphere(
        d, relative(0), relative(1), relative(2), hn::Load(d, ray.direction(0)),
        hn::Load(d, ray.direction(1)), hn::Load(d, ray.direction(2)), hn::Load(d, ray.screen()),
        hn::LoadU(d, block + 3 * n + i), hn::Set(d, ray.t_min), hn::Set(d, list.last()));
    for (std::uint32_t bits = MaskBits(d, hn::And(met, LanesBelow(d, i, n))); bits != 0;
         bits &= bits - 1) {
      const std::uint32_t k = i + static_cast<std::uint32_t>(std::countr_zero(bits));
      const bool is_source = (ray.source & ~kInsideBit) == ids[k];
      const bool is_sphere = Test::kKind == PrimitiveKind::kSphere;
      const bool is_inside = is_sphere && is_source && ray.source != ids[k];
      if (is_source && !is_inside) continue;
      const std::uint32_t from = is_inside ? kInsideBit : kFromElsewhere;
      if (!TestOne<Test>(tree, leaf, k, from, list.last(), ray)) continue;
      const bool enters = is_sphere && ray.u[0] == 0;
      list.Add({ray.t[0], ids[k], ray.u[0], ray.v[0]});
      // A sphere that is entered is left as well.
      if (enters && TestOne<Test>(tree, leaf, k, kInsideBit, list.last(), ray)) {
        list.Add({ray.t[0], ids[k], ray.u[0], ray.v[0]});
      }
    }
  }
}

template <typename Real>
HWY_INLINE void CollectLeaf(const TreeView<Real>& tree, std::uint32_t leaf, RepeatedRay<Real>& ray,
                            HitList<Real>& list) {
  switch (LeafKind(leaf)) {
    case PrimitiveKind::kTriangle:
      return CollectTriangles(tree, leaf, ray, list);
    case PrimitiveKind::kSphere:
      return CollectScreened<SphereTest>(tree, leaf, ray, list);
    case PrimitiveKind::kDisk:
      return CollectScreened<DiskTest>(tree, leaf, ray, list);
  }
}

// What a list keeps of the leaves on its ray's way.
template <typename Real>
struct ListLeaves {
  const TreeView<Real>& tree;
  RepeatedRay<Real>& ray;
  HitList<Real>& list;

  HWY_INLINE bool Test(std::uint32_t leaf) const {
    CollectLeaf(tree, leaf, ray, list);
    return list.is_done();
  }
  HWY_INLINE Real end() const { return list.last(); }
};

// Every leaf of the subtree of `start` that the ray of `lane` meets before the list ends, the
// nearest children first. Box tests by `Slabs` must hold for the ray.
template <class Slabs, typename Real>
HWY_NOINLINE void CollectAlong(const TreeView<Real>& tree, const Packet<Real>& packet,
                               std::uint32_t lane, std::uint32_t start, RepeatedRay<Real>& ray,
                               HitList<Real>& list) {
  WalkRay<Slabs>(tree, packet, lane, start, ListLeaves<Real>{tree, ray, list});
}

template <typename Real>
HWY_NOINLINE void CollectEveryLeaf(const TreeView<Real>& tree, RepeatedRay<Real>& ray,
                                   HitList<Real>& list) {
  for (std::uint32_t i = 0; i < tree.node_count; ++i) {
    for (const std::uint32_t child : tree.nodes[i].child) {
      if (IsLeaf(child) && child != kNoChild) CollectLeaf(tree, child, ray, list);
      if (list.is_done()) return;
    }
  }
}

// A packet whose lanes have lists, as the tests of a vector of rays see it. What they keep is each
// lane's hit of one primitive, to be collected.
template <typename Real>
struct ListPacket : PacketRays<Real> {
  static constexpr std::uint32_t kSize = kPacketSize<Real>;
  using PacketRays<Real>::packet;

  alignas(kAlignment) Real t[kSize], u[kSize], v[kSize], det[kSize];
  std::uint32_t id[kSize];
  HitList<Real>* lists;  // a lane

  HWY_INLINE ListPacket(Packet<Real>& rays, HitList<Real>* of_lanes)
      : PacketRays<Real>{rays}, lists(of_lanes) {}

  HWY_INLINE void Forget() {
    const Lanes<Real> d;
    hn::Store(hn::Load(d, packet.t_best), d, t);
    StoreIds(d, hn::Set(IdLanes<Lanes<Real>>(), kNoPrimitive), id);
  }
  // A ray ends where its list does.
  HWY_INLINE void End(std::uint32_t lane) {
    packet.t_best[lane] = lists[lane].is_done() ? kDone<Real> : lists[lane].last();
  }
  HWY_INLINE void Collect(std::uint32_t hits, std::uint32_t primitive) {
    for (; hits != 0; hits &= hits - 1) {
      const auto lane = static_cast<std::uint32_t>(std::countr_zero(hits));
      lists[lane].Add({t[lane], primitive, u[lane] / det[lane], v[lane] / det[lane]});
      End(lane);
    }
  }

  // In place of the packet's own.
  HWY_INLINE HitSlots<Real> slots() const {
    auto& self = const_cast<ListPacket&>(*this);
    return {self.t, self.u, self.v, self.det, self.id};
  }
};

// Triangles of the leaf whose bits are set in `wanted`, against the rays of `lanes`.
template <typename Real>
HWY_NOINLINE void CollectTogether(const TreeView<Real>& tree, std::uint32_t leaf,
                                  std::uint32_t wanted, hn::Mask<Lanes<Real>> lanes,
                                  ListPacket<Real>& rays) {
  const Lanes<Real> d;
  const IdLanes<Lanes<Real>> di;
  const std::uint32_t n = LeafCount(leaf);
  const Real* block = BlockOf<PrimitiveKind::kTriangle>(tree, leaf);
  const std::uint32_t* ids = IdsOf<PrimitiveKind::kTriangle>(tree, leaf);
  const auto axes = LoadIds(d, rays.packet.axis);
  for (int axis = 0; axis < 3; ++axis) {
    const auto same = hn::Eq(axes, hn::Set(di, static_cast<hn::TFromD<decltype(di)>>(axis)));
    const auto along = hn::And(lanes, hn::RebindMask(d, same));
    if (hn::AllFalse(d, along)) continue;
    const int kx = (axis + 1) % 3, ky = (axis + 2) % 3;
    for (std::uint32_t rest = wanted; rest != 0; rest &= rest - 1) {
      const auto i = static_cast<std::uint32_t>(std::countr_zero(rest));
      const auto relative = [&](int vertex, int k) SHEAF_LAMBDA {
        return hn::Sub(hn::Set(d, block[(3 * vertex + k) * n + i]), hn::Load(d, rays.origin(k)));
      };
      rays.Forget();
      const auto hit = TriangleAgainstRays<Query::kClosest>(
          d, rays, axis, relative(0, kx), relative(0, ky), relative(0, axis), relative(1, kx),
          relative(1, ky), relative(1, axis), relative(2, kx), relative(2, ky), relative(2, axis),
          BlockColumns<Real>{block + i, n, 0}, ids[i], along);
      rays.Collect(MaskBits(d, hit), ids[i]);
    }
  }
}

// The rays of `lanes`, all of one octant: together where most of them go, else one by one.
template <typename Real>
HWY_NOINLINE void CollectBeam(const TreeView<Real>& tree, BeamStack<Real>& stack,
                              std::uint32_t lanes, ListPacket<Real>& rays) {
  const Lanes<Real> d;
  Beam<Real> beam;
  MakeBeam(rays.packet, lanes, beam);
  UpdateRayEnds(rays.packet, lanes, beam);
  TraceBeam(tree, stack, beam, 0, [&](std::uint32_t child, auto met) SHEAF_LAMBDA {
    std::uint32_t bits = MaskBits(d, met);
    const bool are_few = static_cast<std::uint32_t>(std::popcount(bits)) <= FewRays<Real>();
    if (!are_few && !IsLeaf(child)) return Visit::kDescend;
    if (!are_few && HasTriangles(child)) {
      CollectTogether(tree, child, CullLeaf(tree, child, beam), met, rays);
    } else {
      for (; bits != 0; bits &= bits - 1) {
        const auto lane = static_cast<std::uint32_t>(std::countr_zero(bits));
        RepeatedRay<Real> ray(rays.packet, lane);
        CollectAlong<LaneSlabs<Real>>(tree, rays.packet, lane, child, ray, rays.lists[lane]);
        rays.End(lane);
      }
    }
    UpdateRayEnds(rays.packet, lanes, beam);
    return Visit::kDone;
  });
}

// Octants of more than half a packet go together. Returns the bits of the lanes that are left.
template <typename Real>
HWY_INLINE std::uint32_t CollectCompany(const TreeView<Real>& tree, BeamStack<Real>& stack,
                                        std::uint32_t open, ListPacket<Real>& rays) {
  const std::uint32_t lane_count = LaneCount(Lanes<Real>());
  std::uint32_t left = open & rays.packet.without_boxes, lanes = open & ~left;
  while (lanes != 0) {
    const std::uint32_t octant = rays.packet.octant[std::countr_zero(lanes)];
    std::uint32_t alike = 0;
    for (std::uint32_t lane = 0; lane < lane_count; ++lane) {
      alike |= static_cast<std::uint32_t>(rays.packet.octant[lane] == octant) << lane;
    }
    alike &= lanes;
    lanes &= ~alike;
    if (static_cast<std::uint32_t>(std::popcount(alike)) <= lane_count / 2) {
      left |= alike;
    } else {
      CollectBeam(tree, stack, alike, rays);
    }
  }
  return left;
}

template <typename Real>
HWY_INLINE void CollectLane(const TreeView<Real>& tree, Packet<Real>& packet, std::uint32_t lane,
                            std::uint32_t fit_wide, const ListedHit<Real>* after,
                            HitList<Real>& list) {
  RepeatedRay<Real> ray(packet, lane);
  // Boxes that are left before what the list begins after hold nothing that counts. The tests of
  // primitives keep the ray's own interval.
  if (after && after->t > packet.t_min[lane]) packet.t_min[lane] = after->t;
  if ((packet.without_boxes >> lane & 1) == 0) {
    CollectAlong<LaneSlabs<Real>>(tree, packet, lane, 0, ray, list);
  } else if ((fit_wide >> lane & 1) != 0) {
    CollectAlong<WideSlabs<Real>>(tree, packet, lane, 0, ray, list);
  } else {
    CollectEveryLeaf(tree, ray, list);
  }
}

template <typename Real>
void TraceAllLanes(const TreeView<Real>& tree, const RayView<Real>& rays,
                   const RayIntervals<Real>& intervals, std::uint32_t count,
                   const HitRuleView& rules, const HitListOutput<Real>& output) {
  Packet<Real> packet;
  BeamStack<Real> stack;
  const std::uint32_t lanes = LaneCount(Lanes<Real>());
  const bool is_asked = tree.node_count > 0 && (output.capacity > 0 || output.total);
  std::vector<HitList<Real>> lists;
  lists.reserve(lanes);
  for (std::uint32_t begin = 0; begin < count; begin += lanes) {
    LoadPacket(rays, intervals, begin, count, packet);
    PrepareLeafTerms(tree, packet);
    if (!HasScreened(tree)) hn::Store(hn::Zero(Lanes<Real>()), Lanes<Real>(), packet.screen);
    PrepareBoxes(tree, packet);
    const std::uint32_t n = std::min(lanes, count - begin);
    std::uint32_t open = is_asked ? OpenLanes(packet) : 0;
    lists.clear();
    for (std::uint32_t lane = 0; lane < n; ++lane) {
      lists.emplace_back(output, rules, begin + lane, packet.t_best[lane]);
      const bool is_over = output.after && output.after[begin + lane].t > packet.t_best[lane];
      if (is_over) open &= ~(1u << lane);
    }
    // A list that begins somewhere is for boxes another interval than for primitives: lane by lane.
    if (!output.after) {
      ListPacket<Real> together(packet, lists.data());
      open = CollectCompany(tree, stack, open, together);
    }
    const std::uint32_t fit_wide = FitWideBoxes(packet, packet.without_boxes);
    for (; open != 0; open &= open - 1) {
      const auto lane = static_cast<std::uint32_t>(std::countr_zero(open));
      const ListedHit<Real>* after = output.after ? output.after + begin + lane : nullptr;
      CollectLane(tree, packet, lane, fit_wide, after, lists[lane]);
    }
    for (const HitList<Real>& list : lists) list.Finish();
  }
}

SHEAF_NAME_KERNELS(TraceAll);

}  // namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sheaf::SHEAF_SIMD {
SHEAF_EXPORT(TraceAll);
}  // namespace sheaf::SHEAF_SIMD
#endif  // HWY_ONCE
