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
#include "simd/streams.h"
#include "simd/tree.h"

HWY_BEFORE_NAMESPACE();
namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE {

// A node's planes are float; lanes of Real hold them exactly.
template <class D>
HWY_INLINE hn::Vec<D> LoadPlanes(D d, const float* planes) {
  if constexpr (sizeof(hn::TFromD<D>) == 4) {
    return hn::Load(d, planes);
  } else {
    return hn::PromoteTo(d, hn::Load(hn::Rebind<float, D>(), planes));
  }
}

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

// Traces the ray of `lane` through the subtree of `start`. Box tests must hold for the ray.
template <Query kQuery, typename Real>
HWY_NOINLINE void TraceRay(const TreeView<Real>& tree, Packet<Real>& packet, std::uint32_t lane,
                           std::uint32_t start) {
  const LeafLanes<Real> d;
  const auto all = [&](const Real(&values)[kPacketSize<Real>])
                       SHEAF_LAMBDA { return hn::Set(d, values[lane]); };
  const auto scale_x = all(packet.scale[0]), scale_y = all(packet.scale[1]),
             scale_z = all(packet.scale[2]);
  const auto enter_x = all(packet.enter[0]), enter_y = all(packet.enter[1]),
             enter_z = all(packet.enter[2]);
  const auto leave_x = all(packet.leave[0]), leave_y = all(packet.leave[1]),
             leave_z = all(packet.leave[2]);
  const auto t_min = all(packet.t_min);
  const auto far_factor = hn::Set(d, Real(kBoxFarFactor));
  // Rows of TreeNode::bounds where the ray enters and leaves boxes.
  const std::uint32_t octant = packet.octant[lane];
  const std::size_t in_x = octant & 1 ? 3 : 0, in_y = octant & 2 ? 4 : 1, in_z = octant & 4 ? 5 : 2;
  const std::size_t out_x = 3 - in_x, out_y = 5 - in_y, out_z = 7 - in_z;

  // Children to visit, the nearest on top. Two arrays: loading an entry whole right after its parts
  // were stored apart would stall (no store forwarding).
  Real stack_enter[kTreeStackSize];
  std::uint32_t stack_child[kTreeStackSize];
  std::size_t size = 0;
  std::uint32_t child = start;
  Real last = packet.t_best[lane] * Real(kBoxFarFactor);
  for (;;) {
    while (!IsLeaf(child)) {
      const TreeNode& node = tree.nodes[child];
      const auto lasts = hn::Set(d, last);
      alignas(kAlignment) Real enters[kTreeWidth];
      std::uint32_t met = 0;
      for (std::uint32_t i = 0; i < kTreeWidth; i += LaneCount(d)) {
        const auto plane = [&](std::size_t row)
                               SHEAF_LAMBDA { return LoadPlanes(d, node.bounds[row] + i); };
        const auto enter = hn::Max(hn::Max(hn::MulAdd(plane(in_x), scale_x, enter_x),
                                           hn::MulAdd(plane(in_y), scale_y, enter_y)),
                                   hn::Max(hn::MulAdd(plane(in_z), scale_z, enter_z), t_min));
        const auto leave = hn::Mul(hn::Min(hn::Min(hn::MulAdd(plane(out_x), scale_x, leave_x),
                                                   hn::MulAdd(plane(out_y), scale_y, leave_y)),
                                           hn::MulAdd(plane(out_z), scale_z, leave_z)),
                                   far_factor);
        hn::Store(enter, d, enters + i);
        met |= MaskBits(d, hn::Le(enter, hn::Min(leave, lasts))) << i;
      }
      if (met == 0) break;
      const int first = std::countr_zero(met);
      child = node.child[first];
      met &= met - 1;
      if (met == 0) continue;
      // Continues with the nearest child and pushes the others.
      Real nearest = enters[first];
      const std::size_t base = size;
      for (; met != 0; met &= met - 1) {
        const int i = std::countr_zero(met);
        Real enter = enters[i];
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
      last = packet.t_best[lane] * Real(kBoxFarFactor);
    }
    do {
      if (size == 0) return;
      --size;
    } while (stack_enter[size] > last);
    child = stack_child[size];
  }
}

template <Query kQuery, typename Real>
HWY_INLINE void TraceRays(const TreeView<Real>& tree, Packet<Real>& packet, std::uint32_t lanes,
                          std::uint32_t start) {
  for (; lanes != 0; lanes &= lanes - 1) {
    TraceRay<kQuery>(tree, packet, static_cast<std::uint32_t>(std::countr_zero(lanes)), start);
  }
}

}  // namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // SHEAF_SIMD_TRACE_RAY_INL_H_
