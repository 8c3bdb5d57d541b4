// Traces single rays through the tree or a subtree, with a node's eight children or a leaf's
// primitives in a vector. For rays whose packet has become too incoherent.
#if defined(SHEAF_SIMD_TRACE_RAY_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SHEAF_SIMD_TRACE_RAY_INL_H_
#undef SHEAF_SIMD_TRACE_RAY_INL_H_
#else
#define SHEAF_SIMD_TRACE_RAY_INL_H_
#endif

#include "hwy/cache_control.h"
#include "simd/leaf-inl.h"
#include "simd/query.h"
#include "simd/slabs-inl.h"
#include "simd/streams.h"
#include "simd/tree.h"

HWY_BEFORE_NAMESPACE();
namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE {

// Prefetches a child: all of a node, or most of a leaf.
template <typename Real>
HWY_INLINE void FetchAhead(const TreeView<Real>& tree, std::uint32_t child) {
  constexpr std::size_t kLine = 64;
  const void* start;
  if (IsLeaf(child)) {
    start = BlockOf(tree, child);
  } else {
    start = &tree.nodes[child];
  }
  const char* from = static_cast<const char*>(start);
  for (std::size_t line = 0; line < sizeof(TreeNode) / kLine; ++line) {
    hwy::Prefetch(from + line * kLine);
  }
}

// Traces the ray of `lane` through the subtree of `start`. Box tests by `Slabs` must hold for it.
template <Query kQuery, class Slabs, typename Real>
HWY_NOINLINE void TraceRay(const TreeView<Real>& tree, Packet<Real>& packet, std::uint32_t lane,
                           std::uint32_t start) {
  using Distance = typename Slabs::Distance;
  const Slabs slabs(tree, packet, lane);
  // Children to visit, the nearest on top. Two arrays: loading an entry whole right after its parts
  // were stored apart would stall (no store forwarding).
  Distance stack_enter[kTreeStackSize];
  std::uint32_t stack_child[kTreeStackSize];
  std::size_t size = 0;
  std::uint32_t child = start;
  Distance last = Slabs::LastOf(packet.t_best[lane]);
  for (;;) {
    while (!IsLeaf(child)) {
      const TreeNode& node = tree.nodes[child];
      alignas(kAlignment) Distance enters[kTreeWidth];
      std::uint32_t met = 0;
      for (std::uint32_t i = 0; i < kTreeWidth; i += LaneCount(typename Slabs::D())) {
        met |= slabs.Meet(node, i, last, enters) << i;
      }
      if (met == 0) break;
      const int first = std::countr_zero(met);
      child = node.child[first];
      met &= met - 1;
      if (met == 0) continue;
      // Continues with the nearest child and pushes the others.
      Distance nearest = enters[first];
      const std::size_t base = size;
      for (; met != 0; met &= met - 1) {
        const int i = std::countr_zero(met);
        Distance enter = enters[i];
        std::uint32_t other = node.child[i];
        if (enter < nearest) {
          std::swap(enter, nearest);
          std::swap(other, child);
        }
        std::size_t at = size++;
        for (; at != base && stack_enter[at - 1] < enter; --at) {
          stack_enter[at] = stack_enter[at - 1];
          stack_child[at] = stack_child[at - 1];
        }
        stack_enter[at] = enter;
        stack_child[at] = other;
        FetchAhead(tree, other);
      }
    }
    if (IsLeaf(child)) {
      LeafAgainstRay<kQuery>(tree, child, packet, lane);
      if (kQuery == Query::kOccluded && packet.t_best[lane] == kDone<Real>) return;
      last = Slabs::LastOf(packet.t_best[lane]);
    }
    do {
      if (size == 0) return;
      --size;
    } while (stack_enter[size] > last);
    child = stack_child[size];
  }
}

// The same for the rays of `lanes` (bits).
template <Query kQuery, class Slabs, typename Real>
HWY_INLINE void TraceRays(const TreeView<Real>& tree, Packet<Real>& packet, std::uint32_t lanes,
                          std::uint32_t start) {
  for (; lanes != 0; lanes &= lanes - 1) {
    TraceRay<kQuery, Slabs>(tree, packet, static_cast<std::uint32_t>(std::countr_zero(lanes)),
                            start);
  }
}

}  // namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // SHEAF_SIMD_TRACE_RAY_INL_H_
