// From boxes of leaves to those of all nodes.
#ifndef SHEAF_BVH_REFIT_NODES_H_
#define SHEAF_BVH_REFIT_NODES_H_

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cstdint>
#include <mutex>

#include "simd/tree.h"
#include "src/bvh/node_boxes.h"
#include "src/bvh/order_children.h"

namespace sheaf::bvh {

// Calls work(first, end) for parts of the nodes [0, count), in parallel.
template <typename Work>
void ForNodes(std::uint32_t count, const Work& work) {
  using Nodes = oneapi::tbb::blocked_range<std::uint32_t>;
  oneapi::tbb::parallel_for(Nodes(0, count, 256),
                            [&](const Nodes& range) { work(range.begin(), range.end()); });
}

// Makes the boxes and the orders of all nodes anew. fit_leaf(leaf, part) returns a leaf's box;
// `part` is what it finds out besides, a Part for some of the leaves each, which are joined by
// whole.Include(part). The result does not depend on the number of threads, which are those of the
// caller's arena, where Include does not depend on the order.
template <typename Part, typename FitLeaf>
void RefitNodes(std::uint32_t count, TreeNode* nodes, const FitLeaf& fit_leaf, Part& whole) {
  std::mutex mutex;
  ForNodes(count, [&](std::uint32_t first, std::uint32_t end) {
    Part part;
    for (std::uint32_t i = first; i < end; ++i) {
      for (std::uint32_t slot = 0; slot < kTreeWidth; ++slot) {
        const std::uint32_t child = nodes[i].child[slot];
        if (child == kNoChild || !IsLeaf(child)) continue;
        StoreChild(fit_leaf(child, part), slot, nodes[i]);
      }
    }
    const std::lock_guard<std::mutex> lock(mutex);
    whole.Include(part);
  });
  // Every node comes before its children.
  for (std::uint32_t i = count; i-- > 0;) {
    for (std::uint32_t slot = 0; slot < kTreeWidth; ++slot) {
      const std::uint32_t child = nodes[i].child[slot];
      if (!IsLeaf(child)) StoreChild(BoxOfNode(nodes[child]), slot, nodes[i]);
    }
  }
  ForNodes(count, [&](std::uint32_t first, std::uint32_t end) {
    for (std::uint32_t i = first; i < end; ++i) {
      const auto* const absent =
          std::find(nodes[i].child, nodes[i].child + kTreeWidth, kNoChild);  // they come last
      OrderChildren(nodes[i], static_cast<std::uint32_t>(absent - nodes[i].child));
    }
  });
}

}  // namespace sheaf::bvh

#endif  // SHEAF_BVH_REFIT_NODES_H_
