// The primitives of a leaf against a packet, or against one of its rays.
//
// A packet tests one primitive at a time, a single ray all of the leaf's at once. Either way a lane
// holds a pair of a ray and a primitive.
#if defined(SHEAF_SIMD_LEAF_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SHEAF_SIMD_LEAF_INL_H_
#undef SHEAF_SIMD_LEAF_INL_H_
#else
#define SHEAF_SIMD_LEAF_INL_H_
#endif

#include <bit>

#include "simd/disk-inl.h"
#include "simd/packet-inl.h"
#include "simd/query.h"
#include "simd/sphere-inl.h"
#include "simd/streams.h"
#include "simd/tree.h"
#include "simd/triangle-inl.h"

HWY_BEFORE_NAMESPACE();
namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE {

// As many lanes as a leaf has primitives, or a node children.
template <typename Real>
using LeafLanes = hn::CappedTag<Real, kMaxLeafSize>;

// The fields of a leaf's block, and the ids of its primitives. kKind is the leaf's.
template <PrimitiveKind kKind, typename Real>
HWY_INLINE const Real* BlockOf(const TreeView<Real>& tree, std::uint32_t leaf) {
  return tree.of(kKind).fields + std::size_t{FieldCountOf(kKind)} * LeafFirst(leaf);
}
template <PrimitiveKind kKind, typename Real>
HWY_INLINE const std::uint32_t* IdsOf(const TreeView<Real>& tree, std::uint32_t leaf) {
  return tree.of(kKind).id + LeafFirst(leaf);
}

// The same where the kind is not known.
template <typename Real>
HWY_INLINE const Real* BlockOf(const TreeView<Real>& tree, std::uint32_t leaf) {
  const PrimitiveKind kind = LeafKind(leaf);
  return tree.of(kind).fields + std::size_t{FieldCountOf(kind)} * LeafFirst(leaf);
}

HWY_INLINE bool HasTriangles(std::uint32_t leaf) {
  return LeafKind(leaf) == PrimitiveKind::kTriangle;
}

// ---- A packet ----

// Where the hits of a vector of rays are kept.
template <typename Real>
struct HitSlots {
  Real* t_best;
  // Left alone where kOccluded is asked. A triangle's u and v are kept times det, because most hits
  // are not the last: FinishSurfaceCoordinates divides. Other primitives keep 1 as det.
  Real *u, *v, *det;
  std::uint32_t* id;
};

// Takes the lanes of `hit` whose t is nearer than what they had, or as near with a lower id. Every
// t is at most t_best.
template <Query kQuery, class D, class M, class V, class VI, typename Real = hn::TFromD<D>>
HWY_INLINE void KeepHits(D d, const HitSlots<Real>& slots, M hit, V t, V u, V v, V det, VI id) {
  const IdLanes<D> di;
  const auto t_best = hn::LoadU(d, slots.t_best);
  const auto id_best = LoadIds(d, slots.id);
  const auto lower = hn::RebindMask(d, hn::Lt(id, id_best));
  const auto closer = hn::And(hit, hn::Or(hn::Lt(t, t_best), lower));
  const auto t_new = kQuery == Query::kClosest ? t : hn::Set(d, kDone<Real>);
  hn::StoreU(hn::IfThenElse(closer, t_new, t_best), d, slots.t_best);
  StoreIds(d, hn::IfThenElse(hn::RebindMask(di, closer), id, id_best), slots.id);
  if constexpr (kQuery == Query::kClosest) {
    hn::StoreU(hn::IfThenElse(closer, u, hn::LoadU(d, slots.u)), d, slots.u);
    hn::StoreU(hn::IfThenElse(closer, v, hn::LoadU(d, slots.v)), d, slots.v);
    hn::StoreU(hn::IfThenElse(closer, det, hn::LoadU(d, slots.det)), d, slots.det);
  }
}

// Surface coordinates, u or v, of a vector of hits: HitSlots.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V FinishSurfaceCoordinates(D d, V kept, V det) {
  return hn::IfThenElse(hn::Eq(det, hn::Set(d, 1)), kept, Divide(d, kept, det));
}

// A vector of rays as the tests of primitives read them. Pointers need no alignment; t_min and the
// sources are asked for, because a batch may have one for all.
template <typename Real>
struct PacketRays {
  Packet<Real>& packet;

  HWY_INLINE const Real* origin(int axis) const { return packet.origin[axis]; }
  HWY_INLINE const Real* direction(int axis) const { return packet.direction[axis]; }
  HWY_INLINE const Real* shear_x() const { return packet.shear_x; }
  HWY_INLINE const Real* shear_y() const { return packet.shear_y; }
  HWY_INLINE const Real* screen() const { return packet.screen; }
  HWY_INLINE HitSlots<Real> slots() const {
    return {packet.t_best, packet.u, packet.v, packet.det, packet.id};
  }
  template <class D>
  HWY_INLINE hn::Vec<D> TMin(D d) const {
    return hn::Load(d, packet.t_min);
  }
  template <class D>
  HWY_INLINE hn::Vec<IdLanes<D>> Sources(D d) const {
    return LoadIds(d, packet.source);
  }
};

// The fields of a block of n, from one primitive on: all lanes have it (stride 0), or each the
// next.
template <typename Real>
struct BlockColumns {
  const Real* first;
  std::uint32_t n, stride;

  HWY_INLINE PairColumn<Real> operator[](std::uint32_t field) const {
    return {first + field * n, stride};
  }
};

template <typename Real>
HWY_INLINE TrianglePairs<Real> PairsOf(const PairColumn<Real> (&origin)[3],
                                       const PairColumn<Real> (&direction)[3],
                                       const BlockColumns<Real>& fields) {
  return {{origin[0], origin[1], origin[2]},
          {direction[0], direction[1], direction[2]},
          {{fields[0], fields[1], fields[2]},
           {fields[3], fields[4], fields[5]},
           {fields[6], fields[7], fields[8]}}};
}

// One triangle, vertices relative to the rays' origins in the order kx, ky, kz of `axis`, against
// the rays of `lanes`, all of that axis; `fields` has the vertices as they are. Returns the lanes
// that hit it, which are kept.
template <Query kQuery, class D, class Rays, class M, class V, typename Real = hn::TFromD<D>>
HWY_INLINE M TriangleAgainstRays(D d, const Rays& rays, int axis, V ax, V ay, V az, V bx, V by,
                                 V bz, V cx, V cy, V cz, const BlockColumns<Real>& fields,
                                 std::uint32_t id, M lanes) {
  const int kx = axis == 2 ? 0 : axis + 1, ky = axis == 0 ? 2 : axis - 1;
  const IdLanes<D> di;
  using Id = hn::TFromD<IdLanes<D>>;
  const auto ids = hn::Set(di, Id{id});
  const auto elsewhere = [&]() SHEAF_LAMBDA {
    const auto source = hn::And(rays.Sources(d), hn::Set(di, Id{~kInsideBit}));
    return hn::RebindMask(d, hn::Ne(source, ids));
  };
  const auto refine = [&](auto far, V t) SHEAF_LAMBDA {
    const TrianglePairs<Real> pairs = PairsOf<Real>(
        {{rays.origin(0), 1}, {rays.origin(1), 1}, {rays.origin(2), 1}},
        {{rays.direction(0), 1}, {rays.direction(1), 1}, {rays.direction(2), 1}}, fields);
    return RefineT(d, pairs, MaskBits(d, far), t);
  };
  const V t_min = rays.TMin(d);
  V t, v, w, det;
  const M inside = HitTriangle(d, ax, ay, az, bx, by, bz, cx, cy, cz, hn::LoadU(d, rays.shear_x()),
                               hn::LoadU(d, rays.shear_y()), hn::LoadU(d, rays.direction(kx)),
                               hn::LoadU(d, rays.direction(ky)), hn::LoadU(d, rays.direction(axis)),
                               t_min, lanes, elsewhere, refine, t, v, w, det);
  if (hn::AllFalse(d, inside)) return inside;
  const auto slots = rays.slots();
  const M within = hn::And(hn::Le(t_min, t), hn::Le(t, hn::LoadU(d, slots.t_best)));
  const M hit = hn::And(inside, within);
  if (hn::AllFalse(d, hit)) return hit;
  KeepHits<kQuery>(d, slots, hit, t, v, w, det, ids);
  return hit;
}

// What spheres and disks differ in, once the sphere around them passed the screen: which rays start
// on them and see nothing of them, and the hit.
struct SphereTest {
  static constexpr PrimitiveKind kKind = PrimitiveKind::kSphere;

  template <class D, class VI>
  static HWY_INLINE hn::Mask<D> StartsOn(D d, VI source, VI id) {
    return hn::RebindMask(d, hn::Eq(source, id));
  }
  template <Query kQuery, class D, class V, class M, class VI, typename Real = hn::TFromD<D>>
  static HWY_INLINE M Hit(D d, const SpherePairs<Real>& pairs, const BlockColumns<Real>&, VI source,
                          VI id, V t_min, V t_max, M screened, V& t, V& u, V& v) {
    return HitSphere(d, pairs, source, id, t_min, t_max, screened, t, u, v);
  }
};

struct DiskTest {
  static constexpr PrimitiveKind kKind = PrimitiveKind::kDisk;

  template <class D, class VI>
  static HWY_INLINE hn::Mask<D> StartsOn(D d, VI source, VI id) {
    const auto either_side = hn::Set(IdLanes<D>(), hn::TFromD<IdLanes<D>>{~kInsideBit});
    return hn::RebindMask(d, hn::Eq(hn::And(source, either_side), id));
  }
  template <Query kQuery, class D, class V, class M, class VI, typename Real = hn::TFromD<D>>
  static HWY_INLINE M Hit(D d, const SpherePairs<Real>& pairs, const BlockColumns<Real>& fields,
                          VI /*source*/, VI /*id*/, V t_min, V t_max, M screened, V& t, V& u,
                          V& v) {
    const PairColumn<Real> normal[3] = {fields[4], fields[5], fields[6]};
    return HitDisk<kQuery>(d, pairs, normal, t_min, t_max, screened, t, u, v);
  }
};

// Primitive `i` of a block of `n` against the rays of `lanes`. Returns the lanes that hit it, which
// are kept.
template <Query kQuery, class Test, class D, class Rays, class M, typename Real = hn::TFromD<D>>
HWY_NOINLINE M ScreenedAgainstRays(D d, const Rays& rays, const Real* block, std::uint32_t n,
                                   std::uint32_t i, std::uint32_t id, M lanes) {
  using V = hn::Vec<D>;
  const IdLanes<D> di;
  using Id = hn::TFromD<IdLanes<D>>;
  const auto slots = rays.slots();
  const auto t_min = rays.TMin(d), t_best = hn::LoadU(d, slots.t_best);
  const auto source = rays.Sources(d);
  const auto ids = hn::Set(di, Id{id});
  const auto relative = [&](int axis) SHEAF_LAMBDA {
    return hn::Sub(hn::LoadU(d, rays.origin(axis)), hn::Set(d, block[axis * n + i]));
  };
  M met = MayHitSphere(d, relative(0), relative(1), relative(2), hn::LoadU(d, rays.direction(0)),
                       hn::LoadU(d, rays.direction(1)), hn::LoadU(d, rays.direction(2)),
                       hn::LoadU(d, rays.screen()), hn::Set(d, block[3 * n + i]), t_min, t_best);
  met = hn::AndNot(Test::StartsOn(d, source, ids), hn::And(lanes, met));
  if (hn::AllFalse(d, met)) return met;
  const BlockColumns<Real> fields = {block + i, n, 0};
  const SpherePairs<Real> pairs = {
      {{rays.origin(0), 1}, {rays.origin(1), 1}, {rays.origin(2), 1}},
      {{rays.direction(0), 1}, {rays.direction(1), 1}, {rays.direction(2), 1}},
      {fields[0], fields[1], fields[2]},
      fields[3]};
  V t, u, v;  // by the names of the kind: HitFields
  const M hit =
      Test::template Hit<kQuery>(d, pairs, fields, source, ids, t_min, t_best, met, t, u, v);
  if (!hn::AllFalse(d, hit)) KeepHits<kQuery>(d, slots, hit, t, u, v, hn::Set(d, 1), ids);
  return hit;
}

template <Query kQuery, class Test, class D, class M, typename Real = hn::TFromD<D>>
HWY_INLINE void EachAgainstPacket(D d, const TreeView<Real>& tree, std::uint32_t leaf,
                                  std::uint32_t wanted, Packet<Real>& packet, M lanes) {
  const Real* block = BlockOf<Test::kKind>(tree, leaf);
  const std::uint32_t* ids = IdsOf<Test::kKind>(tree, leaf);
  for (; wanted != 0; wanted &= wanted - 1) {
    const auto i = static_cast<std::uint32_t>(std::countr_zero(wanted));
    ScreenedAgainstRays<kQuery, Test>(d, PacketRays<Real>{packet}, block, LeafCount(leaf), i,
                                      ids[i], lanes);
  }
}

template <Query kQuery, class D, class M, typename Real = hn::TFromD<D>>
HWY_INLINE void TrianglesAgainstPacket(D d, const TreeView<Real>& tree, std::uint32_t leaf,
                                       std::uint32_t wanted, Packet<Real>& packet, M lanes) {
  // A packet's rays mostly share their dominant axis; where they do not, each axis takes its lanes.
  const std::uint32_t n = LeafCount(leaf);
  const Real* block = BlockOf<PrimitiveKind::kTriangle>(tree, leaf);
  const std::uint32_t* ids = IdsOf<PrimitiveKind::kTriangle>(tree, leaf);
  const IdLanes<D> di;
  const auto axes = LoadIds(d, packet.axis);
  for (int axis = 0; axis < 3; ++axis) {
    const auto same = hn::Eq(axes, hn::Set(di, static_cast<hn::TFromD<IdLanes<D>>>(axis)));
    const M along = hn::And(lanes, hn::RebindMask(d, same));
    if (hn::AllFalse(d, along)) continue;
    const int kx = (axis + 1) % 3, ky = (axis + 2) % 3;
    const auto ox = hn::Load(d, packet.origin[kx]), oy = hn::Load(d, packet.origin[ky]),
               oz = hn::Load(d, packet.origin[axis]);
    for (std::uint32_t rest = wanted; rest != 0; rest &= rest - 1) {
      const auto i = static_cast<std::uint32_t>(std::countr_zero(rest));
      const auto x = [&](int vertex) SHEAF_LAMBDA {
        return hn::Sub(hn::Set(d, block[(3 * vertex + kx) * n + i]), ox);
      };
      const auto y = [&](int vertex) SHEAF_LAMBDA {
        return hn::Sub(hn::Set(d, block[(3 * vertex + ky) * n + i]), oy);
      };
      const auto z = [&](int vertex) SHEAF_LAMBDA {
        return hn::Sub(hn::Set(d, block[(3 * vertex + axis) * n + i]), oz);
      };
      TriangleAgainstRays<kQuery>(d, PacketRays<Real>{packet}, axis, x(0), y(0), z(0), x(1), y(1),
                                  z(1), x(2), y(2), z(2), BlockColumns<Real>{block + i, n, 0},
                                  ids[i], along);
    }
  }
}

// The same for a leaf of any kind but triangles.
template <Query kQuery, class D, class Rays, class M, typename Real = hn::TFromD<D>>
HWY_INLINE M ScreenedAgainstRays(D d, const Rays& rays, PrimitiveKind kind, const Real* block,
                                 std::uint32_t n, std::uint32_t i, std::uint32_t id, M lanes) {
  if (kind == PrimitiveKind::kDisk) {
    return ScreenedAgainstRays<kQuery, DiskTest>(d, rays, block, n, i, id, lanes);
  }
  return ScreenedAgainstRays<kQuery, SphereTest>(d, rays, block, n, i, id, lanes);
}

// Primitives of the leaf whose bits are set in `wanted`.
template <Query kQuery, class D, class M, typename Real = hn::TFromD<D>>
HWY_NOINLINE void LeafAgainstPacket(D d, const TreeView<Real>& tree, std::uint32_t leaf,
                                    std::uint32_t wanted, Packet<Real>& packet, M lanes) {
  switch (LeafKind(leaf)) {
    case PrimitiveKind::kTriangle:
      return TrianglesAgainstPacket<kQuery>(d, tree, leaf, wanted, packet, lanes);
    case PrimitiveKind::kSphere:
      return EachAgainstPacket<kQuery, SphereTest>(d, tree, leaf, wanted, packet, lanes);
    case PrimitiveKind::kDisk:
      return EachAgainstPacket<kQuery, DiskTest>(d, tree, leaf, wanted, packet, lanes);
  }
}

// ---- One ray ----

template <Query kQuery, typename Real>
HWY_INLINE void KeepHit(Packet<Real>& packet, std::uint32_t lane, Real t, Real u, Real v, Real det,
                        std::uint32_t id) {
  const Real t_best = packet.t_best[lane];
  if (!(t < t_best || (t == t_best && id < packet.id[lane]))) return;
  packet.t_best[lane] = kQuery == Query::kClosest ? t : kDone<Real>;
  packet.id[lane] = id;
  packet.u[lane] = u;
  packet.v[lane] = v;
  packet.det[lane] = det;
}

template <Query kQuery, typename Real>
HWY_INLINE void TrianglesAgainstRay(const TreeView<Real>& tree, std::uint32_t leaf,
                                    Packet<Real>& packet, std::uint32_t lane) {
  const LeafLanes<Real> d;
  using V = hn::Vec<LeafLanes<Real>>;
  const std::uint32_t n = LeafCount(leaf), source = packet.source[lane];
  alignas(kAlignment) Real ts[kMaxLeafSize], us[kMaxLeafSize], vs[kMaxLeafSize];
  alignas(kAlignment) Real dets[kMaxLeafSize];
  const auto t_min = hn::Set(d, packet.t_min[lane]);
  const std::uint32_t* ids = IdsOf<PrimitiveKind::kTriangle>(tree, leaf);
  const IdLanes<LeafLanes<Real>> di;
  const auto own_id = hn::Set(di, hn::TFromD<decltype(di)>{source & ~kInsideBit});
  const std::size_t kz = packet.axis[lane], kx = kz == 2 ? 0 : kz + 1, ky = kz == 0 ? 2 : kz - 1;
  const Real* block = BlockOf<PrimitiveKind::kTriangle>(tree, leaf);
  const Real *xs = block + kx * n, *ys = block + ky * n, *zs = block + kz * n;
  const std::size_t next = std::size_t{3} * n;  // from a vertex to the next
  const auto ox = hn::Set(d, packet.origin[kx][lane]), oy = hn::Set(d, packet.origin[ky][lane]),
             oz = hn::Set(d, packet.origin[kz][lane]);
  for (std::uint32_t i = 0; i < n; i += LaneCount(d)) {
    const auto relative = [&](const Real* at, V o)
                              SHEAF_LAMBDA { return hn::Sub(hn::LoadU(d, at + i), o); };
    const auto elsewhere = [&]() SHEAF_LAMBDA {
      return hn::RebindMask(d, hn::Ne(LoadIds(d, ids + i), own_id));
    };
    const auto refine = [&](auto far, V t) SHEAF_LAMBDA {
      const auto of_ray = [&](const Real* field) -> PairColumn<Real> { return {field + lane, 0}; };
      const TrianglePairs<Real> pairs = PairsOf<Real>(
          {of_ray(packet.origin[0]), of_ray(packet.origin[1]), of_ray(packet.origin[2])},
          {of_ray(packet.direction[0]), of_ray(packet.direction[1]), of_ray(packet.direction[2])},
          BlockColumns<Real>{block + i, n, 1});
      return RefineT(d, pairs, MaskBits(d, far), t);
    };
    V t, v, w, det;
    const auto inside = HitTriangle(
        d, relative(xs, ox), relative(ys, oy), relative(zs, oz), relative(xs + next, ox),
        relative(ys + next, oy), relative(zs + next, oz), relative(xs + 2 * next, ox),
        relative(ys + 2 * next, oy), relative(zs + 2 * next, oz), hn::Set(d, packet.shear_x[lane]),
        hn::Set(d, packet.shear_y[lane]), hn::Set(d, packet.direction[kx][lane]),
        hn::Set(d, packet.direction[ky][lane]), hn::Set(d, packet.direction[kz][lane]), t_min,
        LanesBelow(d, i, n), elsewhere, refine, t, v, w, det);
    if (hn::AllFalse(d, inside)) continue;
    const auto within = hn::And(hn::Le(t_min, t), hn::Le(t, hn::Set(d, packet.t_best[lane])));
    std::uint32_t hits = MaskBits(d, hn::And(inside, within));
    if (hits == 0) continue;
    hn::Store(t, d, ts);
    hn::Store(v, d, us);
    hn::Store(w, d, vs);
    hn::Store(det, d, dets);
    for (; hits != 0; hits &= hits - 1) {
      const int k = std::countr_zero(hits);
      KeepHit<kQuery>(packet, lane, ts[k], us[k], vs[k], dets[k],
                      ids[i + static_cast<std::uint32_t>(k)]);
    }
  }
}

template <Query kQuery, class Test, typename Real>
HWY_NOINLINE void ScreenedAgainstRay(const TreeView<Real>& tree, std::uint32_t leaf,
                                     Packet<Real>& packet, std::uint32_t lane) {
  const LeafLanes<Real> d;
  using V = hn::Vec<LeafLanes<Real>>;
  const std::uint32_t n = LeafCount(leaf), source = packet.source[lane];
  const IdLanes<LeafLanes<Real>> di;
  using Id = hn::TFromD<decltype(di)>;
  alignas(kAlignment) Real ts[kMaxLeafSize], us[kMaxLeafSize], vs[kMaxLeafSize];
  const auto t_min = hn::Set(d, packet.t_min[lane]);
  const Real* block = BlockOf<Test::kKind>(tree, leaf);
  const std::uint32_t* ids_of = IdsOf<Test::kKind>(tree, leaf);
  const auto sources = hn::Set(di, Id{source});
  for (std::uint32_t i = 0; i < n; i += LaneCount(d)) {
    const auto ids = LoadIds(d, ids_of + i);
    const auto t_best = hn::Set(d, packet.t_best[lane]);
    const auto relative = [&](int axis) SHEAF_LAMBDA {
      return hn::Sub(hn::Set(d, packet.origin[axis][lane]), hn::LoadU(d, block + axis * n + i));
    };
    auto met = MayHitSphere(
        d, relative(0), relative(1), relative(2), hn::Set(d, packet.direction[0][lane]),
        hn::Set(d, packet.direction[1][lane]), hn::Set(d, packet.direction[2][lane]),
        hn::Set(d, packet.screen[lane]), hn::LoadU(d, block + 3 * n + i), t_min, t_best);
    met = hn::And(met, LanesBelow(d, i, n));
    met = hn::AndNot(Test::StartsOn(d, sources, ids), met);
    if (hn::AllFalse(d, met)) continue;
    const BlockColumns<Real> fields = {block + i, n, 1};
    const SpherePairs<Real> pairs = {
        {{packet.origin[0] + lane, 0}, {packet.origin[1] + lane, 0}, {packet.origin[2] + lane, 0}},
        {{packet.direction[0] + lane, 0},
         {packet.direction[1] + lane, 0},
         {packet.direction[2] + lane, 0}},
        {fields[0], fields[1], fields[2]},
        fields[3]};
    V t, u, v;
    std::uint32_t hits = MaskBits(
        d, Test::template Hit<kQuery>(d, pairs, fields, sources, ids, t_min, t_best, met, t, u, v));
    if (hits == 0) continue;
    hn::Store(t, d, ts);
    hn::Store(u, d, us);
    hn::Store(v, d, vs);
    for (; hits != 0; hits &= hits - 1) {
      const int k = std::countr_zero(hits);
      KeepHit<kQuery>(packet, lane, ts[k], us[k], vs[k], Real(1),
                      ids_of[i + static_cast<std::uint32_t>(k)]);
    }
  }
}

template <Query kQuery, typename Real>
HWY_INLINE void LeafAgainstRay(const TreeView<Real>& tree, std::uint32_t leaf, Packet<Real>& packet,
                               std::uint32_t lane) {
  switch (LeafKind(leaf)) {
    case PrimitiveKind::kTriangle:
      return TrianglesAgainstRay<kQuery>(tree, leaf, packet, lane);
    case PrimitiveKind::kSphere:
      return ScreenedAgainstRay<kQuery, SphereTest>(tree, leaf, packet, lane);
    case PrimitiveKind::kDisk:
      return ScreenedAgainstRay<kQuery, DiskTest>(tree, leaf, packet, lane);
  }
}

}  // namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // SHEAF_SIMD_LEAF_INL_H_
