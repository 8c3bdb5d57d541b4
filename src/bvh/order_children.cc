#include "src/bvh/order_children.h"

#include <limits>

#include "src/bvh/float4.h"

namespace sheaf::bvh {
namespace {

// By octant.
struct Octants {
  Float4 keys[2];
};

}  // namespace

void OrderChildren(TreeNode& node, std::uint32_t count) {
  constexpr float kMax = std::numeric_limits<float>::max();
  constexpr Float4 kX = {1, -1, 1, -1}, kY = {1, 1, -1, -1};
  static_assert(kTreeWidth == 8);
  Float4 center[3][2];
  for (int axis = 0; axis < 3; ++axis) {
    for (int half = 0; half < 2; ++half) {
      // An eighth of the sum, so that the sum of three of them is finite.
      center[axis][half] = Load4(&node.bounds[axis][4 * half]) * 0.125f +
                           Load4(&node.bounds[3 + axis][4 * half]) * 0.125f;
    }
  }
  Octants child[kTreeWidth];
  for (std::uint32_t i = 0; i < kTreeWidth; ++i) {
    const auto along = [&](int axis) { return center[axis][i / 4][i % 4]; };
    const Float4 across = kX * along(0) + kY * along(1);
    child[i].keys[0] = i < count ? across + Set4(along(2)) : Set4(kMax);
    child[i].keys[1] = i < count ? across - Set4(along(2)) : Set4(kMax);
  }
  for (int half = 0; half < 2; ++half) {
    // A child's rank is how many come before it.
    Int4 rank[kTreeWidth];
    for (std::int32_t i = 0; i < static_cast<std::int32_t>(kTreeWidth); ++i) {
      rank[i] = Int4{i, i, i, i};
      for (std::int32_t j = 0; j < i; ++j) {
        // -1 where the later one comes first, though it stands behind.
        const Int4 swaps = child[i].keys[half] < child[j].keys[half];
        rank[i] += swaps;
        rank[j] -= swaps;
      }
    }
    for (int octant = 0; octant < 4; ++octant) {
      std::uint32_t order = 0;
      for (std::uint32_t i = 0; i < kTreeWidth; ++i) order |= i << (4 * rank[i][octant]);
      node.order[4 * half + octant] = order;
    }
  }
}

}  // namespace sheaf::bvh
