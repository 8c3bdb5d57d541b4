#include "src/bvh/refit_tree.h"

#include <algorithm>
#include <array>
#include <limits>
#include <mutex>

#include "src/bvh/find_split.h"
#include "src/bvh/float4.h"
#include "src/bvh/order_children.h"
#include "src/bvh/primitive_box.h"
#include "src/core/parallel.h"

namespace sheaf {
namespace {

using bvh::Box4;
using bvh::PrimitiveBox;

// The last levels above the subtrees that are refitted side by side; the nodes in these levels.
constexpr std::uint32_t kTopLevels = 3;
constexpr std::size_t kMaxTops = 1 + 8 + 64, kMaxSubtrees = 512;

// Ids to positions. Neighbours in a leaf are mostly of one object.
class IndexFinder {
 public:
  explicit IndexFinder(const ObjectIndex& objects) : objects_(objects) {}

  std::uint32_t operator()(std::uint32_t id) {
    const std::vector<std::uint32_t>& first = objects_.first;
    if (!(first[object_] <= id && id < first[object_ + 1])) {
      const auto after = std::upper_bound(first.begin(), first.end(), id);
      object_ = static_cast<std::size_t>(after - first.begin() - 1);
    }
    return objects_.index[object_] + (id - first[object_]);
  }

 private:
  const ObjectIndex& objects_;
  std::size_t object_ = 0;
};

// What lies within a tree: as PrimitiveBoxes has them.
struct Extent {
  Box4 all, others;

  void Include(const Extent& extent) {
    all.Include(extent.all);
    others.Include(extent.others);
  }
};

void SetBounds(TreeNode& node, std::uint32_t slot, const Box4& box) {
  for (int axis = 0; axis < 3; ++axis) {
    node.bounds[axis][slot] = box.lower[axis];
    node.bounds[3 + axis][slot] = box.upper[axis];
  }
}

Box4 BoundsOfChildren(const TreeNode& node) {
  Box4 box;
  for (int axis = 0; axis < 3; ++axis) {
    box.lower[axis] = *std::min_element(node.bounds[axis], node.bounds[axis] + kTreeWidth);
    box.upper[axis] = *std::max_element(node.bounds[3 + axis], node.bounds[3 + axis] + kTreeWidth);
  }
  return box;
}

template <typename Real>
class Refitter {
 public:
  Refitter(const GeometryView<Real>& geometry, const ObjectIndex& objects, Tree<Real>& tree)
      : geometry_(geometry), objects_(objects), tree_(tree) {}

  // Recurses as deep as the tree is.
  void RefitBelow(std::uint32_t index, IndexFinder& find, Extent& extent) {
    for (const std::uint32_t child : tree_.nodes[index].child) {
      if (!IsLeaf(child)) RefitBelow(child, find, extent);
    }
    RefitNode(index, find, extent);
  }

  // A node above fitted ones.
  void RefitNode(std::uint32_t index, IndexFinder& find, Extent& extent) {
    TreeNode& node = tree_.nodes[index];
    std::uint32_t count = 0;
    for (std::uint32_t slot = 0; slot < kTreeWidth; ++slot) {
      const std::uint32_t child = node.child[slot];
      if (child == kNoChild) continue;
      ++count;
      SetBounds(
          node, slot,
          IsLeaf(child) ? RefitLeaf(child, find, extent) : BoundsOfChildren(tree_.nodes[child]));
    }
    bvh::OrderChildren(node, count);
  }

  IndexFinder finder() const { return IndexFinder(objects_); }

 private:
  Box4 RefitLeaf(std::uint32_t leaf, IndexFinder& find, Extent& extent) {
    Box4 box;
    ForEachKind(geometry_, [&](const auto& arrays) {
      if (arrays.kKind == LeafKind(leaf)) box = RefitLeafOf(leaf, arrays, find, extent);
    });
    return box;
  }

  template <typename Arrays>
  Box4 RefitLeafOf(std::uint32_t leaf, const Arrays& arrays, IndexFinder& find, Extent& extent) {
    PrimitiveBlocks<Real>& blocks = tree_.of(Arrays::kKind);
    const std::uint32_t first = LeafFirst(leaf), count = LeafCount(leaf);
    Real* const block = blocks.fields.data() + std::size_t{Arrays::kFieldCount} * first;
    Box4 bounds;
    for (std::uint32_t i = 0; i < count; ++i) {
      const std::uint32_t index = find(blocks.id[first + i]);
      Real values[Arrays::kFieldCount];
      Real* next = values;
      Arrays::ForEachField(arrays, [&](const Real* field) { *next++ = field[index]; });
      for (std::uint32_t k = 0; k < Arrays::kFieldCount; ++k) block[k * count + i] = values[k];
      PrimitiveBox made;
      bvh::MakeFiniteBox<Arrays::kKind>(values, 0, made);
      extent.all.Include(bvh::BoxOf(made));
      if (bvh::IsGiant(made)) {
        made = bvh::GiantBox(made.tag);
      } else {
        extent.others.Include(bvh::BoxOf(made));
      }
      bounds.Include(bvh::BoxOf(made));
    }
    return bounds;
  }

  const GeometryView<Real>& geometry_;
  const ObjectIndex& objects_;
  Tree<Real>& tree_;
};

// The nodes of the first levels in the order of the tree, and what hangs below them.
struct Cut {
  std::array<std::uint32_t, kMaxTops> tops;
  std::array<std::uint32_t, kMaxSubtrees> subtrees;
  std::size_t top_count = 0, subtree_count = 0;

  void Add(const TreeNode* nodes, std::uint32_t index, std::uint32_t level) {
    if (level == kTopLevels) {
      subtrees[subtree_count++] = index;
      return;
    }
    tops[top_count++] = index;
    for (const std::uint32_t child : nodes[index].child) {
      if (!IsLeaf(child)) Add(nodes, child, level + 1);
    }
  }
};

template <typename Real>
void StoreExtent(const Extent& extent, Tree<Real>& tree) {
  constexpr float kMax = std::numeric_limits<float>::max();
  for (int axis = 0; axis < 3; ++axis) {
    tree.all_lower[axis] = extent.all.lower[axis];
    tree.all_upper[axis] = extent.all.upper[axis];
    tree.lower[axis] = std::min(extent.others.lower[axis], kMax);
    tree.upper[axis] = std::max(extent.others.upper[axis], -kMax);
  }
}

template <typename Real>
Extent RefitParallel(Refitter<Real>& refitter, const Cut& cut, int threads) {
  std::mutex mutex;
  Extent extent;
  ParallelFor(threads, cut.subtree_count, [&](int, std::uint64_t i) {
    IndexFinder find = refitter.finder();
    Extent part;
    refitter.RefitBelow(cut.subtrees[i], find, part);
    const std::lock_guard<std::mutex> lock(mutex);
    extent.Include(part);
  });
  IndexFinder find = refitter.finder();
  for (std::size_t i = cut.top_count; i-- > 0;) refitter.RefitNode(cut.tops[i], find, extent);
  return extent;
}

double HalfArea(const float (&bounds)[6][kTreeWidth], std::uint32_t slot) {
  double edge[3];
  for (int axis = 0; axis < 3; ++axis) {
    edge[axis] =
        static_cast<double>(bounds[3 + axis][slot]) - static_cast<double>(bounds[axis][slot]);
  }
  return edge[0] * edge[1] + edge[1] * edge[2] + edge[2] * edge[0];
}

}  // namespace

template <typename Real>
double CostOfTree(const TreeView<Real>& tree) {
  if (tree.node_count == 0) return 0;
  TreeNode root{};
  SetBounds(root, 0, BoundsOfChildren(tree.nodes[0]));
  const double whole = HalfArea(root.bounds, 0);
  double cost = 0;
  for (std::uint32_t i = 0; i < tree.node_count; ++i) {
    const TreeNode& node = tree.nodes[i];
    for (std::uint32_t slot = 0; slot < kTreeWidth; ++slot) {
      const std::uint32_t child = node.child[slot];
      if (child == kNoChild) continue;
      const double primitives = IsLeaf(child) ? LeafCount(child) : 0;
      cost += HalfArea(node.bounds, slot) *
              (double{bvh::kBlockCost} + primitives * double{bvh::kPrimitiveCost});
    }
  }
  return whole > 0 ? cost / whole : 0;
}

template <typename Real>
bool HasSamePrimitives(const TreeView<Real>& tree, const GeometryView<Real>& geometry,
                       const ObjectIndex& objects) {
  bool is_same = true;
  ForEachKind(geometry, [&](const auto& arrays) {
    const BlockView<Real>& block = tree.of(arrays.kKind);
    const auto is_there = [&](std::uint32_t index) {
      bool has_nan = false;
      arrays.ForEachField(arrays,
                          [&](const Real* field) { has_nan |= field[index] != field[index]; });
      return !has_nan;
    };
    std::uint32_t there = 0;
    for (std::uint32_t i = 0; i < arrays.count; ++i) there += is_there(i);
    is_same &= there == block.count;
    IndexFinder find(objects);
    for (std::uint32_t i = 0; i < block.count && is_same; ++i) {
      is_same = is_there(find(block.id[i]));
    }
  });
  return is_same;
}

template <typename Real>
void RefitTree(const GeometryView<Real>& geometry, const ObjectIndex& objects, int threads,
               Tree<Real>& tree) noexcept {
  if (tree.node_count == 0) return;
  Refitter<Real> refitter(geometry, objects, tree);
  Cut cut;
  cut.Add(tree.nodes.data(), 0, 0);
  Extent extent;
  try {
    extent = RefitParallel(refitter, cut, threads);
  } catch (...) {
    // There is no memory for a loop's tasks. Half a tree is of no use, and one thread needs none.
    extent = Extent();
    IndexFinder find = refitter.finder();
    refitter.RefitBelow(0, find, extent);
  }
  StoreExtent(extent, tree);
}

template double CostOfTree(const TreeView<float>&);
template double CostOfTree(const TreeView<double>&);
template bool HasSamePrimitives(const TreeView<float>&, const GeometryView<float>&,
                                const ObjectIndex&);
template bool HasSamePrimitives(const TreeView<double>&, const GeometryView<double>&,
                                const ObjectIndex&);
template void RefitTree(const GeometryView<float>&, const ObjectIndex&, int, Tree<float>&) noexcept;
template void RefitTree(const GeometryView<double>&, const ObjectIndex&, int,
                        Tree<double>&) noexcept;

}  // namespace sheaf
