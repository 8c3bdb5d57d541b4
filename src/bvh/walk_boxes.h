// Walks of the tree by the boxes of its nodes, in double: for queries that are no rays.
#ifndef SHEAF_BVH_WALK_BOXES_H_
#define SHEAF_BVH_WALK_BOXES_H_

#include <algorithm>
#include <cstdint>
#include <utility>

#include "simd/tree.h"
#include "src/core/vec3.h"

namespace sheaf {

// Squares of the distances of a point to the boxes of a node's children, less what rounding may add
// to the distance of what is in them: boxes are larger than that by kBoxGrowth already where they
// are large.
struct ChildDistances {
  double square[kTreeWidth];

  ChildDistances(const TreeNode& node, Vec3<double> point) {
    constexpr double kSlack = 1 - 0x1p-40;
    for (std::uint32_t i = 0; i < kTreeWidth; ++i) {
      double sum = 0;
      for (int axis = 0; axis < 3; ++axis) {
        const double below = static_cast<double>(node.bounds[axis][i]) - point[axis];
        const double above = point[axis] - static_cast<double>(node.bounds[3 + axis][i]);
        const double gap = std::max(std::max(below, above), 0.0);
        sum += gap * gap;
      }
      square[i] = sum * kSlack;
    }
  }
};

// Calls test(leaf) for the leaves whose boxes are within a distance of a point, the nearest first,
// as far as `limit()` reaches, the square of that distance as it is by then.
template <typename Limit, typename Test>
void WalkNearest(const TreeNode* nodes, std::uint32_t node_count, Vec3<double> point, Limit limit,
                 Test test) {
  if (node_count == 0) return;
  struct Entry {
    double square;
    std::uint32_t child;
  };
  Entry stack[kTreeStackSize];
  std::uint32_t size = 0;
  stack[size++] = {0, 0};
  while (size > 0) {
    const Entry entry = stack[--size];
    if (!(entry.square <= limit())) continue;
    if (IsLeaf(entry.child)) {
      test(entry.child);
      continue;
    }
    const TreeNode& node = nodes[entry.child];
    const ChildDistances distances(node, point);
    const std::uint32_t base = size;
    for (std::uint32_t i = 0; i < kTreeWidth; ++i) {
      const double square = distances.square[i];
      if (node.child[i] == kNoChild || !(square <= limit())) continue;
      std::uint32_t at = size++;
      for (; at > base && stack[at - 1].square < square; --at) stack[at] = stack[at - 1];
      stack[at] = {square, node.child[i]};
    }
  }
}

// Calls test(leaf) for the leaves whose boxes meet the box [lower, upper].
template <typename Test>
void WalkOverlapping(const TreeNode* nodes, std::uint32_t node_count, Vec3<double> lower,
                     Vec3<double> upper, Test test) {
  if (node_count == 0) return;
  std::uint32_t stack[kTreeStackSize];
  std::uint32_t size = 0;
  stack[size++] = 0;
  while (size > 0) {
    const TreeNode& node = nodes[stack[--size]];
    for (std::uint32_t i = 0; i < kTreeWidth; ++i) {
      bool meets = node.child[i] != kNoChild;
      for (int axis = 0; axis < 3; ++axis) {
        meets &= static_cast<double>(node.bounds[axis][i]) <= upper[axis] &&
                 static_cast<double>(node.bounds[3 + axis][i]) >= lower[axis];
      }
      if (!meets) continue;
      if (IsLeaf(node.child[i])) {
        test(node.child[i]);
      } else {
        stack[size++] = node.child[i];
      }
    }
  }
}

}  // namespace sheaf

#endif  // SHEAF_BVH_WALK_BOXES_H_
