// A batch of rays against a tree: which way its packets go.
#if defined(SHEAF_SIMD_TRACE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SHEAF_SIMD_TRACE_INL_H_
#undef SHEAF_SIMD_TRACE_INL_H_
#else
#define SHEAF_SIMD_TRACE_INL_H_
#endif

#include "simd/trace_sheet-inl.h"

HWY_BEFORE_NAMESPACE();
namespace sheaf::simd::HWY_NAMESPACE {

// Calls finish(packet, i) for every packet of the batch once its rays are traced; i is the position
// of its first ray.
template <Query kQuery, typename Real, class Finish>
HWY_INLINE void TraceBatch(const TreeView<Real>& tree, const RayView<Real>& rays,
                           const RayIntervals<Real>& intervals, std::uint32_t count,
                           Coherence coherence, Finish finish) {
  const std::uint32_t lanes = LaneCount(Lanes<Real>());
  Tile<Real> tile;
  // A tree of one node holds so few primitives that its boxes do not pay.
  const bool is_flat = tree.node_count <= 1;
  for (std::uint32_t begin = 0; begin < count; begin += lanes * lanes) {
    tile.count = 0;
    for (std::uint32_t i = begin; i < count && tile.count < lanes; i += lanes) {
      Packet<Real>& packet = tile.packets[tile.count++];
      LoadPacket(rays, intervals, i, count, packet);
      PrepareLeafTerms(tree, packet);
    }
    if (is_flat) {
      for (std::uint32_t k = 0; k < tile.count; ++k) {
        TraceEveryLeaf<kQuery>(tree, tile.packets[k], OpenLanes(tile.packets[k]));
      }
    } else if (coherence != Coherence::kIncoherent && PrepareTile(tree, tile)) {
      TraceTile<kQuery>(tree, tile);
    } else if (coherence != Coherence::kIncoherent && PrepareSheet(tree, tile)) {
      TraceSheet<kQuery>(tree, tile);
    } else {
      for (std::uint32_t k = 0; k < tile.count; ++k) {
        Packet<Real>& packet = tile.packets[k];
        PrepareBoxes(tree, packet);
        TraceEveryLeaf<kQuery>(tree, packet, packet.without_boxes);
        const std::uint32_t open = OpenLanes(packet) & ~packet.without_boxes;
        if (coherence == Coherence::kIncoherent) {
          TraceRays<kQuery>(tree, packet, open, 0);
        } else {
          TracePacket<kQuery>(tree, packet, open, 0);
        }
      }
    }
    for (std::uint32_t k = 0; k < tile.count; ++k) finish(tile.packets[k], begin + k * lanes);
  }
}

}  // namespace sheaf::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // SHEAF_SIMD_TRACE_INL_H_
