// Walks a batch of rays through the tree over instances, and into those that it meets.
//
// Rays go in groups of one octant, so that all of a group meet the children of a node in one order.
// What a group has of rays on the way at a node is a list of packets, each with the lanes that
// still go; the rays that meet an instance are mapped into its object and traced there as one
// batch, so that neighbours stay together.
#if defined(SHEAF_SIMD_WALK_INSTANCES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SHEAF_SIMD_WALK_INSTANCES_INL_H_
#undef SHEAF_SIMD_WALK_INSTANCES_INL_H_
#else
#define SHEAF_SIMD_WALK_INSTANCES_INL_H_
#endif

#include <bit>

#include "simd/compact-inl.h"
#include "simd/instances.h"
#include "simd/slabs-inl.h"

HWY_BEFORE_NAMESPACE();
namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE {

inline constexpr std::uint32_t kGroupPackets = 16;
// So few rays of a packet are tested one by one, against all children of a node at once.
inline constexpr int kFewRays = 4;

// Rays of one octant, as box tests and maps read them. Unused lanes are kDone.
template <typename Real>
struct alignas(kAlignment) RayGroup {
  static constexpr std::uint32_t kRoom = kGroupPackets * kPacketSize<Real>;

  Real origin[3][kRoom], direction[3][kRoom];
  Real scale[3][kRoom], enter[3][kRoom], leave[3][kRoom];  // RaySlabs of src/scalar/ray_slabs.h
  Real t_min[kRoom], t_best[kRoom];
  std::uint32_t source[kRoom], source_instance[kRoom];
  std::uint32_t position[kRoom];  // in the batch
};

// The rays of a group that met an instance, mapped into its object.
template <typename Real>
struct alignas(kAlignment) MappedRays {
  static constexpr std::uint32_t kRoom = RayGroup<Real>::kRoom + kMaxLanes;

  Real numbers[6][kRoom];
  Real t_min[kRoom], t_max[kRoom];
  std::uint32_t source[kRoom];
  std::uint32_t lane[kRoom];  // of the group

  RayView<Real> rays() const {
    return {numbers[0], numbers[1], numbers[2], numbers[3], numbers[4], numbers[5], source};
  }
  RayIntervals<Real> intervals() const { return {t_min, t_max}; }
};

// Where a ray ends, or kDone: an infinite interval admits every finite t; NaN, none.
template <typename Real>
HWY_INLINE Real EndOf(Real t_max) {
  return t_max > kDefaultTMax<Real> ? kDefaultTMax<Real> : t_max >= 0 ? t_max : kDone<Real>;
}

// Rays of a packet of the group, as bits.
struct ActiveRays {
  std::uint16_t packet, lanes;
};

// `Output` traces the rays that met an instance and keeps what they hit:
//   Real LastT(position): where the ray of that position in the batch ends, or kDone.
//   bool Trace(instance, mapped, count, group): returns whether a ray of the group now ends sooner.
template <class Output, typename Real>
class InstanceWalk {
 public:
  InstanceWalk(const InstanceTree<Real>& tree, Output& output) : tree_(tree), output_(output) {}

  // Returns how many rays are left alone because box tests do not hold for them.
  std::uint32_t Trace(const RayView<Real>& rays, const std::uint32_t* source_instance,
                      const RayIntervals<Real>& intervals, std::uint32_t count) {
    const std::uint32_t room = kGroupPackets * LaneCount(D());
    std::uint32_t left = 0;
    for (std::uint32_t begin = 0; begin < count; begin += room) {
      std::uint8_t octant[RayGroup<Real>::kRoom];
      left += FindOctants(rays, intervals, begin, std::min(room, count - begin), octant);
      for (octant_ = 0; octant_ < 8; ++octant_) {
        if ((found_octants_ >> octant_ & 1) == 0) continue;
        TakeGroup(rays, source_instance, intervals, begin, std::min(room, count - begin), octant);
        if (active_count_ > 0) Visit(0, active_, active_count_);
      }
    }
    return left;
  }

 private:
  using D = Lanes<Real>;
  using V = hn::Vec<D>;
  static constexpr std::uint8_t kLeft = 8;  // in place of an octant

  // Writes the octants of rays [begin, begin + n), or kLeft; returns how many are left to others.
  std::uint32_t FindOctants(const RayView<Real>& rays, const RayIntervals<Real>& intervals,
                            std::uint32_t begin, std::uint32_t n, std::uint8_t* octant) {
    const D d;
    std::uint32_t left = 0;
    found_octants_ = 0;
    for (std::uint32_t i = 0; i < n; i += LaneCount(d)) {
      const std::uint32_t at = begin + i;
      const V ox = hn::LoadU(d, rays.origin_x + at), oy = hn::LoadU(d, rays.origin_y + at),
              oz = hn::LoadU(d, rays.origin_z + at);
      const V dx = hn::LoadU(d, rays.direction_x + at), dy = hn::LoadU(d, rays.direction_y + at),
              dz = hn::LoadU(d, rays.direction_z + at);
      const V t_min = LoadTMin(d, intervals, at);
      const V size = hn::Max(hn::Max(hn::Abs(dx), hn::Abs(dy)), hn::Abs(dz));
      const V furthest = hn::Max(hn::Max(hn::Abs(ox), hn::Abs(oy)), hn::Abs(oz));
      // The end is asked for lane by lane.
      const auto traceable = IsTraceable(d, ox, oy, oz, dx, dy, dz, t_min, t_min);
      const auto fits = FitsBoxes(d, size, furthest, t_min);
      const std::uint32_t all = MaskBits(d, traceable), fit = MaskBits(d, hn::And(traceable, fits));
      alignas(kAlignment) std::uint32_t octants[kMaxLanes];
      StoreIds(d, Octants(d, dx, dy, dz), octants);
      for (std::uint32_t lane = 0; lane < LaneCount(d) && i + lane < n; ++lane) {
        const bool does_fit = (fit >> lane & 1) != 0;
        octant[i + lane] = does_fit ? static_cast<std::uint8_t>(octants[lane]) : kLeft;
        if (does_fit) found_octants_ |= 1u << octants[lane];
        left += (all & ~fit) >> lane & 1;
      }
    }
    return left;
  }

  // Fills group_ with the rays of octant_ among [begin, begin + n).
  void TakeGroup(const RayView<Real>& rays, const std::uint32_t* source_instance,
                 const RayIntervals<Real>& intervals, std::uint32_t begin, std::uint32_t n,
                 const std::uint8_t* octant) {
    const D d;
    std::uint32_t count = 0;
    for (std::uint32_t i = 0; i < n; ++i) {
      if (octant[i] != octant_) continue;
      const Real last = output_.LastT(begin + i);
      if (last == kDone<Real>) continue;
      group_.t_best[count] = last;
      group_.source[count] = rays.source ? rays.source[begin + i] : kNoPrimitive;
      group_.source_instance[count] = source_instance ? source_instance[begin + i] : kNoInstance;
      group_.position[count++] = begin + i;
    }
    active_count_ = 0;
    for (std::uint32_t i = 0; i < count; i += LaneCount(d)) {
      const std::uint32_t in_use = std::min(count - i, LaneCount(d));
      for (std::uint32_t lane = in_use; lane < LaneCount(d); ++lane) {
        group_.position[i + lane] = group_.position[i];
        group_.t_best[i + lane] = kDone<Real>;
      }
      TakePacket(rays, intervals, i);
      active_[active_count_++] = {static_cast<std::uint16_t>(i / LaneCount(d)),
                                  static_cast<std::uint16_t>((1u << in_use) - 1)};
    }
  }

  // The numbers of lanes [i, i + lanes) of the group, whose positions are known.
  HWY_INLINE void TakePacket(const RayView<Real>& rays, const RayIntervals<Real>& intervals,
                             std::uint32_t i) {
    const D d;
    const auto position = LoadIds(d, group_.position + i);
    const IdPattern pattern = PatternOf(group_.position + i, LaneCount(d), LaneCount(d));
    const auto take = [&](const Real* from) SHEAF_LAMBDA {
      return Fetch(d, pattern, from, group_.position[i], position);
    };
    hn::Store(intervals.t_min ? take(intervals.t_min) : hn::Set(d, intervals.all_t_min), d,
              group_.t_min + i);
    const Real* const origins[] = {rays.origin_x, rays.origin_y, rays.origin_z};
    const Real* const directions[] = {rays.direction_x, rays.direction_y, rays.direction_z};
    V size = hn::Zero(d), reach = hn::Zero(d);
    for (int axis = 0; axis < 3; ++axis) {
      const V o = take(origins[axis]), dir = take(directions[axis]);
      hn::Store(o, d, group_.origin[axis] + i);
      hn::Store(dir, d, group_.direction[axis] + i);
      size = hn::Max(size, hn::Abs(dir));
      const V lower = hn::Set(d, static_cast<Real>(tree_.lower[axis]));
      const V upper = hn::Set(d, static_cast<Real>(tree_.upper[axis]));
      reach = hn::Max(reach, hn::Max(hn::Sub(upper, o), hn::Sub(o, lower)));
    }
    const V give =
        hn::MulAdd(reach, hn::Set(d, static_cast<Real>(tree_.condition) * Real(kInstanceSlack)),
                   hn::Set(d, Real(kBoxAbsoluteSlack)));
    for (int axis = 0; axis < 3; ++axis) {
      StoreSlabs<Real>(hn::Load(d, group_.origin[axis] + i),
                       hn::Load(d, group_.direction[axis] + i), size, reach, give,
                       group_.scale[axis] + i, group_.enter[axis] + i, group_.leave[axis] + i);
    }
  }

  // A packet as its box tests read it.
  struct PacketSlabs {
    V scale_x, scale_y, scale_z, enter_x, enter_y, enter_z, leave_x, leave_y, leave_z, t_min, last;

    HWY_INLINE PacketSlabs(const RayGroup<Real>& group, std::uint32_t i) {
      const D d;
      scale_x = hn::Load(d, group.scale[0] + i), scale_y = hn::Load(d, group.scale[1] + i);
      scale_z = hn::Load(d, group.scale[2] + i), enter_x = hn::Load(d, group.enter[0] + i);
      enter_y = hn::Load(d, group.enter[1] + i), enter_z = hn::Load(d, group.enter[2] + i);
      leave_x = hn::Load(d, group.leave[0] + i), leave_y = hn::Load(d, group.leave[1] + i);
      leave_z = hn::Load(d, group.leave[2] + i), t_min = hn::Load(d, group.t_min + i);
      last = hn::Mul(hn::Load(d, group.t_best + i), hn::Set(d, Real(kBoxFarFactor)));
    }

    // The lanes that meet the box of a child.
    HWY_INLINE std::uint32_t Meet(const TreeNode& node, const SlabRows& rows,
                                  std::uint32_t child) const {
      const D d;
      const auto plane = [&](std::size_t row) SHEAF_LAMBDA {
        return hn::Set(d, static_cast<Real>(node.bounds[row][child]));
      };
      const V enter = hn::Max(hn::Max(hn::MulAdd(plane(rows.in_x), scale_x, enter_x),
                                      hn::MulAdd(plane(rows.in_y), scale_y, enter_y)),
                              hn::Max(hn::MulAdd(plane(rows.in_z), scale_z, enter_z), t_min));
      const V leave = hn::Min(hn::Min(hn::MulAdd(plane(rows.out_x), scale_x, leave_x),
                                      hn::MulAdd(plane(rows.out_y), scale_y, leave_y)),
                              hn::MulAdd(plane(rows.out_z), scale_z, leave_z));
      const V far = hn::Mul(leave, hn::Set(d, Real(kBoxFarFactor)));
      return MaskBits(d, hn::Le(enter, hn::Min(far, last)));
    }
  };

  // The children whose boxes one ray meets, as bits.
  HWY_INLINE std::uint32_t MeetAlone(const TreeNode& node, const SlabRows& rows,
                                     std::uint32_t ray) const {
    const LeafLanes<Real> d;
    const auto at = [&](std::size_t row, std::uint32_t i, const Real* scale, const Real* offset)
                        SHEAF_LAMBDA {
                          return hn::MulAdd(LoadPlanes(d, node.bounds[row] + i),
                                            hn::Set(d, scale[ray]), hn::Set(d, offset[ray]));
                        };
    const auto& [scale, enter, leave] = std::tie(group_.scale, group_.enter, group_.leave);
    const Real last = group_.t_best[ray] * Real(kBoxFarFactor);
    std::uint32_t met = 0;
    for (std::uint32_t i = 0; i < kTreeWidth; i += LaneCount(d)) {
      const auto in = hn::Max(
          hn::Max(at(rows.in_x, i, scale[0], enter[0]), at(rows.in_y, i, scale[1], enter[1])),
          hn::Max(at(rows.in_z, i, scale[2], enter[2]), hn::Set(d, group_.t_min[ray])));
      const auto out = hn::Min(
          hn::Min(at(rows.out_x, i, scale[0], leave[0]), at(rows.out_y, i, scale[1], leave[1])),
          at(rows.out_z, i, scale[2], leave[2]));
      const auto far = hn::Mul(out, hn::Set(d, Real(kBoxFarFactor)));
      met |= MaskBits(d, hn::Le(in, hn::Min(far, hn::Set(d, last)))) << i;
    }
    return met;
  }

  // Depth first, the nearest child first. Recurses as deep as the tree.
  HWY_NOINLINE void Visit(std::uint32_t index, const ActiveRays* active, std::uint32_t count) {
    const TreeNode& node = tree_.nodes[index];
    const SlabRows rows(octant_);
    std::uint16_t met[kGroupPackets][kTreeWidth];  // lanes by child
    for (std::uint32_t k = 0; k < count; ++k) MeetChildren(node, rows, active[k], met[k]);
    const std::uint32_t hits_before = hits_;
    std::uint32_t order = node.order[octant_];
    for (std::uint32_t i = 0; i < kTreeWidth; ++i, order >>= 4) {
      const std::uint32_t child = order & 7;
      ActiveRays next[kGroupPackets];
      std::uint32_t n = 0;
      for (std::uint32_t k = 0; k < count; ++k) {
        std::uint32_t lanes = met[k][child];
        if (lanes == 0) continue;
        // What was hit since may lie before this child.
        if (hits_ != hits_before) {
          lanes &= PacketSlabs(group_, active[k].packet * LaneCount(D())).Meet(node, rows, child);
          if (lanes == 0) continue;
        }
        next[n++] = {active[k].packet, static_cast<std::uint16_t>(lanes)};
      }
      if (n == 0) continue;
      if (IsLeaf(node.child[child])) {
        TraceInstance(LeafFirst(node.child[child]), next, n);
      } else {
        Visit(node.child[child], next, n);
      }
    }
  }

  HWY_INLINE void MeetChildren(const TreeNode& node, const SlabRows& rows, ActiveRays active,
                               std::uint16_t (&met)[kTreeWidth]) const {
    const std::uint32_t first = active.packet * LaneCount(D());
    if (std::popcount(active.lanes) <= kFewRays) {
      for (std::uint16_t& lanes : met) lanes = 0;
      for (std::uint32_t rest = active.lanes; rest != 0; rest &= rest - 1) {
        const int lane = std::countr_zero(rest);
        for (std::uint32_t m = MeetAlone(node, rows, first + static_cast<std::uint32_t>(lane));
             m != 0; m &= m - 1) {
          met[std::countr_zero(m)] |= static_cast<std::uint16_t>(1u << lane);
        }
      }
      return;
    }
    const PacketSlabs slabs(group_, first);
    for (std::uint32_t child = 0; child < kTreeWidth; ++child) {
      met[child] = static_cast<std::uint16_t>(slabs.Meet(node, rows, child) & active.lanes);
    }
  }

  HWY_NOINLINE void TraceInstance(std::uint32_t instance, const ActiveRays* active,
                                  std::uint32_t count) {
    std::uint32_t n = 0;
    for (std::uint32_t k = 0; k < count; ++k) n = MapRays(instance, active[k], n);
    hits_ += output_.Trace(instance, mapped_, n, group_) ? 1 : 0;
  }

  // MapRay of src/scalar/instances.h, of the active rays; returns the end of what is in mapped_.
  HWY_INLINE std::uint32_t MapRays(std::uint32_t instance, ActiveRays active, std::uint32_t n) {
    const D d;
    const std::uint32_t first = active.packet * LaneCount(d);
    alignas(kAlignment) Real numbers[6][kPacketSize<Real>];
    MapPacket(tree_.to_object[instance], first, numbers);
    V size = hn::Zero(d);
    for (int k = 3; k < 6; ++k) size = hn::Max(size, hn::Abs(hn::Load(d, numbers[k])));
    const auto too_short = hn::Lt(size, hn::Set(d, kMinMappedDirection<Real>));
    for (int k = 3; k < 6; ++k) {
      hn::Store(hn::IfThenZeroElse(too_short, hn::Load(d, numbers[k])), d, numbers[k]);
    }
    const auto lanes = LanesFromBits(d, active.lanes);
    const auto order = CompactOrder(d, lanes);
    for (int k = 0; k < 6; ++k) {
      CompactStore(d, hn::Load(d, numbers[k]), order, mapped_.numbers[k] + n);
    }
    CompactStore(d, hn::Load(d, group_.t_min + first), order, mapped_.t_min + n);
    CompactStore(d, hn::Load(d, group_.t_best + first), order, mapped_.t_max + n);
    for (std::uint32_t rest = active.lanes; rest != 0; rest &= rest - 1) {
      const std::uint32_t lane = first + static_cast<std::uint32_t>(std::countr_zero(rest));
      mapped_.source[n] =
          group_.source_instance[lane] == instance ? group_.source[lane] : kNoPrimitive;
      mapped_.lane[n++] = lane;
    }
    return n;
  }

  HWY_INLINE void MapPacket(const AffineMap& map, std::uint32_t first,
                            Real (&numbers)[6][kPacketSize<Real>]) const {
    const WideLanes<Real> dw;
    const NarrowLanes<Real> dn;
    using W = hn::TFromD<WideLanes<Real>>;
    for (std::uint32_t i = 0; i < LaneCount(D()); i += LaneCount(dn)) {
      const auto load = [&](const Real* from)
                            SHEAF_LAMBDA { return Widen(hn::LoadU(dn, from + first + i)); };
      const auto ox = load(group_.origin[0]), oy = load(group_.origin[1]),
                 oz = load(group_.origin[2]);
      const auto dx = load(group_.direction[0]), dy = load(group_.direction[1]),
                 dz = load(group_.direction[2]);
      for (int k = 0; k < 3; ++k) {
        const auto& row = map.row[k];
        const auto a = hn::Set(dw, static_cast<W>(row[0])), b = hn::Set(dw, static_cast<W>(row[1]));
        const auto c = hn::Set(dw, static_cast<W>(row[2]));
        const auto turned = [&](auto x, auto y, auto z) SHEAF_LAMBDA {
          return hn::Add(hn::Add(hn::Mul(a, x), hn::Mul(b, y)), hn::Mul(c, z));
        };
        const auto moved = hn::Add(turned(ox, oy, oz), hn::Set(dw, static_cast<W>(row[3])));
        hn::StoreU(Narrow<Real>(moved), dn, numbers[k] + i);
        hn::StoreU(Narrow<Real>(turned(dx, dy, dz)), dn, numbers[3 + k] + i);
      }
    }
  }

  const InstanceTree<Real>& tree_;
  Output& output_;
  RayGroup<Real> group_;
  MappedRays<Real> mapped_;
  ActiveRays active_[kGroupPackets];
  std::uint32_t active_count_ = 0, octant_ = 0, found_octants_ = 0;
  std::uint32_t hits_ = 0;  // how often rays of the group came to end sooner
};

}  // namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // SHEAF_SIMD_WALK_INSTANCES_INL_H_
