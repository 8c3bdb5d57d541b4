#include "src/bvh/refit_tree.h"

#include <algorithm>

#include "src/bvh/find_split.h"
#include "src/bvh/float4.h"
#include "src/bvh/node_boxes.h"
#include "src/bvh/primitive_box.h"
#include "src/bvh/refit_nodes.h"

namespace sheaf {
namespace {

using bvh::Box4;
using bvh::PrimitiveBox;

// Ids to positions. Neighbours in a leaf are mostly of one object, the last that was asked for.
std::uint32_t PositionOf(std::uint32_t id, const ObjectIndex& objects, std::size_t& object) {
  const std::vector<std::uint32_t>& first = objects.first;
  if (!(first[object] <= id && id < first[object + 1])) {
    const auto after = std::upper_bound(first.begin(), first.end(), id);
    object = static_cast<std::size_t>(after - first.begin() - 1);
  }
  return objects.index[object] + (id - first[object]);
}

// What lies within leaves: as PrimitiveBoxes has them.
struct Extent {
  Box4 all, others;
  std::size_t object = 0;  // of the last primitive

  void Include(const Extent& extent) {
    all.Include(extent.all);
    others.Include(extent.others);
  }
};

// Writes a leaf's primitives; returns the box around them.
template <typename Real, typename Arrays>
Box4 RefitLeaf(std::uint32_t leaf, const Arrays& arrays, const GeometryView<Real>& geometry,
               const ObjectIndex& objects, PrimitiveBlocks<Real>& blocks, Extent& extent) {
  const std::uint32_t first = LeafFirst(leaf), count = LeafCount(leaf);
  Real* const block = blocks.fields.data() + std::size_t{Arrays::kFieldCount} * first;
  Box4 bounds;
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t index = PositionOf(blocks.id[first + i], objects, extent.object);
    Real* to = block + i;
    Arrays::ForEachField(arrays, [&](const Real* field) {
      *to = field[index];
      to += count;
    });
    PrimitiveBox made;
    bvh::MakeBox(geometry, MakePlace(Arrays::kKind, index), made);
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

// Half the surface, in double, where no extent overflows; 0 of a giant's.
double AreaOf(const Box4& box) {
  double extent[3];
  for (int axis = 0; axis < 3; ++axis) {
    extent[axis] = static_cast<double>(box.upper[axis]) - static_cast<double>(box.lower[axis]);
    if (box.upper[axis] >= kMaxBoxCoordinate) return 0;
  }
  return extent[0] * (extent[1] + extent[2]) + extent[1] * extent[2];
}

}  // namespace

template <typename Real>
double CostOfTree(const TreeView<Real>& tree) {
  Box4 others;
  for (int axis = 0; axis < 3; ++axis) {
    others.lower[axis] = tree.lower[axis];
    others.upper[axis] = tree.upper[axis];
  }
  double cost = 0;
  for (std::uint32_t i = 0; i < tree.node_count; ++i) {
    const TreeNode& node = tree.nodes[i];
    for (std::uint32_t slot = 0; slot < kTreeWidth; ++slot) {
      const std::uint32_t child = node.child[slot];
      if (child == kNoChild) continue;
      const double primitives = IsLeaf(child) ? LeafCount(child) : 0;
      cost += AreaOf(bvh::ChildBox(node, slot)) *
              (double{bvh::kBlockCost} + primitives * double{bvh::kPrimitiveCost});
    }
  }
  const double whole = AreaOf(others);
  return cost > 0 && whole > 0 ? cost / whole : 0;
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
    std::size_t object = 0;
    for (std::uint32_t i = 0; i < block.count && is_same; ++i) {
      is_same = is_there(PositionOf(block.id[i], objects, object));
    }
  });
  return is_same;
}

template <typename Real>
void RefitTree(const GeometryView<Real>& geometry, const ObjectIndex& objects, Tree<Real>& tree) {
  const auto fit_leaf = [&](std::uint32_t leaf, Extent& extent) {
    Box4 box;
    ForEachKind(geometry, [&](const auto& arrays) {
      if (arrays.kKind != LeafKind(leaf)) return;
      box = RefitLeaf(leaf, arrays, geometry, objects, tree.of(arrays.kKind), extent);
    });
    return box;
  };
  Extent whole;
  bvh::RefitNodes(tree.node_count, tree.nodes.data(), fit_leaf, whole);
  tree.SetBounds(whole.all, whole.others);
}

template double CostOfTree(const TreeView<float>&);
template double CostOfTree(const TreeView<double>&);
template bool HasSamePrimitives(const TreeView<float>&, const GeometryView<float>&,
                                const ObjectIndex&);
template bool HasSamePrimitives(const TreeView<double>&, const GeometryView<double>&,
                                const ObjectIndex&);
template void RefitTree(const GeometryView<float>&, const ObjectIndex&, Tree<float>&);
template void RefitTree(const GeometryView<double>&, const ObjectIndex&, Tree<double>&);

}  // namespace sheaf
