#include "src/bvh/order_children.h"

#include <limits>

namespace sheaf::bvh {

void OrderChildren(TreeNode& node, std::uint32_t count) {
  constexpr float kMax = std::numeric_limits<float>::max();
  float center[3][kTreeWidth];
  for (int axis = 0; axis < 3; ++axis) {
    for (std::uint32_t i = 0; i < kTreeWidth; ++i) {
      // An eighth of the sum, so that the sum of three of them is finite.
      center[axis][i] = node.bounds[axis][i] * 0.125f + node.bounds[3 + axis][i] * 0.125f;
    }
  }
  for (std::uint32_t octant = 0; octant < 8; ++octant) {
    const float x = octant & 1 ? -1.0f : 1.0f;
    const float y = octant & 2 ? -1.0f : 1.0f;
    const float z = octant & 4 ? -1.0f : 1.0f;
    float key[kTreeWidth];
    for (std::uint32_t i = 0; i < kTreeWidth; ++i) {
      const float along = x * center[0][i] + y * center[1][i] + z * center[2][i];
      key[i] = i < count ? along : kMax;
    }
    // A child's rank is how many come before it.
    std::uint32_t rank[kTreeWidth] = {};
    for (std::uint32_t j = 0; j < kTreeWidth; ++j) {
      for (std::uint32_t i = 0; i < kTreeWidth; ++i) {
        rank[i] +=
            static_cast<std::uint32_t>(key[j] < key[i]) |
            (static_cast<std::uint32_t>(key[j] == key[i]) & static_cast<std::uint32_t>(j < i));
      }
    }
    node.order[octant] = 0;
    for (std::uint32_t i = 0; i < kTreeWidth; ++i) node.order[octant] |= i << (4 * rank[i]);
  }
}

}  // namespace sheaf::bvh
