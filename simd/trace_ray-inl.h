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

// Takes the ray of `lane` through the subtree of `start`, the nearest child first. Box tests by
// `Slabs` must hold for it. `leaves` tests primitives and knows where the ray ends:
//   bool Test(leaf): returns whether the ray is done.
//   Real end().
template <class Slabs, typename Real, class Leaves>
HWY_INLINE void WalkRay(const TreeView<Real>& tree, const Packet<Real>& packet, std::uint32_t lane,
                        std::uint32_t start, Leaves leaves) {
  using Distance = typename Slabs::Distance;
  const Slabs slabs(tree, packet, lane);
  // Children to visit, the nearest on top. Two arrays: loading an entry whole right after its parts
  // were stored apart would stall (no store forwarding).
  Distance stack_enter[kTreeStackSize];
  std::uint32_t stack_child[kTreeStackSize];
  std::size_t size = 0;
  std::uint32_t child = start;
  Distance last = Slabs::LastOf(leaves.end());
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
      if (leaves.Test(child)) return;
      last = Slabs::LastOf(leaves.end());
    }
    do {
      if (size == 0) return;
      --size;
    } while (stack_enter[size] > last);
    child = stack_child[size];
  }
}

// What a lane keeps of the leaves on its ray's way.
template <Query kQuery, typename Real>
struct LaneLeaves {
  const TreeView<Real>& tree;
  Packet<Real>& packet;
  std::uint32_t lane;

  HWY_INLINE bool Test(std::uint32_t leaf) const {
    LeafAgainstRay<kQuery>(tree, leaf, packet, lane);
    return kQuery == Query::kOccluded && packet.t_best[lane] == kDone<Real>;
  }
  HWY_INLINE Real end() const { return packet.t_best[lane]; }
};

// Traces the ray of `lane` through the subtree of `start`. Box tests by `Slabs` must hold for it.
template <Query kQuery, class Slabs, typename Real>
HWY_NOINLINE void TraceRay(const TreeView<Real>& tree, Packet<Real>& packet, std::uint32_t lane,
                           std::uint32_t start) {
  WalkRay<Slabs>(tree, packet, lane, start, LaneLeaves<kQuery, Real>{tree, packet, lane});
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
