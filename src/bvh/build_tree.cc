#include "src/bvh/build_tree.h"

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/task_arena.h>

#include <limits>
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

Error TooMany(const char* kind, std::uint32_t count) {
  return {ErrorKind::kUsage, std::to_string(count) + " " + kind + ", at most " +
                                 std::to_string(kMaxTreePrimitives) + " are possible"};
}

template <typename Real>
Result<Tree<Real>> Build(const GeometryView<Real>& geometry) {
  Result<PrimitiveBoxes> made = bvh::MakePrimitiveBoxes(geometry);
  if (!made) return made.error();
  PrimitiveBoxes boxes = std::move(made).value();
  Tree<Real> tree;
  tree.triangle_count = boxes.triangles;
  tree.sphere_count = boxes.spheres;
  const bool is_empty = boxes.triangles + boxes.spheres == 0;
  for (int axis = 0; axis < 3; ++axis) {
    constexpr float kMax = std::numeric_limits<float>::max();
    tree.lower[axis] = is_empty ? kMax : boxes.bounds.lower[axis];
    tree.upper[axis] = is_empty ? -kMax : boxes.bounds.upper[axis];
  }
  tree.triangle_id.Allocate(std::size_t{tree.triangle_count} + kMaxLanes);
  tree.sphere_id.Allocate(std::size_t{tree.sphere_count} + kMaxLanes);
  if (!is_empty) {
    tree.node_count = bvh::FlattenNodes(
        bvh::BuildNodes(boxes, tree.triangle_id.data(), tree.sphere_id.data()), tree.nodes);
  }
  boxes.boxes.reset();  // before the blocks, which are as large
  tree.triangles.Allocate(std::size_t{tree.triangle_count} * 9 + kMaxLanes);
  tree.spheres.Allocate(std::size_t{tree.sphere_count} * 4 + kMaxLanes);
  bvh::WriteLeaves(geometry, tree);
  return tree;
}

}  // namespace

template <typename Real>
Result<Tree<Real>> BuildTree(const GeometryView<Real>& geometry, int threads) {
  const std::uint32_t triangles = geometry.triangles.count, spheres = geometry.spheres.count;
  if (triangles > kMaxTreePrimitives) return TooMany("triangles", triangles);
  if (spheres > kMaxTreePrimitives) return TooMany("spheres", spheres);
  threads = ThreadCount(threads);
  const oneapi::tbb::global_control limit(oneapi::tbb::global_control::max_allowed_parallelism,
                                          static_cast<std::size_t>(threads));
  oneapi::tbb::task_arena arena(threads);
  return arena.execute([&] { return Build(geometry); });
}

template Result<Tree<float>> BuildTree(const GeometryView<float>&, int);
template Result<Tree<double>> BuildTree(const GeometryView<double>&, int);

}  // namespace sheaf
