// A frustum: as many packets as the target has lanes, with one origin, through the tree together.
//
// A lane of the beam is a packet, so that one test decides for all its rays. Distances are measured
// along the dominant axis that all rays share. There they are comparable, whatever the lengths of
// the directions. Rays stay in the batch's arrays: a frustum adds only what its tests need, and
// hits go straight to the batch's output.
#if defined(SHEAF_SIMD_FRUSTUM_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SHEAF_SIMD_FRUSTUM_INL_H_
#undef SHEAF_SIMD_FRUSTUM_INL_H_
#else
#define SHEAF_SIMD_FRUSTUM_INL_H_
#endif

#include <cmath>

#include "simd/query.h"
#include "simd/reduce_rows-inl.h"
#include "simd/streams.h"
#include "simd/trace_packet-inl.h"
#include "simd/tree.h"

HWY_BEFORE_NAMESPACE();
namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE {

// Average number of primitives in a leaf, roughly.
inline constexpr int kLeafFill = 5;
// Leaves that a packet may see for its frustum to stay one. Fewer where some are screened as
// spheres: those are culled less sharply.
inline constexpr int kMostLeaves = 32, kMostScreenedLeaves = 8;

// Bounds the rounding errors of slopes, products and sums below, relative to the largest operand.
template <typename Real>
inline constexpr Real kFrustumSlack = 16 * std::numeric_limits<Real>::epsilon();

template <typename Real>
struct alignas(kAlignment) Frustum {
  static constexpr std::uint32_t kSize = kPacketSize<Real>;
  // By packet and ray. `screen` is set where there is anything but triangles.
  Real shear_x[kSize][kSize], shear_y[kSize][kSize], t_best[kSize][kSize];
  Real screen[kSize][kSize];
  Real det[kSize][kSize];  // of hits, as HitSlots has it
  Beam<Real> beam;         // t is the distance along the dominant axis
  // By packet: the shears of its rays are within `half` of `middle`.
  alignas(kAlignment) Real middle_x[kSize];
  alignas(kAlignment) Real middle_y[kSize];
  alignas(kAlignment) Real half_x[kSize];
  alignas(kAlignment) Real half_y[kSize];
  std::uint32_t without_hit[kSize];  // open rays of each packet that have hit nothing yet
  std::uint32_t first;               // position in the batch
  std::uint32_t count;               // packets in use

  // What all rays share.
  int kx, ky, kz;
  Real origin[3];  // in the order kx, ky, kz
  Real sign;       // of the direction along kz
};

// A batch of rays and where its results go.
template <class Output, typename Real>
struct Batch {
  const TreeView<Real>& tree;
  const RayView<Real>& rays;
  const RayIntervals<Real>& intervals;
  std::uint32_t count;
  const Output& output;
  BeamStack<Real>& stack;

  HWY_INLINE const Real* origin(int axis) const {
    return axis == 0 ? rays.origin_x : axis == 1 ? rays.origin_y : rays.origin_z;
  }
  HWY_INLINE const Real* direction(int axis) const {
    return axis == 0 ? rays.direction_x : axis == 1 ? rays.direction_y : rays.direction_z;
  }
};

// Packet k of a frustum, as PacketRays.
template <class Output, typename Real>
struct FrustumRays {
  const Batch<Output, Real>& batch;
  Frustum<Real>& frustum;
  std::uint32_t k;

  HWY_INLINE std::uint32_t position() const { return frustum.first + k * LaneCount(Lanes<Real>()); }
  HWY_INLINE const Real* origin(int axis) const { return batch.origin(axis) + position(); }
  HWY_INLINE const Real* direction(int axis) const { return batch.direction(axis) + position(); }
  HWY_INLINE const Real* shear_x() const { return frustum.shear_x[k]; }
  HWY_INLINE const Real* shear_y() const { return frustum.shear_y[k]; }
  HWY_INLINE const Real* screen() const { return frustum.screen[k]; }
  HWY_INLINE HitSlots<Real> slots() const {
    return batch.output.Slots(position(), frustum.t_best[k], frustum.det[k]);
  }
  template <class D>
  HWY_INLINE hn::Vec<D> TMin(D d) const {
    return LoadTMin(d, batch.intervals, position());
  }
  template <class D>
  HWY_INLINE hn::Vec<IdLanes<D>> Sources(D d) const {
    return LoadSources(d, batch.rays, position());
  }
};

// The largest distances, along the dominant axis, at which rays of packet k may still hit.
template <class D, class Output, typename Real>
HWY_INLINE hn::Vec<D> LastDepths(D d, const Batch<Output, Real>& batch,
                                 const Frustum<Real>& frustum, std::uint32_t k) {
  const std::uint32_t i = frustum.first + k * LaneCount(d);
  const auto length = hn::Abs(hn::LoadU(d, batch.direction(frustum.kz) + i));
  const auto t = hn::Load(d, frustum.t_best[k]);
  const auto done = hn::Eq(t, hn::Set(d, kDone<Real>));
  const auto end =
      hn::IfThenElse(done, t, hn::Mul(hn::Mul(t, length), hn::Set(d, Real(kBoxFarFactor))));
  return hn::Min(end, hn::Set(d, kDefaultTMax<Real>));
}

// The same for the packet as a whole.
template <class Output, typename Real>
HWY_INLINE Real LastDepth(const Batch<Output, Real>& batch, const Frustum<Real>& frustum,
                          std::uint32_t k) {
  const Lanes<Real> d;
  return hn::GetLane(hn::MaxOfLanes(d, LastDepths(d, batch, frustum, k)));
}

// Whether a packet sees so many leaves that packets are faster than the frustum. Estimated as the
// fraction of the tree's view that a packet covers on average, times the number of leaves.
// (low_x, high_x) and (low_y, high_y) are ranges of shears by packet. No result depends on it.
template <typename Real>
HWY_INLINE bool IsSpread(const TreeView<Real>& tree, const Frustum<Real>& frustum,
                         const Real* low_x, const Real* high_x, const Real* low_y,
                         const Real* high_y) {
  Real covered = 0;
  for (std::uint32_t k = 0; k < frustum.count; ++k) {
    covered += (high_x[k] - low_x[k]) * (high_y[k] - low_y[k]);
  }
  const auto size = [&](int axis) { return Real(tree.upper[axis]) - Real(tree.lower[axis]); };
  const Real ahead = frustum.sign > 0 ? Real(tree.lower[frustum.kz]) - frustum.origin[2]
                                      : frustum.origin[2] - Real(tree.upper[frustum.kz]);
  // Within an octant and about a dominant axis, shears are from 0 to 1.
  const Real view_x = ahead > 0 ? std::min(Real(1), size(frustum.kx) / ahead) : Real(1);
  const Real view_y = ahead > 0 ? std::min(Real(1), size(frustum.ky) / ahead) : Real(1);
  const Real leaves = static_cast<Real>(tree.primitive_count()) / kLeafFill;
  const int most = HasScreened(tree) ? kMostScreenedLeaves : kMostLeaves;
  return covered * leaves >
         static_cast<Real>(most) * static_cast<Real>(frustum.count) * view_x * view_y;
}

// The position of the first ray in [begin, end) that can hit anything, or `end`.
template <class Output, typename Real>
HWY_INLINE std::uint32_t FirstTraceable(const Batch<Output, Real>& batch, std::uint32_t begin,
                                        std::uint32_t end) {
  const auto is_finite = [&](const Real* values, std::uint32_t i) {
    return values[i] - values[i] == 0;
  };
  for (std::uint32_t i = begin; i < end; ++i) {
    const RayView<Real>& rays = batch.rays;
    const Real t_min = batch.intervals.t_min ? batch.intervals.t_min[i] : batch.intervals.all_t_min;
    const Real t_max = batch.intervals.t_max ? batch.intervals.t_max[i] : batch.intervals.all_t_max;
    const bool has_direction =
        rays.direction_x[i] != 0 || rays.direction_y[i] != 0 || rays.direction_z[i] != 0;
    if (has_direction && t_min <= t_max && is_finite(rays.origin_x, i) &&
        is_finite(rays.origin_y, i) && is_finite(rays.origin_z, i) &&
        is_finite(rays.direction_x, i) && is_finite(rays.direction_y, i) &&
        is_finite(rays.direction_z, i)) {
      return i;
    }
  }
  return end;
}

// Takes the origin, the octant and the dominant axis of ray `one` for the frustum. Returns false
// where a frustum cannot have them.
template <class Output, typename Real>
HWY_INLINE bool ShareRay(const Batch<Output, Real>& batch, std::uint32_t one,
                         Frustum<Real>& frustum, bool (&backward)[3]) {
  Real direction[3];
  for (int axis = 0; axis < 3; ++axis) direction[axis] = batch.direction(axis)[one];
  // DominantAxis.
  const Real ax = std::abs(direction[0]), ay = std::abs(direction[1]), az = std::abs(direction[2]);
  frustum.kz = ax >= ay && ax >= az ? 0 : ay >= az ? 1 : 2;
  frustum.kx = frustum.kz == 2 ? 0 : frustum.kz + 1;
  frustum.ky = frustum.kz == 0 ? 2 : frustum.kz - 1;
  const int order[3] = {frustum.kx, frustum.ky, frustum.kz};
  bool is_within = true;
  for (int axis = 0; axis < 3; ++axis) {
    is_within &= std::abs(batch.origin(axis)[one]) <= kMaxBoxCoordinate;
    frustum.origin[axis] = batch.origin(order[axis])[one];
    backward[axis] = std::signbit(direction[axis]);
  }
  frustum.sign = backward[frustum.kz] ? Real(-1) : Real(1);
  return is_within;
}

// Returns whether the batch's rays from `begin` on can go as a frustum and are close enough
// together to gain by it. They need one origin, octant and dominant axis, must lie within the
// limits of box tests, and none may be almost parallel to the planes of boxes. If so, the frustum
// is ready for TraceFrustum, and Finish has to follow.
template <class Output, typename Real>
HWY_INLINE bool PrepareFrustum(const Batch<Output, Real>& batch, std::uint32_t begin,
                               Frustum<Real>& frustum) {
  const Lanes<Real> d;
  const std::uint32_t lanes = LaneCount(d);
  const std::uint32_t end = std::min(batch.count, begin + lanes * lanes);
  const std::uint32_t one = FirstTraceable(batch, begin, end);
  bool backward[3];
  if (one == end || !ShareRay(batch, one, frustum, backward)) return false;
  frustum.first = begin;
  frustum.count = (end - begin + lanes - 1) / lanes;

  // The range of shears of each packet, as magnitudes. Their signs are those of the octant, which
  // all rays share.
  constexpr std::uint32_t kSize = kPacketSize<Real>;
  alignas(kAlignment) Real low_x[kSize], high_x[kSize], low_y[kSize], high_y[kSize];
  // The same by packet and ray.
  alignas(kAlignment) Real lows_x[kSize][kSize], highs_x[kSize][kSize];
  alignas(kAlignment) Real lows_y[kSize][kSize], highs_y[kSize][kSize], ends[kSize][kSize];
  Beam<Real>& beam = frustum.beam;
  const auto zero = hn::Zero(d);
  const auto sign_of = [&](int axis)
                           SHEAF_LAMBDA { return hn::Set(d, backward[axis] ? Real(-1) : Real(1)); };
  const auto sign_x = sign_of(frustum.kx), sign_y = sign_of(frustum.ky),
             sign_z = sign_of(frustum.kz);
  const auto to_magnitude_x = hn::Mul(sign_x, sign_z), to_magnitude_y = hn::Mul(sign_y, sign_z);
  const auto least = hn::Set(d, Real(kMinBoxSlope));
  const auto ox = hn::Set(d, frustum.origin[0]), oy = hn::Set(d, frustum.origin[1]),
             oz = hn::Set(d, frustum.origin[2]);
  const auto one_each = hn::Set(d, 1);
  for (std::uint32_t k = 0; k < lanes; ++k) {
    frustum.without_hit[k] = 0;
    if (k >= frustum.count) {
      for (auto& rows : {lows_x, highs_x, lows_y, highs_y}) hn::Store(one_each, d, rows[k]);
      hn::Store(hn::Set(d, kDone<Real>), d, ends[k]);
      continue;
    }
    const std::uint32_t i = begin + k * lanes;
    const auto load = [&](const Real* field) SHEAF_LAMBDA { return hn::LoadU(d, field + i); };
    const auto dx = load(batch.direction(frustum.kx)), dy = load(batch.direction(frustum.ky)),
               dz = load(batch.direction(frustum.kz));
    const auto size_x = hn::Abs(dx), size_y = hn::Abs(dy), size_z = hn::Mul(dz, sign_z);
    // DominantAxis: x wins ties, then y.
    const auto same_axis = frustum.kz == 0 ? hn::And(hn::Ge(size_z, size_x), hn::Ge(size_z, size_y))
                           : frustum.kz == 1
                               ? hn::And(hn::Ge(size_z, size_x), hn::Gt(size_z, size_y))
                               : hn::And(hn::Gt(size_z, size_x), hn::Gt(size_z, size_y));
    const auto shear_x = hn::Div(dx, dz), shear_y = hn::Div(dy, dz);
    const auto magnitude_x = hn::Mul(shear_x, to_magnitude_x),
               magnitude_y = hn::Mul(shear_y, to_magnitude_y);
    const auto t_min = LoadTMin(d, batch.intervals, i), t_max = LoadTMax(d, batch.intervals, i);
    auto alike =
        hn::And(same_axis, hn::And(hn::Gt(magnitude_x, least), hn::Gt(magnitude_y, least)));
    alike = hn::And(alike, hn::And(hn::Ge(size_z, hn::Set(d, Real(kMinBoxDirection))),
                                   hn::Le(size_z, hn::Set(d, Real(kMaxBoxDirection)))));
    alike = hn::And(alike, hn::And(hn::Ge(t_min, zero), hn::Le(t_min, t_max)));
    const auto from_x = load(batch.origin(frustum.kx)), from_y = load(batch.origin(frustum.ky)),
               from_z = load(batch.origin(frustum.kz));
    alike = hn::And(alike,
                    hn::And(hn::Eq(from_x, ox), hn::And(hn::Eq(from_y, oy), hn::Eq(from_z, oz))));
    // A ray that is not like the others rules the frustum out, unless it can hit nothing anyway.
    const auto in_batch = LanesBelow(d, i, batch.count);
    const auto other = hn::AndNot(alike, in_batch);
    if (HWY_UNLIKELY(!hn::AllFalse(d, other))) {
      const auto traceable = IsTraceable(d, from_x, from_y, from_z, dx, dy, dz, t_min, t_max);
      if (!hn::AllFalse(d, hn::And(other, traceable))) return false;
    }
    const auto open = hn::And(alike, in_batch);
    hn::Store(shear_x, d, frustum.shear_x[k]);
    hn::Store(shear_y, d, frustum.shear_y[k]);
    hn::Store(hn::IfThenElse(open, t_max, hn::Set(d, kDone<Real>)), d, frustum.t_best[k]);
    if (HasScreened(batch.tree)) {
      hn::Store(ScreenScale(d, load(batch.rays.direction_x), load(batch.rays.direction_y),
                            load(batch.rays.direction_z)),
                d, frustum.screen[k]);
    }
    frustum.without_hit[k] = MaskBits(d, open);
    // Shears are at most 1.
    hn::Store(hn::IfThenElse(open, magnitude_x, one_each), d, lows_x[k]);
    hn::Store(hn::IfThenElse(open, magnitude_y, one_each), d, lows_y[k]);
    hn::Store(hn::IfThenElseZero(open, magnitude_x), d, highs_x[k]);
    hn::Store(hn::IfThenElseZero(open, magnitude_y), d, highs_y[k]);
    hn::Store(LastDepths(d, batch, frustum, k), d, ends[k]);
  }
  const auto least_x = ReduceRows<MinOp>(d, lows_x), least_y = ReduceRows<MinOp>(d, lows_y);
  hn::Store(least_x, d, low_x);
  hn::Store(least_y, d, low_y);
  // A packet without open rays has no width.
  hn::Store(hn::Max(ReduceRows<MaxOp>(d, highs_x), least_x), d, high_x);
  hn::Store(hn::Max(ReduceRows<MaxOp>(d, highs_y), least_y), d, high_y);
  hn::Store(ReduceRows<MaxOp>(d, ends), d, beam.t_last);
  if (IsSpread(batch.tree, frustum, low_x, high_x, low_y, high_y)) return false;

  // An empty packet takes the range of one that is not.
  const std::uint32_t full = (one - begin) / lanes;
  for (std::uint32_t k = 0; k < lanes; ++k) {
    if (beam.t_last[k] != kDone<Real>) continue;
    low_x[k] = low_x[full];
    high_x[k] = high_x[full];
    low_y[k] = low_y[full];
    high_y[k] = high_y[full];
  }
  beam.octant = (backward[0] ? 1u : 0u) | (backward[1] ? 2u : 0u) | (backward[2] ? 4u : 0u);
  const auto half = hn::Set(d, Real(0.5)), slack_of_half = hn::Set(d, kFrustumSlack<Real>);
  const auto prepare = [&](int axis, auto low, auto high, Real* middle,
                           Real* half_width) SHEAF_LAMBDA {
    const auto to_shear = hn::Mul(sign_of(axis), sign_z);
    hn::Store(hn::Mul(hn::Mul(hn::Add(low, high), half), to_shear), d, middle);
    hn::Store(hn::MulAdd(hn::Sub(high, low), half, slack_of_half), d, half_width);
    // A ray meets a plane at (plane - origin) / slope. Empty packets are never tested.
    const auto unit = sign_of(axis);
    const auto enter = hn::Mul(hn::Div(unit, high), hn::Set(d, 1 - kFrustumSlack<Real>));
    const auto leave = hn::Mul(hn::Div(unit, low), hn::Set(d, 1 + kFrustumSlack<Real>));
    hn::Store(enter, d, beam.enter_scale[axis]);
    hn::Store(leave, d, beam.leave_scale[axis]);
    const Real sign = backward[axis] ? Real(-1) : Real(1);
    beam.all_enter_scale[axis] = sign * hn::GetLane(hn::MinOfLanes(d, hn::Abs(enter)));
    beam.all_leave_scale[axis] = sign * hn::GetLane(hn::MaxOfLanes(d, hn::Abs(leave)));
  };
  prepare(frustum.kx, hn::Load(d, low_x), hn::Load(d, high_x), frustum.middle_x, frustum.half_x);
  prepare(frustum.ky, hn::Load(d, low_y), hn::Load(d, high_y), frustum.middle_y, frustum.half_y);
  hn::Store(sign_z, d, beam.enter_scale[frustum.kz]);
  hn::Store(sign_z, d, beam.leave_scale[frustum.kz]);
  beam.all_enter_scale[frustum.kz] = beam.all_leave_scale[frustum.kz] = frustum.sign;
  for (int axis = 0; axis < 3; ++axis) {
    const Real o = batch.origin(axis)[one];
    Real slack = std::abs(o) * Real(kBoxOriginSlack) + Real(kBoxAbsoluteSlack);
    if (backward[axis]) slack = -slack;
    beam.all_enter[axis] = o + slack;
    beam.all_leave[axis] = o - slack;
    hn::Store(hn::Neg(hn::Mul(hn::Set(d, o + slack), hn::Load(d, beam.enter_scale[axis]))), d,
              beam.enter[axis]);
    hn::Store(hn::Neg(hn::Mul(hn::Set(d, o - slack), hn::Load(d, beam.leave_scale[axis]))), d,
              beam.leave[axis]);
  }
  hn::Store(zero, d, beam.t_min);
  beam.all_t_min = 0;
  for (std::uint32_t k = 0; k < frustum.count; ++k) {
    batch.output.Clear(d, begin + k * lanes, frustum.det[k]);
  }
  return true;
}

}  // namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // SHEAF_SIMD_FRUSTUM_INL_H_
