#include "src/bvh/flatten_tree.h"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "simd/tree.h"

namespace sheaf::bvh {
namespace {

struct Placed {
  std::unique_ptr<Branch> branch;
  std::uint32_t first;  // node
};

// Recurses as deep as branches do, at most kMaxTreeDepth.
void Place(std::unique_ptr<Branch> branch, std::uint32_t& next, std::vector<Placed>& placed) {
  const std::size_t self = placed.size();
  Branch& here = *branch;
  placed.push_back({std::move(branch), next});
  next += static_cast<std::uint32_t>(here.nodes.size());
  const std::uint32_t offset = placed[self].first;
  for (TreeNode& node : here.nodes) {
    for (std::uint32_t& child : node.child) {
      if (!IsLeaf(child)) child += offset;
    }
  }
  for (std::uint32_t i = 0; i < kTreeWidth; ++i) {
    if (!here.child[i]) continue;
    here.nodes[0].child[i] = next;
    Place(std::move(here.child[i]), next, placed);
  }
}

// One leaf of the primitives of one kind.
template <typename Real, typename Arrays>
void WriteLeaf(std::uint32_t leaf, const Arrays& arrays, PrimitiveBlocks<Real>& blocks) {
  const std::uint32_t first = LeafFirst(leaf), count = LeafCount(leaf);
  std::uint32_t* const id = blocks.id.data() + first;
  Real* to = blocks.fields.data() + std::size_t{Arrays::kFieldCount} * first;
  Arrays::ForEachField(arrays, [&](const Real* field) {
    for (std::uint32_t i = 0; i < count; ++i) *to++ = field[id[i]];
  });
  for (std::uint32_t i = 0; i < count; ++i) id[i] = arrays.id[id[i]];
}

}  // namespace

std::uint32_t FlattenNodes(std::unique_ptr<Branch> root, AlignedArray<TreeNode>& nodes) {
  std::vector<Placed> placed;
  std::uint32_t count = 0;
  Place(std::move(root), count, placed);
  nodes.Allocate(count);
  oneapi::tbb::parallel_for(std::size_t{0}, placed.size(), [&](std::size_t i) {
    auto& [branch, first] = placed[i];
    std::copy(branch->nodes.begin(), branch->nodes.end(), nodes.data() + first);
    branch.reset();
  });
  return count;
}

template <typename Real>
void WriteLeaves(const GeometryView<Real>& geometry, Tree<Real>& tree) {
  using oneapi::tbb::blocked_range;
  const auto write = [&](std::uint32_t child) {
    if (child == kNoChild) return;
    ForEachKind(geometry, [&](const auto& arrays) {
      if (arrays.kKind == LeafKind(child)) WriteLeaf(child, arrays, tree.of(arrays.kKind));
    });
  };
  oneapi::tbb::parallel_for(blocked_range<std::uint32_t>(0, tree.node_count, 256),
                            [&](const blocked_range<std::uint32_t>& range) {
                              for (std::uint32_t i = range.begin(); i != range.end(); ++i) {
                                for (const std::uint32_t child : tree.nodes[i].child) {
                                  if (IsLeaf(child)) write(child);
                                }
                              }
                            });
}

template void WriteLeaves(const GeometryView<float>&, Tree<float>&);
template void WriteLeaves(const GeometryView<double>&, Tree<double>&);

}  // namespace sheaf::bvh
