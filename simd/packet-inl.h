// A packet: as many rays as the target has lanes, with what they have hit so far.
#if defined(SHEAF_SIMD_PACKET_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SHEAF_SIMD_PACKET_INL_H_
#undef SHEAF_SIMD_PACKET_INL_H_
#else
#define SHEAF_SIMD_PACKET_INL_H_
#endif

#include <algorithm>
#include <cmath>
#include <limits>

#include "simd/query.h"
#include "simd/ray-inl.h"
#include "simd/sphere-inl.h"
#include "simd/streams.h"
#include "simd/tree.h"

HWY_BEFORE_NAMESPACE();
namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE {

// The most lanes that the target can have. Where vectors have no fixed size it may have fewer.
template <typename Real>
inline constexpr std::uint32_t kPacketSize =
    HWY_TARGET == HWY_SCALAR ? 1 : std::min<std::uint32_t>(kMaxLanes, HWY_MAX_BYTES / sizeof(Real));

// t_best of a lane that is finished: no box and no hit comes before it.
template <typename Real>
inline constexpr Real kDone = -std::numeric_limits<Real>::infinity();

// Rays in memory, because a ray that goes on alone is read from its lane. Lanes that cannot hit
// anything, or are past the batch's end, are kDone from the start.
template <typename Real>
struct alignas(kAlignment) Packet {
  static constexpr std::uint32_t kSize = kPacketSize<Real>;

  // Numbers first, so that whole vectors of them are aligned.
  Real origin[3][kSize], direction[3][kSize];
  Real t_min[kSize];
  Real t_best[kSize];                   // the ray's end: t_max, then the nearest hit, or kDone
  Real u[kSize], v[kSize], det[kSize];  // as HitSlots has them
  // The shear of the triangle test, and ScreenScale where there are spheres: PrepareLeafTerms.
  Real shear_x[kSize], shear_y[kSize];
  Real screen[kSize];
  // src/scalar/ray_slabs.h, RaySlabs; filled by PrepareBoxes.
  Real scale[3][kSize], enter[3][kSize], leave[3][kSize];
  Real slack[3][kSize];  // how far the origin moves along the direction for `enter`

  std::uint32_t id[kSize];  // of the nearest hit; of any hit for kOccluded
  std::uint32_t source[kSize];
  std::uint32_t axis[kSize];  // the dominant axis
  std::uint32_t octant[kSize];
  std::uint32_t without_boxes;  // open lanes that box tests do not hold for
  bool has_boxes;
};

// The dominant axis of each direction; x wins ties, then y (ShearOf in src/scalar).
template <class D, class V = hn::Vec<D>>
HWY_INLINE hn::Vec<IdLanes<D>> DominantAxis(D /*d*/, V dx, V dy, V dz) {
  const IdLanes<D> di;
  const V ax = hn::Abs(dx), ay = hn::Abs(dy), az = hn::Abs(dz);
  const auto x = hn::RebindMask(di, hn::And(hn::Ge(ax, ay), hn::Ge(ax, az)));
  const auto y = hn::RebindMask(di, hn::Ge(ay, az));
  using Id = hn::TFromD<IdLanes<D>>;
  const auto y_or_z = hn::IfThenElse(y, hn::Set(di, Id{1}), hn::Set(di, Id{2}));
  return hn::IfThenElse(x, hn::Zero(di), y_or_z);
}

template <typename Real>
HWY_INLINE void ForgetHits(Packet<Real>& packet) {
  const Lanes<Real> d;
  hn::Store(hn::Zero(d), d, packet.u);
  hn::Store(hn::Zero(d), d, packet.v);
  hn::Store(hn::Set(d, 1), d, packet.det);
  StoreIds(d, hn::Set(IdLanes<Lanes<Real>>(), kNoPrimitive), packet.id);
  packet.has_boxes = false;
}

// Rays [i, i + lanes) of a batch of `count`.
template <typename Real>
HWY_INLINE void LoadPacket(const RayView<Real>& rays, const RayIntervals<Real>& intervals,
                           std::uint32_t i, std::uint32_t count, Packet<Real>& packet) {
  const Lanes<Real> d;
  const auto ox = hn::LoadU(d, rays.origin_x + i);
  const auto oy = hn::LoadU(d, rays.origin_y + i);
  const auto oz = hn::LoadU(d, rays.origin_z + i);
  const auto dx = hn::LoadU(d, rays.direction_x + i);
  const auto dy = hn::LoadU(d, rays.direction_y + i);
  const auto dz = hn::LoadU(d, rays.direction_z + i);
  const auto t_min = LoadTMin(d, intervals, i), t_max = LoadTMax(d, intervals, i);
  const auto lanes =
      hn::And(LanesBelow(d, i, count), IsTraceable(d, ox, oy, oz, dx, dy, dz, t_min, t_max));
  hn::Store(ox, d, packet.origin[0]);
  hn::Store(oy, d, packet.origin[1]);
  hn::Store(oz, d, packet.origin[2]);
  hn::Store(dx, d, packet.direction[0]);
  hn::Store(dy, d, packet.direction[1]);
  hn::Store(dz, d, packet.direction[2]);
  hn::Store(t_min, d, packet.t_min);
  hn::Store(hn::IfThenElse(lanes, t_max, hn::Set(d, kDone<Real>)), d, packet.t_best);
  StoreIds(d, LoadSources(d, rays, i), packet.source);
  ForgetHits(packet);
}

// Rays at `positions[0, n)` of a batch, all of them traceable; the other lanes are kDone. Reads
// whole vectors of positions.
template <typename Real>
HWY_INLINE void GatherPacket(const RayView<Real>& rays, const RayIntervals<Real>& intervals,
                             const std::uint32_t* positions, std::uint32_t n,
                             Packet<Real>& packet) {
  const Lanes<Real> d;
  const IdLanes<Lanes<Real>> di;
  const auto wanted = LanesBelow(d, 0, n);
  const auto at = hn::IfThenElse(hn::RebindMask(di, wanted), LoadIds(d, positions),
                                 hn::Set(di, hn::TFromD<decltype(di)>{positions[0]}));
  const auto gather = [&](const Real* field) SHEAF_LAMBDA { return GatherAt(d, field, at); };
  hn::Store(gather(rays.origin_x), d, packet.origin[0]);
  hn::Store(gather(rays.origin_y), d, packet.origin[1]);
  hn::Store(gather(rays.origin_z), d, packet.origin[2]);
  hn::Store(gather(rays.direction_x), d, packet.direction[0]);
  hn::Store(gather(rays.direction_y), d, packet.direction[1]);
  hn::Store(gather(rays.direction_z), d, packet.direction[2]);
  const auto most = hn::Set(d, kDefaultTMax<Real>);
  const auto t_min = intervals.t_min ? gather(intervals.t_min) : hn::Set(d, intervals.all_t_min);
  const auto t_max = intervals.t_max ? gather(intervals.t_max) : hn::Set(d, intervals.all_t_max);
  hn::Store(hn::Max(t_min, hn::Neg(most)), d, packet.t_min);
  hn::Store(hn::IfThenElse(wanted, hn::Min(t_max, most), hn::Set(d, kDone<Real>)), d,
            packet.t_best);
  for (std::uint32_t lane = 0; lane < LaneCount(d); ++lane) {
    packet.source[lane] = rays.source ? rays.source[positions[lane < n ? lane : 0]] : kNoPrimitive;
  }
  ForgetHits(packet);
}

// Lanes that may still hit something.
template <class D, typename Real = hn::TFromD<D>>
HWY_INLINE hn::Mask<D> OpenMask(D d, const Packet<Real>& packet) {
  return hn::Gt(hn::Load(d, packet.t_best), hn::Set(d, kDone<Real>));
}

// The same, as bits.
template <typename Real>
HWY_INLINE std::uint32_t OpenLanes(const Packet<Real>& packet) {
  const Lanes<Real> d;
  return MaskBits(d, OpenMask(d, packet));
}

// Whether there is anything but triangles: the others are screened as spheres.
template <typename Real>
HWY_INLINE bool HasScreened(const TreeView<Real>& tree) {
  return tree.primitive_count() > tree.of(PrimitiveKind::kTriangle).count;
}

// Computes what leaf tests read of the rays, for the kinds of primitives that the tree has.
template <typename Real>
HWY_INLINE void PrepareLeafTerms(const TreeView<Real>& tree, Packet<Real>& packet) {
  const Lanes<Real> d;
  const auto dx = hn::Load(d, packet.direction[0]);
  const auto dy = hn::Load(d, packet.direction[1]);
  const auto dz = hn::Load(d, packet.direction[2]);
  const auto axis = DominantAxis(d, dx, dy, dz);
  StoreIds(d, axis, packet.axis);
  const auto is = [&](std::uint32_t k) SHEAF_LAMBDA {
    return hn::RebindMask(d, hn::Eq(axis, hn::Set(IdLanes<Lanes<Real>>(), k)));
  };
  const auto by_axis = [&](auto x, auto y, auto z) SHEAF_LAMBDA {
    return hn::IfThenElse(is(0), x, hn::IfThenElse(is(1), y, z));
  };
  const auto along = by_axis(dx, dy, dz);
  hn::Store(hn::Div(by_axis(dy, dz, dx), along), d, packet.shear_x);
  hn::Store(hn::Div(by_axis(dz, dx, dy), along), d, packet.shear_y);
  if (HasScreened(tree)) hn::Store(ScreenScale(d, dx, dy, dz), d, packet.screen);
}

// Bit k: the direction's component along axis k has a minus sign.
template <class D, class V = hn::Vec<D>>
HWY_INLINE hn::Vec<IdLanes<D>> Octants(D /*d*/, V dx, V dy, V dz) {
  const IdLanes<D> di;
  const auto sign = [&](V v) SHEAF_LAMBDA {
    return hn::ShiftRight<sizeof(hn::TFromD<D>) * 8 - 1>(hn::BitCast(di, v));
  };
  return hn::Or(sign(dx), hn::Or(hn::ShiftLeft<1>(sign(dy)), hn::ShiftLeft<2>(sign(dz))));
}

// FitsBoxes of src/scalar/ray_slabs.h: `size` and `furthest` are the largest components of
// directions and origins. NaN passes nothing.
template <class D, class V = hn::Vec<D>, typename Real = hn::TFromD<D>>
HWY_INLINE hn::Mask<D> FitsBoxes(D d, V size, V furthest, V t_min) {
  const auto fits = hn::And(hn::Ge(size, hn::Set(d, Real(kMinBoxDirection))),
                            hn::Le(size, hn::Set(d, Real(kMaxBoxDirection))));
  return hn::And(hn::And(fits, hn::Le(furthest, hn::Set(d, Real(kMaxBoxCoordinate)))),
                 hn::Ge(t_min, hn::Zero(d)));
}

// Along one axis, SlabsOf of src/scalar/ray_slabs.h of a vector of rays. `give`: how far an origin
// at 0 gives way. Returns how far each does, along its direction.
template <typename Real, class V = hn::Vec<Lanes<Real>>>
HWY_INLINE V StoreSlabs(V o, V dir, V size, V reach, V give, Real* scale, Real* enter,
                        Real* leave) {
  const Lanes<Real> d;
  const V least = hn::Mul(size, hn::Set(d, Real(kMinBoxSlope)));
  const V steep_slack = hn::Mul(reach, hn::Set(d, Real(2 * kMinBoxSlope)));
  const auto steep = hn::Lt(hn::Abs(dir), least);
  V slack = hn::MulAdd(hn::Abs(o), hn::Set(d, Real(kBoxOriginSlack)), give);
  slack = hn::Add(slack, hn::IfThenElseZero(steep, steep_slack));
  slack = hn::CopySignToAbs(slack, dir);
  const V per_length =
      hn::Div(hn::Set(d, Real(1)), hn::IfThenElse(steep, hn::CopySignToAbs(least, dir), dir));
  hn::Store(per_length, d, scale);
  hn::Store(hn::Neg(hn::Mul(hn::Add(o, slack), per_length)), d, enter);
  hn::Store(hn::Neg(hn::Mul(hn::Sub(o, slack), per_length)), d, leave);
  return slack;
}

template <typename TreeReal, typename Real>
HWY_INLINE void PrepareBoxes(const TreeView<TreeReal>& tree, Packet<Real>& packet) {
  if (packet.has_boxes) return;
  packet.has_boxes = true;
  const Lanes<Real> d;
  auto size = hn::Zero(d), furthest = hn::Zero(d), reach = hn::Zero(d);
  for (int axis = 0; axis < 3; ++axis) {
    const auto o = hn::Load(d, packet.origin[axis]);
    const auto lower = hn::Set(d, static_cast<Real>(tree.lower[axis]));
    const auto upper = hn::Set(d, static_cast<Real>(tree.upper[axis]));
    size = hn::Max(size, hn::Abs(hn::Load(d, packet.direction[axis])));
    furthest = hn::Max(furthest, hn::Abs(o));
    reach = hn::Max(reach, hn::Max(hn::Sub(upper, o), hn::Sub(o, lower)));
  }
  // A lane with NaN is kDone anyway.
  const auto fits = FitsBoxes(d, size, furthest, hn::Load(d, packet.t_min));
  packet.without_boxes = ~MaskBits(d, fits) & OpenLanes(packet);

  const auto give = hn::Set(d, Real(kBoxAbsoluteSlack));
  for (int axis = 0; axis < 3; ++axis) {
    const auto slack = StoreSlabs<Real>(hn::Load(d, packet.origin[axis]),
                                        hn::Load(d, packet.direction[axis]), size, reach, give,
                                        packet.scale[axis], packet.enter[axis], packet.leave[axis]);
    hn::Store(slack, d, packet.slack[axis]);
  }
  StoreIds(d,
           Octants(d, hn::Load(d, packet.direction[0]), hn::Load(d, packet.direction[1]),
                   hn::Load(d, packet.direction[2])),
           packet.octant);
}

}  // namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // SHEAF_SIMD_PACKET_INL_H_
