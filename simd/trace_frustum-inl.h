// A frustum: as many packets as the target has lanes, with one origin, through the tree together.
//
// A lane of the beam is a packet, so that one test decides for all its rays. Distances along the
// rays are measured along their dominant axis, where they mean the same for all, however long the
// directions are.
#if defined(SHEAF_SIMD_TRACE_FRUSTUM_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SHEAF_SIMD_TRACE_FRUSTUM_INL_H_
#undef SHEAF_SIMD_TRACE_FRUSTUM_INL_H_
#else
#define SHEAF_SIMD_TRACE_FRUSTUM_INL_H_
#endif

#include "simd/query.h"
#include "simd/streams.h"
#include "simd/trace_packet-inl.h"
#include "simd/tree.h"

HWY_BEFORE_NAMESPACE();
namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE {

// Up to so many packets of a frustum go on as packets. Occlusion ends at any hit, which leaves
// holes in a frustum, and it is asked of rays to points at all depths: it pays to give up frusta
// sooner.
template <Query kQuery, typename Real>
HWY_INLINE std::uint32_t FewPackets() {
  return std::max(1u, LaneCount(Lanes<Real>()) / (kQuery == Query::kOccluded ? 2 : 8));
}

// Primitives a leaf, about.
inline constexpr int kLeafFill = 5;
// Leaves that a packet may see for its frustum to stay one.
inline constexpr int kMostLeaves = 8;

// Rounding of slopes, products and sums below, generously: a part of the largest number in play.
template <typename Real>
inline constexpr Real kFrustumSlack = 16 * std::numeric_limits<Real>::epsilon();

template <typename Real>
struct alignas(kAlignment) Frustum {
  static constexpr std::uint32_t kSize = kPacketSize<Real>;
  Packet<Real> packets[kSize];
  std::uint32_t count;  // packets in use
  Beam<Real> beam;      // t is the distance along the dominant axis
  // By packet: the shears of its rays are within `half` of `middle`.
  alignas(kAlignment) Real middle_x[kSize];
  alignas(kAlignment) Real middle_y[kSize];
  alignas(kAlignment) Real half_x[kSize];
  alignas(kAlignment) Real half_y[kSize];

  // What all rays share.
  int kx, ky, kz;
  Real origin[3];  // in the order kx, ky, kz
  Real sign;       // of the direction along kz
};

// The vertices of a leaf's triangles, or its spheres' centers, relative to the frustum's origin,
// and what tests against packets share.
template <typename Real>
struct alignas(kAlignment) FrustumLeaf {
  Real x[3][kMaxLeafSize], y[3][kMaxLeafSize], z[3][kMaxLeafSize];  // [vertex]
  Real nearest[kMaxLeafSize];  // the least distance along the dominant axis
  Real depth[kMaxLeafSize];    // the largest |z|
  Real slack[kMaxLeafSize];    // of x and y once sheared
};

// The furthest that a packet's open rays still go, along the dominant axis.
template <typename Real>
HWY_INLINE Real LastDepth(const Frustum<Real>& frustum, const Packet<Real>& packet) {
  const Lanes<Real> d;
  const auto length = hn::Abs(hn::Load(d, packet.direction[frustum.kz]));
  const auto t = hn::Load(d, packet.t_best);
  const auto done = hn::Eq(t, hn::Set(d, kDone<Real>));
  const auto end =
      hn::IfThenElse(done, t, hn::Mul(hn::Mul(t, length), hn::Set(d, Real(kBoxFarFactor))));
  return std::min(hn::GetLane(hn::MaxOfLanes(d, end)), kDefaultTMax<Real>);
}

// Whether packets see so many leaves at once that their rays fare better apart: the part of the
// tree's view that a packet covers on average, times the leaves, as if these lay side by side.
// (low_x, high_x) and (low_y, high_y) are ranges of shears by packet. A choice, not a bound.
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
  return covered * leaves > kMostLeaves * static_cast<Real>(frustum.count) * view_x * view_y;
}

// Whether the packets' rays, whose leaf terms are there, can go as a frustum: one origin, one
// octant, one dominant axis, none all but parallel to a plane of boxes, all within the limits of
// box tests; and should, because they are close together. Then the frustum is ready for
// TraceFrustum.
template <typename Real>
HWY_INLINE bool PrepareFrustum(const TreeView<Real>& tree, Frustum<Real>& frustum) {
  const Lanes<Real> d;
  const IdLanes<Lanes<Real>> di;
  using Id = hn::TFromD<decltype(di)>;
  const Packet<Real>& first = frustum.packets[0];
  const std::uint32_t open_in_first = OpenLanes(first);
  if (open_in_first == 0) return false;
  const int one = std::countr_zero(open_in_first);
  const auto zero = hn::Zero(d);
  frustum.kz = static_cast<int>(first.axis[one]);
  frustum.kx = frustum.kz == 2 ? 0 : frustum.kz + 1;
  frustum.ky = frustum.kz == 0 ? 2 : frustum.kz - 1;
  const int order[3] = {frustum.kx, frustum.ky, frustum.kz};
  bool is_within = IsWithinBoxLimits(tree);
  bool backward[3];
  for (int axis = 0; axis < 3; ++axis) {
    is_within &= std::abs(first.origin[axis][one]) <= kMaxBoxCoordinate;
    frustum.origin[axis] = first.origin[order[axis]][one];
    backward[axis] = std::signbit(first.direction[axis][one]);
  }
  if (!is_within) return false;
  frustum.sign = backward[frustum.kz] ? Real(-1) : Real(1);

  // By packet, the range of its shears. They have the signs of the octant, so that their magnitudes
  // say how steep they are.
  alignas(kAlignment) Real low_x[kPacketSize<Real>], high_x[kPacketSize<Real>];
  alignas(kAlignment) Real low_y[kPacketSize<Real>], high_y[kPacketSize<Real>];
  Beam<Real>& beam = frustum.beam;
  const auto sign_of = [&](int axis)
                           SHEAF_LAMBDA { return hn::Set(d, backward[axis] ? Real(-1) : Real(1)); };
  const auto sign_x = sign_of(frustum.kx), sign_y = sign_of(frustum.ky),
             sign_z = sign_of(frustum.kz);
  const auto least = hn::Set(d, Real(kMinBoxSlope));
  for (std::uint32_t k = 0; k < LaneCount(d); ++k) {
    low_x[k] = low_y[k] = high_x[k] = high_y[k] = Real(1);
    beam.t_last[k] = kDone<Real>;
    if (k >= frustum.count) continue;
    const Packet<Real>& packet = frustum.packets[k];
    const auto open = OpenMask(d, packet);
    if (hn::AllFalse(d, open)) continue;
    const auto dz = hn::Mul(hn::Load(d, packet.direction[frustum.kz]), sign_z);
    // Magnitudes of the shears, where the signs are the octant's.
    const auto shear_x = hn::Mul(hn::Load(d, packet.shear_x), hn::Mul(sign_x, sign_z));
    const auto shear_y = hn::Mul(hn::Load(d, packet.shear_y), hn::Mul(sign_y, sign_z));
    const auto same_axis = hn::RebindMask(
        d, hn::Eq(LoadIds(d, packet.axis), hn::Set(di, static_cast<Id>(frustum.kz))));
    auto alike = hn::And(same_axis, hn::And(hn::Gt(shear_x, least), hn::Gt(shear_y, least)));
    alike = hn::And(alike, hn::And(hn::Ge(dz, hn::Set(d, Real(kMinBoxDirection))),
                                   hn::Le(dz, hn::Set(d, Real(kMaxBoxDirection)))));
    alike = hn::And(alike, hn::Ge(hn::Load(d, packet.t_min), zero));
    for (int axis = 0; axis < 3; ++axis) {
      alike = hn::And(
          alike, hn::Eq(hn::Load(d, packet.origin[axis]), hn::Set(d, first.origin[axis][one])));
    }
    if (!hn::AllFalse(d, hn::AndNot(alike, open))) return false;
    const Real huge = kDefaultTMax<Real>;
    const auto lowest = [&](auto v) SHEAF_LAMBDA {
      return hn::GetLane(hn::MinOfLanes(d, hn::IfThenElse(open, v, hn::Set(d, huge))));
    };
    const auto highest = [&](auto v) SHEAF_LAMBDA {
      return hn::GetLane(hn::MaxOfLanes(d, hn::IfThenElseZero(open, v)));
    };
    low_x[k] = lowest(shear_x);
    high_x[k] = highest(shear_x);
    low_y[k] = lowest(shear_y);
    high_y[k] = highest(shear_y);
    beam.t_last[k] = LastDepth(frustum, packet);
  }

  beam.octant = (backward[0] ? 1u : 0u) | (backward[1] ? 2u : 0u) | (backward[2] ? 4u : 0u);
  const auto half = hn::Set(d, Real(0.5)), slack_of_half = hn::Set(d, kFrustumSlack<Real>);
  const auto prepare = [&](int axis, auto low, auto high, Real* middle,
                           Real* half_width) SHEAF_LAMBDA {
    const auto to_shear = hn::Mul(sign_of(axis), sign_z);
    hn::Store(hn::Mul(hn::Mul(hn::Add(low, high), half), to_shear), d, middle);
    hn::Store(hn::MulAdd(hn::Sub(high, low), half, slack_of_half), d, half_width);
    // A box's planes are met at (plane - origin) / slope. Empty packets are never asked.
    const auto unit = sign_of(axis);
    const auto enter = hn::Mul(hn::Div(unit, high), hn::Set(d, 1 - kFrustumSlack<Real>));
    const auto leave = hn::Mul(hn::Div(unit, low), hn::Set(d, 1 + kFrustumSlack<Real>));
    hn::Store(enter, d, beam.enter_scale[axis]);
    hn::Store(leave, d, beam.leave_scale[axis]);
    const Real sign = backward[axis] ? Real(-1) : Real(1);
    beam.all_enter_scale[axis] = sign * hn::GetLane(hn::MinOfLanes(d, hn::Abs(enter)));
    beam.all_leave_scale[axis] = sign * hn::GetLane(hn::MaxOfLanes(d, hn::Abs(leave)));
  };
  if (IsSpread(tree, frustum, low_x, high_x, low_y, high_y)) return false;
  // An empty packet takes the first one's range.
  for (std::uint32_t k = 0; k < LaneCount(d); ++k) {
    if (beam.t_last[k] != kDone<Real>) continue;
    low_x[k] = low_x[0];
    high_x[k] = high_x[0];
    low_y[k] = low_y[0];
    high_y[k] = high_y[0];
  }
  prepare(frustum.kx, hn::Load(d, low_x), hn::Load(d, high_x), frustum.middle_x, frustum.half_x);
  prepare(frustum.ky, hn::Load(d, low_y), hn::Load(d, high_y), frustum.middle_y, frustum.half_y);
  hn::Store(sign_z, d, beam.enter_scale[frustum.kz]);
  hn::Store(sign_z, d, beam.leave_scale[frustum.kz]);
  beam.all_enter_scale[frustum.kz] = beam.all_leave_scale[frustum.kz] = frustum.sign;
  for (int axis = 0; axis < 3; ++axis) {
    const Real o = first.origin[axis][one];
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
  return true;
}

// ---- Leaves ----

template <typename Real>
HWY_INLINE void LoadTriangles(const Frustum<Real>& frustum, const Real* block, std::uint32_t n,
                              FrustumLeaf<Real>& leaf) {
  const LeafLanes<Real> d;
  using V = hn::Vec<LeafLanes<Real>>;
  const V ox = hn::Set(d, frustum.origin[0]), oy = hn::Set(d, frustum.origin[1]),
          oz = hn::Set(d, frustum.origin[2]);
  const V sign = hn::Set(d, frustum.sign);
  for (std::uint32_t i = 0; i < n; i += LaneCount(d)) {
    V width = hn::Zero(d), depth = hn::Zero(d), nearest = hn::Set(d, kDefaultTMax<Real>);
    for (int vertex = 0; vertex < 3; ++vertex) {
      const V x = hn::Sub(hn::LoadU(d, block + (3 * vertex + frustum.kx) * n + i), ox);
      const V y = hn::Sub(hn::LoadU(d, block + (3 * vertex + frustum.ky) * n + i), oy);
      const V z = hn::Sub(hn::LoadU(d, block + (3 * vertex + frustum.kz) * n + i), oz);
      hn::Store(x, d, leaf.x[vertex] + i);
      hn::Store(y, d, leaf.y[vertex] + i);
      hn::Store(z, d, leaf.z[vertex] + i);
      width = hn::Max(width, hn::Max(hn::Abs(x), hn::Abs(y)));
      depth = hn::Max(depth, hn::Abs(z));
      nearest = hn::Min(nearest, hn::Mul(z, sign));
    }
    hn::Store(depth, d, leaf.depth + i);
    hn::Store(hn::Mul(hn::Add(width, depth), hn::Set(d, kFrustumSlack<Real>)), d, leaf.slack + i);
    // A hit may lie before the nearest vertex by roundoffs of the furthest (KeepInExtent), or of t
    // where that is denormal.
    const V slack =
        hn::MulAdd(depth, hn::Set(d, kFrustumSlack<Real>), hn::Set(d, Real(kBoxAbsoluteSlack)));
    hn::Store(hn::Sub(nearest, slack), d, leaf.nearest + i);
  }
}

// One edge of triangles sheared about the middle of a packet: whether the edge function is negative
// for all its rays, and whether it is positive for all. It is linear in the shear.
template <class D, class M, class V = hn::Vec<D>>
HWY_INLINE void BoundEdge(D d, V px, V py, V pz, V qx, V qy, V qz, V half_x, V half_y, V slack,
                          M& negative, M& positive) {
  const V middle = hn::NegMulAdd(py, qx, hn::Mul(px, qy));
  const V along_x = hn::NegMulAdd(pz, qy, hn::Mul(qz, py));
  const V along_y = hn::NegMulAdd(qz, px, hn::Mul(pz, qx));
  const V reach = hn::MulAdd(half_x, hn::Abs(along_x), hn::MulAdd(half_y, hn::Abs(along_y), slack));
  const V zero = hn::Zero(d);
  negative = hn::Or(negative, hn::Lt(hn::Add(middle, reach), zero));
  positive = hn::Or(positive, hn::Gt(hn::Sub(middle, reach), zero));
}

// Triangles that some ray of packet k may hit, as bits.
template <typename Real>
HWY_INLINE std::uint32_t CullTriangles(const Frustum<Real>& frustum, const FrustumLeaf<Real>& leaf,
                                       std::uint32_t n, std::uint32_t k) {
  const LeafLanes<Real> d;
  using V = hn::Vec<LeafLanes<Real>>;
  const V mx = hn::Set(d, frustum.middle_x[k]), my = hn::Set(d, frustum.middle_y[k]);
  const V hx = hn::Set(d, frustum.half_x[k]), hy = hn::Set(d, frustum.half_y[k]);
  std::uint32_t met = 0;
  for (std::uint32_t i = 0; i < n; i += LaneCount(d)) {
    const V az = hn::Load(d, leaf.z[0] + i), bz = hn::Load(d, leaf.z[1] + i),
            cz = hn::Load(d, leaf.z[2] + i);
    const V ax = hn::NegMulAdd(mx, az, hn::Load(d, leaf.x[0] + i));
    const V ay = hn::NegMulAdd(my, az, hn::Load(d, leaf.y[0] + i));
    const V bx = hn::NegMulAdd(mx, bz, hn::Load(d, leaf.x[1] + i));
    const V by = hn::NegMulAdd(my, bz, hn::Load(d, leaf.y[1] + i));
    const V cx = hn::NegMulAdd(mx, cz, hn::Load(d, leaf.x[2] + i));
    const V cy = hn::NegMulAdd(my, cz, hn::Load(d, leaf.y[2] + i));
    const V depth = hn::Load(d, leaf.depth + i), slack = hn::Load(d, leaf.slack + i);
    // The triangle's rectangle, which rays within `half` of the middle reach.
    const V reach_x = hn::MulAdd(hx, depth, slack), reach_y = hn::MulAdd(hy, depth, slack);
    const V low_x = hn::Min(hn::Min(ax, bx), cx), high_x = hn::Max(hn::Max(ax, bx), cx);
    const V low_y = hn::Min(hn::Min(ay, by), cy), high_y = hn::Max(hn::Max(ay, by), cy);
    auto out = hn::Or(hn::Gt(low_x, reach_x), hn::Lt(hn::Add(high_x, reach_x), hn::Zero(d)));
    out = hn::Or(out, hn::Gt(low_y, reach_y));
    out = hn::Or(out, hn::Lt(hn::Add(high_y, reach_y), hn::Zero(d)));
    out = hn::Or(out, hn::Gt(hn::Load(d, leaf.nearest + i), hn::Set(d, frustum.beam.t_last[k])));
    // Not all edges can be on one side.
    auto negative = NoLanes(d), positive = NoLanes(d);
    const V size =
        hn::Max(hn::Max(hn::Abs(low_x), hn::Abs(high_x)), hn::Max(hn::Abs(low_y), hn::Abs(high_y)));
    const V edge_slack = hn::Mul(hn::Add(size, hn::Add(reach_x, reach_y)), slack);
    BoundEdge(d, cx, cy, cz, bx, by, bz, hx, hy, edge_slack, negative, positive);
    BoundEdge(d, ax, ay, az, cx, cy, cz, hx, hy, edge_slack, negative, positive);
    BoundEdge(d, bx, by, bz, ax, ay, az, hx, hy, edge_slack, negative, positive);
    out = hn::Or(out, hn::And(negative, positive));
    met |= MaskBits(d, hn::AndNot(out, LanesBelow(d, i, n))) << i;
  }
  return met;
}

template <Query kQuery, typename Real>
HWY_INLINE void TrianglesAgainstFrustum(const TreeView<Real>& tree, std::uint32_t child,
                                        Frustum<Real>& frustum, std::uint32_t packets) {
  const Lanes<Real> d;
  const std::uint32_t n = LeafCount(child);
  const std::uint32_t* ids = IdsOf<PrimitiveKind::kTriangle>(tree, child);
  FrustumLeaf<Real> leaf;
  LoadTriangles(frustum, BlockOf<PrimitiveKind::kTriangle>(tree, child), n, leaf);
  for (; packets != 0; packets &= packets - 1) {
    const auto k = static_cast<std::uint32_t>(std::countr_zero(packets));
    Packet<Real>& packet = frustum.packets[k];
    std::uint32_t met = CullTriangles(frustum, leaf, n, k);
    if (met == 0) continue;
    const auto open = OpenMask(d, packet);
    for (; met != 0; met &= met - 1) {
      const int i = std::countr_zero(met);
      const auto x = [&](int v) SHEAF_LAMBDA { return hn::Set(d, leaf.x[v][i]); };
      const auto y = [&](int v) SHEAF_LAMBDA { return hn::Set(d, leaf.y[v][i]); };
      const auto z = [&](int v) SHEAF_LAMBDA { return hn::Set(d, leaf.z[v][i]); };
      TriangleAgainstPacket<kQuery>(d, packet, frustum.kz, x(0), y(0), z(0), x(1), y(1), z(1), x(2),
                                    y(2), z(2), ids[i], open);
    }
    frustum.beam.t_last[k] = LastDepth(frustum, packet);
  }
}

// Spheres that some ray of packet k may hit, as bits. Sheared along a ray, a sphere reaches its
// radius times sqrt(1 + shear^2) to either side.
template <typename Real>
HWY_INLINE std::uint32_t CullSpheres(const Frustum<Real>& frustum, const Real* block,
                                     std::uint32_t n, std::uint32_t k) {
  const LeafLanes<Real> d;
  using V = hn::Vec<LeafLanes<Real>>;
  const auto side = [&](Real middle, Real half) {
    const Real most = std::abs(middle) + half;
    return std::sqrt(1 + most * most) * (1 + kFrustumSlack<Real>);
  };
  const V mx = hn::Set(d, frustum.middle_x[k]), my = hn::Set(d, frustum.middle_y[k]);
  const V hx = hn::Set(d, frustum.half_x[k]), hy = hn::Set(d, frustum.half_y[k]);
  const V grow_x = hn::Set(d, side(frustum.middle_x[k], frustum.half_x[k]));
  const V grow_y = hn::Set(d, side(frustum.middle_y[k], frustum.half_y[k]));
  std::uint32_t met = 0;
  for (std::uint32_t i = 0; i < n; i += LaneCount(d)) {
    const V x = hn::Sub(hn::LoadU(d, block + frustum.kx * n + i), hn::Set(d, frustum.origin[0]));
    const V y = hn::Sub(hn::LoadU(d, block + frustum.ky * n + i), hn::Set(d, frustum.origin[1]));
    const V z = hn::Sub(hn::LoadU(d, block + frustum.kz * n + i), hn::Set(d, frustum.origin[2]));
    const V r = hn::LoadU(d, block + 3 * n + i);
    const V depth = hn::Add(hn::Abs(z), r);
    const V slack =
        hn::Mul(hn::Add(hn::Add(hn::Abs(x), hn::Abs(y)), depth), hn::Set(d, kFrustumSlack<Real>));
    const V off_x = hn::Abs(hn::NegMulAdd(mx, z, x)), off_y = hn::Abs(hn::NegMulAdd(my, z, y));
    const V reach_x = hn::MulAdd(hx, depth, hn::MulAdd(grow_x, r, slack));
    const V reach_y = hn::MulAdd(hy, depth, hn::MulAdd(grow_y, r, slack));
    const V nearest = hn::Sub(hn::MulSub(z, hn::Set(d, frustum.sign), r),
                              hn::Add(slack, hn::Set(d, Real(kBoxAbsoluteSlack))));
    auto out = hn::Or(hn::Gt(off_x, reach_x), hn::Gt(off_y, reach_y));
    out = hn::Or(out, hn::Gt(nearest, hn::Set(d, frustum.beam.t_last[k])));
    met |= MaskBits(d, hn::AndNot(out, LanesBelow(d, i, n))) << i;
  }
  return met;
}

template <Query kQuery, typename Real>
HWY_INLINE void SpheresAgainstFrustum(const TreeView<Real>& tree, std::uint32_t child,
                                      Frustum<Real>& frustum, std::uint32_t packets) {
  const Lanes<Real> d;
  const std::uint32_t n = LeafCount(child);
  const Real* block = BlockOf(tree, child);
  for (; packets != 0; packets &= packets - 1) {
    const auto k = static_cast<std::uint32_t>(std::countr_zero(packets));
    Packet<Real>& packet = frustum.packets[k];
    const std::uint32_t met = CullSpheres(frustum, block, n, k);
    if (met == 0) continue;
    const auto open = OpenMask(d, packet);
    LeafAgainstPacket<kQuery>(d, tree, child, met, packet, open);
    frustum.beam.t_last[k] = LastDepth(frustum, packet);
  }
}

// ---- The tree ----

// PrepareFrustum has said yes.
template <Query kQuery, typename Real>
HWY_NOINLINE void TraceFrustum(const TreeView<Real>& tree, Frustum<Real>& frustum) {
  const Lanes<Real> d;
  TraceBeam(tree, frustum.beam, 0, [&](std::uint32_t child, auto met) SHEAF_LAMBDA {
    std::uint32_t packets = MaskBits(d, met);
    if (IsLeaf(child)) {
      if (HasTriangles(child)) {
        TrianglesAgainstFrustum<kQuery>(tree, child, frustum, packets);
      } else {
        SpheresAgainstFrustum<kQuery>(tree, child, frustum, packets);
      }
      return Visit::kDone;
    }
    if (static_cast<std::uint32_t>(std::popcount(packets)) > FewPackets<kQuery, Real>()) {
      return Visit::kDescend;
    }
    for (; packets != 0; packets &= packets - 1) {
      const auto k = static_cast<std::uint32_t>(std::countr_zero(packets));
      PrepareBoxes(tree, frustum.packets[k]);
      TracePacketFrom<kQuery>(tree, frustum.packets[k], OpenLanes(frustum.packets[k]), child);
      frustum.beam.t_last[k] = LastDepth(frustum, frustum.packets[k]);
    }
    return Visit::kDone;
  });
}

}  // namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // SHEAF_SIMD_TRACE_FRUSTUM_INL_H_
