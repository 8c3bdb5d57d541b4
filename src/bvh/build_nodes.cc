#include "src/bvh/build_nodes.h"

#include <oneapi/tbb/task_group.h>

#include <algorithm>
#include <cassert>
#include <limits>

#include "src/bvh/find_split.h"
#include "src/bvh/order_children.h"
#include "src/bvh/partition_range.h"

namespace sheaf::bvh {
namespace {

// Ranges up to this size are built by one task.
constexpr std::uint32_t kSubtreeSize = 1u << 12;
// Nodes from this depth on halve their ranges by count: 2^27 primitives need 13 levels more.
constexpr std::uint32_t kMedianDepth = 12;
static_assert(kMedianDepth + 14 <= kMaxTreeDepth);

struct Child {
  Range range;
  Split split;  // kNone: a leaf
};

struct Children {
  Child child[kTreeWidth];
  std::uint32_t count = 0;
};

bool FitsLeaves(const Range& range) {
  return std::all_of(std::begin(range.counts.of), std::end(range.counts.of),
                     [](std::uint32_t count) { return count <= kMaxLeafSize; });
}

class NodeBuilder {
 public:
  NodeBuilder(PrimitiveBoxes& boxes, std::uint32_t* const (&indices)[kKindCount])
      : boxes_(boxes.boxes.get()),
        all_{0, boxes.counts.total(), {}, boxes.counts, boxes.bounds, boxes.centroids} {
    std::copy(std::begin(indices), std::end(indices), indices_);
  }

  std::unique_ptr<Branch> Build() {
    std::unique_ptr<Branch> root;
    BuildBranch(MakeChild(all_, 1), 1, root);
    group_.wait();
    return root;
  }

 private:
  // Decides what becomes of a range within a node at `depth`.
  Child MakeChild(const Range& range, std::uint32_t depth) const {
    Child child{range, {}};
    if (!FitsLeaves(range)) {
      child.split = depth < kMedianDepth ? FindSplit(boxes_, range) : MedianSplit(range);
    } else if (const std::uint32_t first = range.counts[FirstKind(range)]; first < range.size()) {
      child.split.kind = SplitKind::kByKind;
      child.split.left_count = first;
    } else if (range.size() > kSmallLeaf && !FitsLeaves(all_)) {
      child.split = FindSplit(boxes_, range);
      if (!(child.split.cost < kWorthSplitting * CostOfLeaf(range))) child.split = {};
    }
    return child;
  }

  // The child to split next: what is no leaf before what could be one, then the largest product of
  // area and count; none: -1.
  static int ChooseChild(const Children& children, float scale, std::uint32_t depth) {
    int chosen = -1;
    float best = -1;
    for (std::uint32_t i = 0; i < children.count; ++i) {
      const auto& [range, split] = children.child[i];
      if (split.kind == SplitKind::kNone) continue;
      float key = static_cast<float>(range.size());
      // Areas come to nothing where extents overflow or vanish; counts do not.
      const float area = HalfArea(range.bounds, scale);
      if (depth < kMedianDepth && area >= 0) key *= std::min(area, 3.0f) + 1e-6f;
      const bool must_split = range.size() > kMaxLeafSize || split.kind == SplitKind::kByKind;
      if (must_split) key += 0x1p30f;
      if (key > best) {
        best = key;
        chosen = static_cast<int>(i);
      }
    }
    return chosen;
  }

  Children MakeChildren(const Child& from, std::uint32_t depth) const {
    Children children;
    children.child[children.count++] = from;
    const float scale = UnitScale(from.range.bounds);
    while (children.count < kTreeWidth) {
      const int chosen = ChooseChild(children, scale, depth);
      if (chosen < 0) break;
      // The halves take the place of the whole, so that children keep to the order of the array.
      Child* const at = children.child + chosen;
      const Halves halves = PartitionRange(boxes_, at->range, at->split);
      std::copy_backward(at + 1, children.child + children.count,
                         children.child + children.count + 1);
      at[0] = MakeChild(halves.left, depth);
      at[1] = MakeChild(halves.right, depth);
      ++children.count;
    }
    return children;
  }

  static bool IsInner(const Child& child) {
    return child.range.size() > kMaxLeafSize || child.split.kind == SplitKind::kByKind;
  }

  std::uint32_t EmitLeaf(const Range& range) const {
    PrimitiveBox* const begin = boxes_ + range.begin;
    PrimitiveBox* const end = boxes_ + range.end;
    std::uint32_t tags[kMaxLeafSize];
    std::transform(begin, end, tags, [](const PrimitiveBox& box) { return box.tag; });
    std::sort(tags, tags + range.size());
    const PrimitiveKind kind = FirstKind(range);
    const std::uint32_t first = range.before[kind];
    std::transform(tags, tags + range.size(), indices_[IndexOf(kind)] + first, IndexIn);
    return MakeLeaf(kind, first, range.size());
  }

  // Everything but the children that are nodes.
  TreeNode MakeNode(const Children& children) const {
    constexpr float kMax = std::numeric_limits<float>::max();
    TreeNode node;
    for (std::uint32_t i = 0; i < kTreeWidth; ++i) {
      node.child[i] = kNoChild;
      for (int axis = 0; axis < 3; ++axis) {
        node.bounds[axis][i] = kMax;
        node.bounds[3 + axis][i] = -kMax;
      }
      if (i >= children.count) continue;
      const Child& child = children.child[i];
      for (int axis = 0; axis < 3; ++axis) {
        node.bounds[axis][i] = child.range.bounds.lower[axis];
        node.bounds[3 + axis][i] = child.range.bounds.upper[axis];
      }
      if (!IsInner(child)) node.child[i] = EmitLeaf(child.range);
    }
    OrderChildren(node, children.count);
    return node;
  }

  void BuildSubtree(const Child& from, std::uint32_t depth, std::uint32_t at,
                    std::vector<TreeNode>& nodes) const {
    assert(depth <= kMaxTreeDepth);
    const Children children = MakeChildren(from, depth);
    TreeNode node = MakeNode(children);
    // Siblings lie side by side, then what is below the first, the second ...
    auto next = static_cast<std::uint32_t>(nodes.size());
    for (std::uint32_t i = 0; i < children.count; ++i) {
      if (IsInner(children.child[i])) node.child[i] = next++;
    }
    nodes.resize(next);
    nodes[at] = node;
    for (std::uint32_t i = 0; i < children.count; ++i) {
      if (IsInner(children.child[i])) {
        BuildSubtree(children.child[i], depth + 1, node.child[i], nodes);
      }
    }
  }

  void BuildBranch(const Child& from, std::uint32_t depth, std::unique_ptr<Branch>& to) {
    to = std::make_unique<Branch>();
    Branch& branch = *to;
    if (from.range.size() <= kSubtreeSize) {
      branch.nodes.reserve(from.range.size() / 12 + 2);
      branch.nodes.resize(1);
      BuildSubtree(from, depth, 0, branch.nodes);
      return;
    }
    const Children children = MakeChildren(from, depth);
    branch.nodes.push_back(MakeNode(children));
    for (std::uint32_t i = 0; i < children.count; ++i) {
      if (!IsInner(children.child[i])) continue;
      group_.run([this, child = children.child[i], depth, &below = branch.child[i]] {
        BuildBranch(child, depth + 1, below);
      });
    }
  }

  PrimitiveBox* boxes_;
  std::uint32_t* indices_[kKindCount];
  Range all_;
  oneapi::tbb::task_group group_;
};

}  // namespace

std::unique_ptr<Branch> BuildNodes(PrimitiveBoxes& boxes,
                                   std::uint32_t* const (&indices)[kKindCount]) {
  return NodeBuilder(boxes, indices).Build();
}

}  // namespace sheaf::bvh
