#include "src/bvh/tree.h"

#include <algorithm>
#include <limits>
#include <vector>

namespace sheaf {
namespace {

template <typename T>
std::size_t Bytes(const AlignedArray<T>& array) {
  return array.size() * sizeof(T);
}

}  // namespace

template <typename Real>
void Tree<Real>::SetBounds(const bvh::Box4& all, const bvh::Box4& others) {
  // An infinite box, the other way round, is that of nothing; box tests take its largest floats for
  // a reach of nothing.
  constexpr float kMax = std::numeric_limits<float>::max();
  for (int axis = 0; axis < 3; ++axis) {
    all_lower[axis] = std::min(all.lower[axis], kMax);
    all_upper[axis] = std::max(all.upper[axis], -kMax);
    lower[axis] = std::min(others.lower[axis], kMax);
    upper[axis] = std::max(others.upper[axis], -kMax);
  }
}

template <typename Real>
TreeView<Real> Tree<Real>::view() const {
  TreeView<Real> view{};
  view.nodes = nodes.data();
  view.node_count = node_count;
  std::transform(std::begin(blocks), std::end(blocks), view.blocks,
                 [](const PrimitiveBlocks<Real>& kind) {
                   return BlockView<Real>{kind.fields.data(), kind.id.data(), kind.count};
                 });
  std::copy_n(lower, 3, view.lower);
  std::copy_n(upper, 3, view.upper);
  view.skips_boxes = node_count <= 1;
  return view;
}

template <typename Real>
std::size_t Tree<Real>::bytes() const {
  std::size_t bytes = Bytes(nodes);
  for (const PrimitiveBlocks<Real>& kind : blocks) bytes += Bytes(kind.fields) + Bytes(kind.id);
  return bytes;
}

std::uint32_t DepthOf(const TreeNode* nodes, std::uint32_t count) {
  std::vector<std::uint8_t> level(count, 1);
  std::uint32_t depth = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    depth = std::max<std::uint32_t>(depth, level[i]);
    for (const std::uint32_t child : nodes[i].child) {
      if (!IsLeaf(child)) level[child] = static_cast<std::uint8_t>(level[i] + 1);
    }
  }
  return depth;
}

template struct Tree<float>;
template struct Tree<double>;

}  // namespace sheaf
