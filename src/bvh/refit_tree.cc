#include "src/bvh/refit_tree.h"

#include <algorithm>
#include <numeric>

#include "src/bvh/find_split.h"
#include "src/bvh/float4.h"
#include "src/bvh/order_children.h"
#include "src/bvh/primitive_box.h"

namespace sheaf::bvh {
namespace {

// Around primitives: of all, and of all but giants.
struct Extents {
  Box4 all, others;

  void Include(const Extents& more) {
    all.Include(more.all);
    others.Include(more.others);
  }
};

// Writes one leaf's primitives; returns its box.
template <typename Real, typename Arrays>
Box4 RefitLeaf(std::uint32_t leaf, const Arrays& arrays, const GeometryView<Real>& geometry,
               const PlacesById& places, PrimitiveBlocks<Real>& blocks, Extents& extents) {
  const std::uint32_t first = LeafFirst(leaf), count = LeafCount(leaf);
  const std::uint32_t* const ids = blocks.id.data() + first;
  Real* const to = blocks.fields.data() + std::size_t{Arrays::kFieldCount} * first;
  Box4 bounds;
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t place = places[ids[i]];
    Real* next = to + i;
    Arrays::ForEachField(arrays, [&](const Real* field) {
      *next = field[IndexIn(place)];
      next += count;
    });
    PrimitiveBox box;
    MakeBox(geometry, place, box);
    extents.all.Include(BoxOf(box));
    if (IsGiant(box)) {
      box = GiantBox(box.tag);
    } else {
      extents.others.Include(BoxOf(box));
    }
    bounds.Include(BoxOf(box));
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
PlacesById::PlacesById(const GeometryView<Real>& geometry) {
  std::uint32_t kinds = 0, total = 0;
  ForEachKind(geometry, [&](const auto& arrays) {
    if (arrays.count > 0) only_kind_ = arrays.kKind;
    kinds += arrays.count > 0;
    total += arrays.count;
  });
  if (kinds <= 1) return;
  places_.resize(total);
  ForEachKind(geometry, [&](const auto& arrays) {
    for (std::uint32_t i = 0; i < arrays.count; ++i) {
      places_[arrays.id[i]] = MakePlace(arrays.kKind, i);
    }
  });
}

template <typename Real>
bool IsTreeOver(const GeometryView<Real>& geometry, std::uint32_t hittable,
                const PlacesById& places, const Tree<Real>& tree) {
  std::uint32_t kinds = 0, total = 0, in_tree = 0;
  bool has_same = true;
  ForEachKind(geometry, [&](const auto& arrays) {
    kinds += arrays.count > 0;
    total += arrays.count;
    in_tree += tree.of(arrays.kKind).count;
    has_same &= tree.of(arrays.kKind).count <= arrays.count;
  });
  if (!has_same || in_tree != hittable) return false;
  if (kinds <= 1 && hittable == total) return true;
  PrimitiveBox box;
  for (std::uint32_t k = 0; k < kKindCount; ++k) {
    const PrimitiveBlocks<Real>& blocks = tree.blocks[k];
    for (std::uint32_t i = 0; i < blocks.count; ++i) {
      const std::uint32_t place = places[blocks.id.data()[i]];
      if (IndexOf(KindOf(place)) != k) return false;
      if (MakeBox(geometry, place, box) != BoxState::kFinite) return false;
    }
  }
  return true;
}

void RefitNodes(std::uint32_t count, TreeNode* nodes) {
  // Every node comes before its children.
  for (std::uint32_t i = count; i-- > 0;) {
    for (std::uint32_t slot = 0; slot < CountChildren(nodes[i]); ++slot) {
      const std::uint32_t child = nodes[i].child[slot];
      if (!IsLeaf(child)) StoreChild(BoxOfNode(nodes[child]), slot, nodes[i]);
    }
  }
  ForNodes(count, [&](std::uint32_t first, std::uint32_t end, std::uint32_t) {
    for (std::uint32_t i = first; i < end; ++i) OrderChildren(nodes[i], CountChildren(nodes[i]));
  });
}

template <typename Real>
void RefitTree(const GeometryView<Real>& geometry, const PlacesById& places, Tree<Real>& tree) {
  TreeNode* const nodes = tree.nodes.data();
  std::vector<Extents> extents((tree.node_count + kNodesATask - 1) / kNodesATask);
  ForNodes(tree.node_count, [&](std::uint32_t first, std::uint32_t end, std::uint32_t block) {
    for (std::uint32_t i = first; i < end; ++i) {
      for (std::uint32_t slot = 0; slot < CountChildren(nodes[i]); ++slot) {
        const std::uint32_t child = nodes[i].child[slot];
        if (!IsLeaf(child)) continue;
        ForEachKind(geometry, [&](const auto& arrays) {
          if (arrays.kKind != LeafKind(child)) return;
          const Box4 box =
              RefitLeaf(child, arrays, geometry, places, tree.of(arrays.kKind), extents[block]);
          StoreChild(box, slot, nodes[i]);
        });
      }
    }
  });
  RefitNodes(tree.node_count, nodes);
  Extents whole;
  for (const Extents& part : extents) whole.Include(part);
  tree.SetBounds(whole.all, whole.others);
}

template <typename Real>
double CostOfTree(const Tree<Real>& tree) {
  const TreeNode* const nodes = tree.nodes.data();
  std::vector<double> costs((tree.node_count + kNodesATask - 1) / kNodesATask);
  ForNodes(tree.node_count, [&](std::uint32_t first, std::uint32_t end, std::uint32_t block) {
    for (std::uint32_t i = first; i < end; ++i) {
      for (std::uint32_t slot = 0; slot < CountChildren(nodes[i]); ++slot) {
        const std::uint32_t child = nodes[i].child[slot];
        const double leaf = static_cast<double>(kPrimitiveCost) * LeafCount(child);
        const double inner = IsLeaf(child) ? leaf : 0;
        costs[block] +=
            AreaOf(ChildBox(nodes[i], slot)) * (static_cast<double>(kBlockCost) + inner);
      }
    }
  });
  Box4 others;
  for (int axis = 0; axis < 3; ++axis) {
    others.lower[axis] = tree.lower[axis];
    others.upper[axis] = tree.upper[axis];
  }
  const double sum = std::accumulate(costs.begin(), costs.end(), 0.0);
  return sum > 0 ? sum / AreaOf(others) : 0;
}

#define SHEAF_INSTANTIATE(Real)                                                         \
  template PlacesById::PlacesById(const GeometryView<Real>&);                           \
  template bool IsTreeOver(const GeometryView<Real>&, std::uint32_t, const PlacesById&, \
                           const Tree<Real>&);                                          \
  template void RefitTree(const GeometryView<Real>&, const PlacesById&, Tree<Real>&);   \
  template double CostOfTree(const Tree<Real>&);
SHEAF_INSTANTIATE(float)
SHEAF_INSTANTIATE(double)
#undef SHEAF_INSTANTIATE

}  // namespace sheaf::bvh
