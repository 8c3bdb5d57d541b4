// Where in a tree each primitive lies, by its id: for those that ask what was hit.
#ifndef SHEAF_BVH_PRIMITIVE_INDEX_H_
#define SHEAF_BVH_PRIMITIVE_INDEX_H_

#include <cstdint>
#include <mutex>
#include <vector>

#include "simd/tree.h"

namespace sheaf {

// Made at its first use, because rays alone do not need it.
template <typename Real>
class PrimitiveIndex {
 public:
  // Makes it, once, for ids below `primitives`; any number of threads may call. Where memory runs
  // out std::bad_alloc is thrown, and the next call tries again.
  void Ensure(const TreeView<Real>& tree, std::uint32_t primitives) const {
    std::call_once(once_, [&] { Make(tree, primitives); });
  }

  // The leaf that a primitive is in; kNoChild where it is in none.
  std::uint32_t leaf(std::uint32_t id) const { return id < leaf_.size() ? leaf_[id] : kNoChild; }
  // Its place among the primitives of that leaf.
  std::uint32_t lane(std::uint32_t id) const { return lane_[id]; }

 private:
  void Make(const TreeView<Real>& tree, std::uint32_t primitives) const {
    std::vector<std::uint32_t> leaves(primitives, kNoChild);
    std::vector<std::uint8_t> lanes(primitives, 0);
    for (std::uint32_t i = 0; i < tree.node_count; ++i) {
      for (const std::uint32_t child : tree.nodes[i].child) {
        if (!IsLeaf(child) || child == kNoChild) continue;
        const std::uint32_t* const ids = tree.of(LeafKind(child)).id + LeafFirst(child);
        for (std::uint32_t lane = 0; lane < LeafCount(child); ++lane) {
          leaves[ids[lane]] = child;
          lanes[ids[lane]] = static_cast<std::uint8_t>(lane);
        }
      }
    }
    leaf_.swap(leaves);
    lane_.swap(lanes);
  }

  mutable std::once_flag once_;
  mutable std::vector<std::uint32_t> leaf_;
  mutable std::vector<std::uint8_t> lane_;
};

}  // namespace sheaf

#endif  // SHEAF_BVH_PRIMITIVE_INDEX_H_
