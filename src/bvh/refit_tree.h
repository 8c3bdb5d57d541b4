// Fits a tree to primitives that have moved: its shape stays, its boxes are made anew.
#ifndef SHEAF_BVH_REFIT_TREE_H_
#define SHEAF_BVH_REFIT_TREE_H_

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "simd/primitives.h"
#include "simd/tree.h"
#include "src/bvh/float4.h"
#include "src/bvh/tree.h"

namespace sheaf::bvh {

inline constexpr std::uint32_t kNodesATask = 256;

// Calls work(first, end, block) for blocks of nodes [0, count), kNodesATask each, in parallel.
template <typename Work>
void ForNodes(std::uint32_t count, const Work& work) {
  oneapi::tbb::parallel_for(0u, (count + kNodesATask - 1) / kNodesATask, [&](std::uint32_t block) {
    const std::uint32_t first = block * kNodesATask;
    work(first, std::min(first + kNodesATask, count), block);
  });
}

inline Box4 ChildBox(const TreeNode& node, std::uint32_t child) {
  Box4 box;
  for (int axis = 0; axis < 3; ++axis) {
    box.lower[axis] = node.bounds[axis][child];
    box.upper[axis] = node.bounds[3 + axis][child];
  }
  return box;
}

inline void StoreChild(const Box4& box, std::uint32_t child, TreeNode& node) {
  for (int axis = 0; axis < 3; ++axis) {
    node.bounds[axis][child] = box.lower[axis];
    node.bounds[3 + axis][child] = box.upper[axis];
  }
}

// Absent children come last.
inline std::uint32_t CountChildren(const TreeNode& node) {
  const auto* const end = std::find(node.child, node.child + kTreeWidth, kNoChild);
  return static_cast<std::uint32_t>(end - node.child);
}

inline Box4 BoxOfNode(const TreeNode& node) {
  Box4 box;
  for (std::uint32_t i = 0; i < CountChildren(node); ++i) box.Include(ChildBox(node, i));
  return box;
}

// Where primitives lie in the arrays of a geometry, by their ids, which are below their number.
class PlacesById {
 public:
  template <typename Real>
  explicit PlacesById(const GeometryView<Real>& geometry);

  // As MakePlace has it.
  std::uint32_t operator[](std::uint32_t id) const {
    return places_.empty() ? MakePlace(only_kind_, id) : places_[id];
  }

 private:
  PrimitiveKind only_kind_ = PrimitiveKind{};
  std::vector<std::uint32_t> places_;  // empty where all are of one kind: in the order of their ids
};

// Whether the tree is over the primitives of the geometry, `hittable` of which a ray can hit.
template <typename Real>
bool IsTreeOver(const GeometryView<Real>& geometry, std::uint32_t hittable,
                const PlacesById& places, const Tree<Real>& tree);

// Writes the primitives into the leaves of a tree over them, and boxes around them. What is not
// moved leaves a tree that BuildTree has just made as it is, to the bit. No coordinate is infinite.
// Runs on the threads of the caller's arena.
template <typename Real>
void RefitTree(const GeometryView<Real>& geometry, const PlacesById& places, Tree<Real>& tree);

// Makes the boxes of inner nodes, and all orders, where the boxes of leaves are right.
void RefitNodes(std::uint32_t count, TreeNode* nodes);

// What a ray through the root's box costs, by the surface area heuristic (Goldsmith and Salmon
// 1987) and the costs of find_split.h; giants, which cost every tree the same, are left out. It
// does not depend on the number of threads. 0 where there is nothing else.
template <typename Real>
double CostOfTree(const Tree<Real>& tree);

}  // namespace sheaf::bvh

#endif  // SHEAF_BVH_REFIT_TREE_H_
