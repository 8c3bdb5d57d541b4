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

// One leaf of `fields` numbers a primitive, whose field k of primitive i is field(k)[i].
template <typename Real, typename Field>
void WriteLeaf(std::uint32_t leaf, int fields, const Field& field, const std::uint32_t* ids,
               Real* blocks, std::uint32_t* id) {
  const std::uint32_t first = LeafFirst(leaf), count = LeafCount(leaf);
  Real* to = blocks + std::size_t{first} * static_cast<std::size_t>(fields);
  for (int k = 0; k < fields; ++k) {
    const Real* const from = field(k);
    for (std::uint32_t i = 0; i < count; ++i) *to++ = from[id[first + i]];
  }
  for (std::uint32_t i = first; i < first + count; ++i) id[i] = ids[id[i]];
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
  const SphereArrays<Real>& spheres = geometry.spheres;  // clang 14 captures no structured binding
  const TriangleArrays<Real>& triangles = geometry.triangles;
  const Real* const sphere_fields[4] = {spheres.center_x, spheres.center_y, spheres.center_z,
                                        spheres.radius};
  const auto write = [&](std::uint32_t child) {
    if (child == kNoChild) return;
    if (IsTriangleLeaf(child)) {
      WriteLeaf(
          child, 9, [&](int k) { return triangles.vertex[k / 3][k % 3]; }, triangles.id,
          tree.triangles.data(), tree.triangle_id.data());
    } else {
      WriteLeaf(
          child, 4, [&](int k) { return sphere_fields[k]; }, spheres.id, tree.spheres.data(),
          tree.sphere_id.data());
    }
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
