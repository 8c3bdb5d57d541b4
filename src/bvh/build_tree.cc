#include "src/bvh/build_tree.h"

#include <oneapi/tbb/task_arena.h>

#include <string>
#include <utility>

#include "simd/streams.h"
#include "simd/tree.h"
#include "src/bvh/build_nodes.h"
#include "src/bvh/flatten_tree.h"
#include "src/bvh/primitive_box.h"
#include "src/core/parallel.h"

namespace sheaf {
namespace {

using bvh::PrimitiveBoxes;

template <typename Real>
Result<Tree<Real>> Build(const GeometryView<Real>& geometry) {
  Result<PrimitiveBoxes> made = bvh::MakePrimitiveBoxes(geometry);
  if (!made) return made.error();
  PrimitiveBoxes boxes = std::move(made).value();
  Tree<Real> tree;
  tree.SetBounds(boxes.all, boxes.others);
  std::uint32_t* indices[kKindCount];  // which become ids
  for (std::size_t k = 0; k < kKindCount; ++k) {
    PrimitiveBlocks<Real>& blocks = tree.blocks[k];
    blocks.count = boxes.counts.of[k];
    blocks.id.Allocate(std::size_t{blocks.count} + kMaxLanes);
    indices[k] = blocks.id.data();
  }
  if (boxes.counts.total() > 0) {
    tree.node_count = bvh::FlattenNodes(bvh::BuildNodes(boxes, indices), tree.nodes);
  }
  boxes.boxes.reset();  // before the blocks, which are as large
  ForEachKind(geometry, [&](const auto& arrays) {
    PrimitiveBlocks<Real>& blocks = tree.of(arrays.kKind);
    blocks.fields.Allocate(std::size_t{arrays.kFieldCount} * blocks.count + kMaxLanes);
  });
  bvh::WriteLeaves(geometry, tree);
  return tree;
}

}  // namespace

Status CheckCounts(const CountsByKind<std::uint64_t>& counts) {
  for (std::uint32_t k = 0; k < kKindCount; ++k) {
    if (counts.of[k] <= kMaxTreePrimitives) continue;
    return Error{ErrorKind::kUsage, std::to_string(counts.of[k]) + " " +
                                        NameOf(static_cast<PrimitiveKind>(k)) + "s, at most " +
                                        std::to_string(kMaxTreePrimitives) + " are possible"};
  }
  return Done{};
}

template <typename Real>
Result<Tree<Real>> BuildTree(const GeometryView<Real>& geometry, int threads) {
  CountsByKind<std::uint64_t> counts;
  ForEachKind(geometry, [&](const auto& arrays) { counts[arrays.kKind] = arrays.count; });
  if (const Status status = CheckCounts(counts); !status.ok()) return status.error();
  oneapi::tbb::task_arena arena(ThreadCount(threads));
  return arena.execute([&] { return Build(geometry); });
}

template Result<Tree<float>> BuildTree(const GeometryView<float>&, int);
template Result<Tree<double>> BuildTree(const GeometryView<double>&, int);

}  // namespace sheaf
