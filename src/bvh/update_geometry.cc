// From a geometry to that of other vertices, by way of the old tree where it is good enough.
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <new>
#include <type_traits>
#include <utility>
#include <vector>

#include "src/bvh/build_tree.h"
#include "src/bvh/geometry_access.h"
#include "src/bvh/refit_tree.h"
#include "src/core/parallel.h"

namespace sheaf {
namespace {

template <typename Real>
ObjectIndex IndexOfObjects(const FlatInputOf<Real>& flat) {
  ObjectIndex objects{flat.first, {}};
  PrimitiveCounts next;
  for (std::size_t i = 0; i < flat.kind.size(); ++i) {
    objects.index.push_back(next[flat.kind[i]]);
    next[flat.kind[i]] += flat.first[i + 1] - flat.first[i];
  }
  return objects;
}

// A tree's arrays for one that only shows them; what RefitTree writes is left open.
template <typename Real>
Tree<Real> CopyOf(const TreeView<Real>& view) {
  Tree<Real> tree;
  tree.SetBounds({}, {});
  tree.node_count = view.node_count;
  tree.nodes.AllocateForOverwrite(view.node_count, 0);
  std::copy_n(view.nodes, view.node_count, tree.nodes.data());
  for (std::uint32_t k = 0; k < kKindCount; ++k) {
    const std::size_t count = view.blocks[k].count;
    const std::size_t fields = FieldCountOf(static_cast<PrimitiveKind>(k)) * count;
    tree.blocks[k].count = view.blocks[k].count;
    tree.blocks[k].id.AllocateForOverwrite(count + kMaxLanes, kMaxLanes);
    tree.blocks[k].fields.AllocateForOverwrite(fields + kMaxLanes, kMaxLanes);
    std::copy_n(view.blocks[k].id, count, tree.blocks[k].id.data());
  }
  return tree;
}

// Whether the tree costs more than a new one may save.
template <typename Data>
bool IsTooDear(const Data& data, double rebuild_ratio) {
  return CostOfTree(data.view) > rebuild_ratio * data.built_cost;
}

// Refits a tree of plain meshes without arrays between. Where something is not so plain it is
// false, and the long way is to follow; nothing in that can fail then but for want of memory.
bool RefitPlain(const std::vector<bvh::FloatMesh>& meshes, GeometryAccess::Data<float>& data) {
  const std::uint32_t hittable = data.view.of(PrimitiveKind::kTriangle).count;
  if (meshes.empty() || data.file || data.scale != 1 || data.normals[0] ||
      data.first.size() != meshes.size() + 1 || data.first.back() != hittable) {
    return false;
  }
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    const std::size_t count = data.first[i + 1] - data.first[i];
    if (meshes[i].first != data.first[i] || meshes[i].indices.size() != 3 * count) return false;
  }
  if (!bvh::AreModerate(meshes)) return false;
  if (data.built_cost < 0) data.built_cost = CostOfTree(data.view);
  const bool is_fit = bvh::RefitMeshes(meshes, data.tree);
  data.view = data.tree.view();
  return is_fit;
}

}  // namespace

std::vector<bvh::FloatMesh> GeometryAccess::PlainMeshes(const GeometryInput& input) {
  std::vector<bvh::FloatMesh> meshes;
  std::size_t first = 0;
  for (const auto& [kind, numbers, indices, normals] : input.objects_) {
    const bool is_plain = kind == 0 && normals.floats.empty() && normals.doubles.empty() &&
                          !numbers.floats.empty() && numbers.floats.data() != nullptr &&
                          numbers.floats.size() % 3 == 0 && indices.data() != nullptr &&
                          indices.size() % 3 == 0 && !indices.empty() &&
                          first <= kMaxTreePrimitives;
    if (!is_plain) return {};
    meshes.push_back({numbers.floats, indices, static_cast<std::uint32_t>(first)});
    first += indices.size() / 3;
  }
  return meshes;
}

template <typename Real>
Result<Updated> GeometryOf<Real>::Update(const GeometryInput& input, const UpdateOptions& options) {
  oneapi::tbb::task_arena arena(ThreadCount(options.threads));
  bool is_refitted = false;
  if constexpr (std::is_same_v<Real, float>) {
    is_refitted = data_ && options.rebuild_ratio > 0 && arena.execute([&] {
      return RefitPlain(GeometryAccess::PlainMeshes(input), *data_);
    });
    if (is_refitted && !IsTooDear(*data_, options.rebuild_ratio)) return Updated::kRefitted;
  }
  Result<FlatInputOf<Real>> flattened = GeometryAccess::FlattenTo<Real>(
      input, {.threads = options.threads, .not_finite = options.not_finite});
  if (!flattened) return flattened.error();
  FlatInputOf<Real>& flat = flattened.value();
  const Real scale = Rescale(flat);
  const auto rebuild = [&]() -> Result<Updated> {
    auto built = GeometryAccess::BuildData(flat, scale, options.threads);
    if (!built) return built.error();
    data_ = std::move(built).value();
    return Updated::kRebuilt;
  };
  if (!is_refitted) {
    const bool has_same_objects = data_ && data_->first == flat.first && data_->kind == flat.kind &&
                                  options.rebuild_ratio > 0;
    if (!has_same_objects) return rebuild();
    const ObjectIndex objects = IndexOfObjects(flat);
    const GeometryView<Real> geometry = flat.arrays.view();
    // Where all are in the tree and can be hit there is nothing to compare.
    const std::uint32_t absent = flat.never_hit + flat.skipped;
    const bool has_all = absent == 0 && data_->view.primitive_count() == flat.first.back();
    if (!has_all && !HasSamePrimitives(data_->view, geometry, objects)) return rebuild();

    if (data_->built_cost < 0) data_->built_cost = CostOfTree(data_->view);
    if (data_->file) {
      data_->tree = CopyOf(data_->view);
      data_->view = data_->tree.view();
      data_->file.reset();
      data_->file_bytes = 0;
    }
    arena.execute([&] { RefitTree(geometry, objects, data_->tree); });
    data_->view = data_->tree.view();
    data_->scale = scale;
  }
  if (IsTooDear(*data_, options.rebuild_ratio)) {
    try {
      return rebuild();
    } catch (const std::bad_alloc&) {
      // The refitted tree is as right, so that it stays where there is no room for a better one.
    }
  }
  data_->Take(flat);
  return Updated::kRefitted;
}

template Result<Updated> GeometryOf<float>::Update(const GeometryInput&, const UpdateOptions&);
template Result<Updated> GeometryOf<double>::Update(const GeometryInput&, const UpdateOptions&);

}  // namespace sheaf
