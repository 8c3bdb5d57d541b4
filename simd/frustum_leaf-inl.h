// Tests the primitives of a leaf against the packets of a frustum.
//
// Before the rays of a packet meet a triangle, the triangle is culled against the packet as a
// whole. Lanes are the triangles of the leaf or the packets of the frustum, whichever are more.
#if defined(SHEAF_SIMD_FRUSTUM_LEAF_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SHEAF_SIMD_FRUSTUM_LEAF_INL_H_
#undef SHEAF_SIMD_FRUSTUM_LEAF_INL_H_
#else
#define SHEAF_SIMD_FRUSTUM_LEAF_INL_H_
#endif

#include "simd/frustum-inl.h"

HWY_BEFORE_NAMESPACE();
namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE {

// The vertices of a leaf's triangles relative to the frustum's origin, and what the tests against
// all packets share.
template <typename Real>
struct alignas(kAlignment) FrustumLeaf {
  Real x[3][kMaxLeafSize], y[3][kMaxLeafSize], z[3][kMaxLeafSize];  // [vertex]
  Real nearest[kMaxLeafSize];  // the least distance along the dominant axis
  Real depth[kMaxLeafSize];    // the largest |z|
  Real slack[kMaxLeafSize];    // of x and y once sheared
  const Real* block;           // the vertices as they are
  std::uint32_t count;
};

template <typename Real>
HWY_INLINE void LoadTriangles(const Frustum<Real>& frustum, const Real* block, std::uint32_t n,
                              FrustumLeaf<Real>& leaf) {
  const LeafLanes<Real> d;
  using V = hn::Vec<LeafLanes<Real>>;
  const V ox = hn::Set(d, frustum.origin[0]), oy = hn::Set(d, frustum.origin[1]),
          oz = hn::Set(d, frustum.origin[2]);
  const V sign = hn::Set(d, frustum.sign);
  leaf.block = block;
  leaf.count = n;
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
    // Rounding may put a hit before the nearest vertex: by roundoffs of the furthest vertex
    // (KeepInExtent), or of t where that is denormal.
    const V slack =
        hn::MulAdd(depth, hn::Set(d, kFrustumSlack<Real>), hn::Set(d, Real(kBoxAbsoluteSlack)));
    hn::Store(hn::Sub(nearest, slack), d, leaf.nearest + i);
  }
}

// An edge of triangles that are sheared by the packet's middle. Sets `negative` where the edge
// function is negative for all rays, `positive` likewise. The function is linear in the shear.
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

// Whether all rays of a packet miss a triangle, one pair a lane. (mx, my) is the middle of the
// packet's shears, (hx, hy) half their range; `t_last` its end; `depth`, `slack` and `nearest` are
// the triangle's, see FrustumLeaf.
template <class D, class V = hn::Vec<D>>
HWY_INLINE hn::Mask<D> PacketMisses(D d, V mx, V my, V hx, V hy, V t_last, V ax, V ay, V az, V bx,
                                    V by, V bz, V cx, V cy, V cz, V depth, V slack, V nearest) {
  ax = hn::NegMulAdd(mx, az, ax);
  ay = hn::NegMulAdd(my, az, ay);
  bx = hn::NegMulAdd(mx, bz, bx);
  by = hn::NegMulAdd(my, bz, by);
  cx = hn::NegMulAdd(mx, cz, cx);
  cy = hn::NegMulAdd(my, cz, cy);
  // The bounds of the triangle against the rectangle that the packet's rays cover.
  const V reach_x = hn::MulAdd(hx, depth, slack), reach_y = hn::MulAdd(hy, depth, slack);
  const V low_x = hn::Min(hn::Min(ax, bx), cx), high_x = hn::Max(hn::Max(ax, bx), cx);
  const V low_y = hn::Min(hn::Min(ay, by), cy), high_y = hn::Max(hn::Max(ay, by), cy);
  auto out = hn::Or(hn::Gt(low_x, reach_x), hn::Lt(hn::Add(high_x, reach_x), hn::Zero(d)));
  out = hn::Or(out, hn::Gt(low_y, reach_y));
  out = hn::Or(out, hn::Lt(hn::Add(high_y, reach_y), hn::Zero(d)));
  out = hn::Or(out, hn::Gt(nearest, t_last));
  // No ray is inside where one edge function is negative for all rays and another positive.
  auto negative = NoLanes(d), positive = NoLanes(d);
  const V size =
      hn::Max(hn::Max(hn::Abs(low_x), hn::Abs(high_x)), hn::Max(hn::Abs(low_y), hn::Abs(high_y)));
  const V edge_slack = hn::Mul(hn::Add(size, hn::Add(reach_x, reach_y)), slack);
  BoundEdge(d, cx, cy, cz, bx, by, bz, hx, hy, edge_slack, negative, positive);
  BoundEdge(d, ax, ay, az, cx, cy, cz, hx, hy, edge_slack, negative, positive);
  BoundEdge(d, bx, by, bz, ax, ay, az, hx, hy, edge_slack, negative, positive);
  return hn::Or(out, hn::And(negative, positive));
}

// Bits of the triangles that some ray of packet k may hit.
template <typename Real>
HWY_INLINE std::uint32_t CullTriangles(const Frustum<Real>& frustum, const FrustumLeaf<Real>& leaf,
                                       std::uint32_t n, std::uint32_t k) {
  const LeafLanes<Real> d;
  std::uint32_t met = 0;
  for (std::uint32_t i = 0; i < n; i += LaneCount(d)) {
    const auto x = [&](int v) SHEAF_LAMBDA { return hn::Load(d, leaf.x[v] + i); };
    const auto y = [&](int v) SHEAF_LAMBDA { return hn::Load(d, leaf.y[v] + i); };
    const auto z = [&](int v) SHEAF_LAMBDA { return hn::Load(d, leaf.z[v] + i); };
    const auto out = PacketMisses(
        d, hn::Set(d, frustum.middle_x[k]), hn::Set(d, frustum.middle_y[k]),
        hn::Set(d, frustum.half_x[k]), hn::Set(d, frustum.half_y[k]),
        hn::Set(d, frustum.beam.t_last[k]), x(0), y(0), z(0), x(1), y(1), z(1), x(2), y(2), z(2),
        hn::Load(d, leaf.depth + i), hn::Load(d, leaf.slack + i), hn::Load(d, leaf.nearest + i));
    met |= MaskBits(d, hn::AndNot(out, LanesBelow(d, i, n))) << i;
  }
  return met;
}

// Bits of the packets of which some ray may hit triangle i. Empty packets are among them.
template <typename Real>
HWY_INLINE std::uint32_t CullPackets(const Frustum<Real>& frustum, const FrustumLeaf<Real>& leaf,
                                     int i) {
  const Lanes<Real> d;
  const auto x = [&](int v) SHEAF_LAMBDA { return hn::Set(d, leaf.x[v][i]); };
  const auto y = [&](int v) SHEAF_LAMBDA { return hn::Set(d, leaf.y[v][i]); };
  const auto z = [&](int v) SHEAF_LAMBDA { return hn::Set(d, leaf.z[v][i]); };
  return MaskBits(
      d, hn::Not(PacketMisses(d, hn::Load(d, frustum.middle_x), hn::Load(d, frustum.middle_y),
                              hn::Load(d, frustum.half_x), hn::Load(d, frustum.half_y),
                              hn::Load(d, frustum.beam.t_last), x(0), y(0), z(0), x(1), y(1), z(1),
                              x(2), y(2), z(2), hn::Set(d, leaf.depth[i]),
                              hn::Set(d, leaf.slack[i]), hn::Set(d, leaf.nearest[i]))));
}

// Tests triangle i of the leaf against the rays of packet k. Returns whether a ray took the hit.
template <class Output, typename Real>
HWY_INLINE bool TriangleAgainstFrustum(const Batch<Output, Real>& batch, Frustum<Real>& frustum,
                                       const FrustumLeaf<Real>& leaf, int i, std::uint32_t id,
                                       std::uint32_t k) {
  const Lanes<Real> d;
  const auto open = hn::Gt(hn::Load(d, frustum.t_best[k]), hn::Set(d, kDone<Real>));
  const auto x = [&](int v) SHEAF_LAMBDA { return hn::Set(d, leaf.x[v][i]); };
  const auto y = [&](int v) SHEAF_LAMBDA { return hn::Set(d, leaf.y[v][i]); };
  const auto z = [&](int v) SHEAF_LAMBDA { return hn::Set(d, leaf.z[v][i]); };
  const auto hit = TriangleAgainstRays<Output::kQuery>(
      d, FrustumRays<Output, Real>{batch, frustum, k}, frustum.kz, x(0), y(0), z(0), x(1), y(1),
      z(1), x(2), y(2), z(2), BlockColumns<Real>{leaf.block + i, leaf.count, 0}, id, open);
  const std::uint32_t bits = MaskBits(d, hit);
  frustum.without_hit[k] &= ~bits;
  return bits != 0;
}

// Updates the end of packet k after new hits. It moves only once every ray has a hit. Until then
// the furthest ray without one decides, and the old end is a bound that does.
template <class Output, typename Real>
HWY_INLINE void UpdateEnd(const Batch<Output, Real>& batch, Frustum<Real>& frustum,
                          std::uint32_t k) {
  if (frustum.without_hit[k] == 0) frustum.beam.t_last[k] = LastDepth(batch, frustum, k);
}

template <class Output, typename Real>
HWY_INLINE void TrianglesAgainstFrustum(const Batch<Output, Real>& batch, std::uint32_t child,
                                        Frustum<Real>& frustum, std::uint32_t packets) {
  const TreeView<Real>& tree = batch.tree;
  const std::uint32_t n = LeafCount(child);
  const std::uint32_t* const ids = IdsOf<PrimitiveKind::kTriangle>(tree, child);
  FrustumLeaf<Real> leaf;
  LoadTriangles(frustum, BlockOf<PrimitiveKind::kTriangle>(tree, child), n, leaf);
  std::uint32_t changed = 0;
  if (static_cast<std::uint32_t>(std::popcount(packets)) > n) {
    for (std::uint32_t i = 0; i < n; ++i) {
      const int triangle = static_cast<int>(i);
      std::uint32_t met = CullPackets(frustum, leaf, triangle) & packets;
      for (; met != 0; met &= met - 1) {
        const auto k = static_cast<std::uint32_t>(std::countr_zero(met));
        const bool kept = TriangleAgainstFrustum(batch, frustum, leaf, triangle, ids[i], k);
        changed |= static_cast<std::uint32_t>(kept) << k;
      }
    }
  } else {
    for (; packets != 0; packets &= packets - 1) {
      const auto k = static_cast<std::uint32_t>(std::countr_zero(packets));
      for (std::uint32_t met = CullTriangles(frustum, leaf, n, k); met != 0; met &= met - 1) {
        const int i = std::countr_zero(met);
        const bool kept = TriangleAgainstFrustum(batch, frustum, leaf, i, ids[i], k);
        changed |= static_cast<std::uint32_t>(kept) << k;
      }
    }
  }
  for (; changed != 0; changed &= changed - 1) {
    UpdateEnd(batch, frustum, static_cast<std::uint32_t>(std::countr_zero(changed)));
  }
}

// Bits of the spheres that some ray of packet k may hit. A sheared sphere extends by its radius
// times sqrt(1 + shear^2) to either side.
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

// A leaf of any kind but triangles, whose spheres, or those around its primitives, are the screen.
template <class Output, typename Real>
HWY_INLINE void ScreenedAgainstFrustum(const Batch<Output, Real>& batch, std::uint32_t child,
                                       Frustum<Real>& frustum, std::uint32_t packets) {
  const Lanes<Real> d;
  const std::uint32_t n = LeafCount(child);
  const Real* block = BlockOf(batch.tree, child);
  const std::uint32_t* const ids = batch.tree.of(LeafKind(child)).id + LeafFirst(child);
  for (; packets != 0; packets &= packets - 1) {
    const auto k = static_cast<std::uint32_t>(std::countr_zero(packets));
    std::uint32_t hits = 0;
    for (std::uint32_t met = CullSpheres(frustum, block, n, k); met != 0; met &= met - 1) {
      const auto i = static_cast<std::uint32_t>(std::countr_zero(met));
      const auto open = hn::Gt(hn::Load(d, frustum.t_best[k]), hn::Set(d, kDone<Real>));
      hits |= MaskBits(
          d, ScreenedAgainstRays<Output::kQuery>(d, FrustumRays<Output, Real>{batch, frustum, k},
                                                 LeafKind(child), block, n, i, ids[i], open));
    }
    frustum.without_hit[k] &= ~hits;
    if (hits != 0) UpdateEnd(batch, frustum, k);
  }
}

}  // namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // SHEAF_SIMD_FRUSTUM_LEAF_INL_H_
