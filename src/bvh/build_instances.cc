#include "src/bvh/build_instances.h"

#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "src/bvh/build_nodes.h"
#include "src/bvh/flatten_tree.h"
#include "src/bvh/order_children.h"
#include "src/bvh/primitive_box.h"
#include "src/bvh/round_outward.h"
#include "src/core/parallel.h"
#include "src/scene/affine_map.h"

namespace sheaf {
namespace {

using bvh::BoxState;
using bvh::PrimitiveBox;
using bvh::PrimitiveBoxes;

constexpr float kMax = std::numeric_limits<float>::max();

struct Bounds {
  double lower[3] = {kMax, kMax, kMax}, upper[3] = {-kMax, -kMax, -kMax};
};

// Grows `bounds` by what a child's box becomes.
void IncludeMapped(const AffineMap& map, const TreeNode& node, std::uint32_t child,
                   Bounds& bounds) {
  for (int k = 0; k < 3; ++k) {
    double low = map.row[k][3], high = low, terms = std::abs(low);
    for (int axis = 0; axis < 3; ++axis) {
      const double a = map.row[k][axis] * static_cast<double>(node.bounds[axis][child]);
      const double b = map.row[k][axis] * static_cast<double>(node.bounds[axis + 3][child]);
      low += std::min(a, b);
      high += std::max(a, b);
      // A ray's way into the object is rounded there to parts of the object's coordinates.
      terms += std::max(std::abs(a), std::abs(b));
    }
    bounds.lower[k] = std::min(bounds.lower[k], low - kInstanceSlack * terms);
    bounds.upper[k] = std::max(bounds.upper[k], high + kInstanceSlack * terms);
  }
}

// The box of an instance; kNever where its object is empty. The boxes of the root's children are
// tighter around what is turned than one box around all.
template <typename Real>
BoxState MakeInstanceBox(const AffineMap& to_world, const TreeView<Real>& tree,
                         std::uint32_t instance, PrimitiveBox& box) {
  if (tree.node_count == 0) return BoxState::kNever;
  Bounds bounds;
  for (std::uint32_t child = 0; child < kTreeWidth; ++child) {
    if (tree.nodes[0].child[child] == kNoChild) continue;
    IncludeMapped(to_world, tree.nodes[0], child, bounds);
  }
  for (int k = 0; k < 3; ++k) {
    // What is beyond the range of float is a giant.
    const double high = static_cast<double>(kMax);
    box.lower[k] = bvh::RoundDown(std::clamp(bounds.lower[k], -high, high)) + 0.0f;
    box.upper[k] = bvh::RoundUp(std::clamp(bounds.upper[k], -high, high)) + 0.0f;
  }
  box.tag = bvh::MakeTag(PrimitiveKind{}, instance);
  box.unused = 0;
  return BoxState::kFinite;
}

// A node whose children are the instances of a leaf, one each.
TreeNode SplitLeaf(std::uint32_t leaf, const std::uint32_t* instances,
                   const std::vector<PrimitiveBox>& boxes) {
  TreeNode node{};
  const std::uint32_t count = LeafCount(leaf);
  for (std::uint32_t i = 0; i < kTreeWidth; ++i) {
    const bool is_there = i < count;
    const std::uint32_t instance = is_there ? instances[LeafFirst(leaf) + i] : 0;
    node.child[i] = is_there ? MakeLeaf(PrimitiveKind{}, instance, 1) : kNoChild;
    for (int k = 0; k < 3; ++k) {
      node.bounds[k][i] = is_there ? boxes[instance].lower[k] : kMax;
      node.bounds[k + 3][i] = is_there ? boxes[instance].upper[k] : -kMax;
    }
  }
  bvh::OrderChildren(node, count);
  return node;
}

// Turns leaves of positions into leaves of single instances.
void SplitLeaves(const std::vector<std::uint32_t>& instances,
                 const std::vector<PrimitiveBox>& boxes, const AlignedArray<TreeNode>& nodes,
                 std::uint32_t node_count, AlignedArray<TreeNode>& split, std::uint32_t& count) {
  std::vector<TreeNode> more;
  std::vector<TreeNode> first(nodes.data(), nodes.data() + node_count);
  for (TreeNode& node : first) {
    for (std::uint32_t& child : node.child) {
      if (!IsLeaf(child) || child == kNoChild) continue;
      if (LeafCount(child) == 1) {
        child = MakeLeaf(PrimitiveKind{}, instances[LeafFirst(child)], 1);
      } else {
        more.push_back(SplitLeaf(child, instances.data(), boxes));
        child = node_count + static_cast<std::uint32_t>(more.size()) - 1;
      }
    }
  }
  count = node_count + static_cast<std::uint32_t>(more.size());
  split.Allocate(count);
  std::copy(first.begin(), first.end(), split.data());
  std::copy(more.begin(), more.end(), split.data() + node_count);
}

template <typename Real>
void BuildForest(std::span<const PlacedObject> places, InstanceForest<Real>& forest) {
  const auto make = [&](std::uint32_t i, PrimitiveBox& box) {
    return MakeInstanceBox(places[i].to_world, forest.trees[places[i].object], i, box);
  };
  PrimitiveBoxes boxes = bvh::MakeBoxes(static_cast<std::uint32_t>(places.size()), make);
  const std::uint32_t count = boxes.counts.total();
  for (int axis = 0; axis < 3; ++axis) {
    forest.all_lower[axis] = count == 0 ? kMax : boxes.all.lower[axis];
    forest.all_upper[axis] = count == 0 ? -kMax : boxes.all.upper[axis];
    forest.lower[axis] = std::min(boxes.others.lower[axis], kMax);
    forest.upper[axis] = std::max(boxes.others.upper[axis], -kMax);
  }
  if (count == 0) return;
  std::vector<PrimitiveBox> by_instance(places.size());
  for (std::uint32_t i = 0; i < count; ++i) {
    const PrimitiveBox& box = boxes.boxes[i];
    by_instance[IndexIn(box.tag - bvh::kTagBase)] = box;
  }
  std::vector<std::uint32_t> instances(count + kMaxLanes);
  std::uint32_t* indices[kKindCount] = {};
  indices[IndexOf(PrimitiveKind{})] = instances.data();
  AlignedArray<TreeNode> nodes;
  const std::uint32_t node_count = bvh::FlattenNodes(bvh::BuildNodes(boxes, indices), nodes);
  SplitLeaves(instances, by_instance, nodes, node_count, forest.nodes, forest.node_count);
}

}  // namespace

template <typename Real>
InstanceTree<Real> InstanceForest<Real>::view() const {
  InstanceTree<Real> view{};
  view.nodes = nodes.data();
  view.node_count = node_count;
  std::copy_n(lower, 3, view.lower);
  std::copy_n(upper, 3, view.upper);
  view.condition = condition;
  view.count = static_cast<std::uint32_t>(object.size());
  view.to_object = to_object.data();
  view.object = object.data();
  view.trees = trees.data();
  return view;
}

template <typename Real>
std::size_t InstanceForest<Real>::bytes() const {
  return nodes.bytes() + to_object.capacity() * sizeof(AffineMap) +
         object.capacity() * sizeof(std::uint32_t) + trees.capacity() * sizeof(TreeView<Real>);
}

template <typename Real>
InstanceForest<Real> BuildInstances(std::span<const PlacedObject> places,
                                    std::vector<TreeView<Real>> trees, int threads) {
  InstanceForest<Real> forest;
  forest.trees = std::move(trees);
  forest.to_object.reserve(places.size());
  forest.object.reserve(places.size());
  double condition = 1;
  for (const PlacedObject& place : places) {
    forest.to_object.push_back(InverseOf(place.to_world));
    forest.object.push_back(place.object);
    condition = std::max(condition, ConditionOf(place.to_world, forest.to_object.back()));
  }
  forest.condition = bvh::RoundUp(condition);
  oneapi::tbb::task_arena arena(ThreadCount(threads));
  arena.execute([&] { BuildForest(places, forest); });
  return forest;
}

template struct InstanceForest<float>;
template struct InstanceForest<double>;
template InstanceForest<float> BuildInstances(std::span<const PlacedObject>,
                                              std::vector<TreeView<float>>, int);
template InstanceForest<double> BuildInstances(std::span<const PlacedObject>,
                                               std::vector<TreeView<double>>, int);

}  // namespace sheaf
