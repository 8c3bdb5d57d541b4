// Geometry::Update: primitives that move.
#include <oneapi/tbb/task_arena.h>

#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "sheaf/geometry.h"
#include "src/bvh/geometry_access.h"
#include "src/bvh/refit_meshes.h"
#include "src/bvh/refit_tree.h"
#include "src/core/parallel.h"

namespace sheaf {
namespace {

// Refits the tree where it is over what `flat` holds. Returns whether it was, and is good enough.
template <typename Real>
bool Refit(FlatInputOf<Real>& flat, Real scale, double rebuild_above,
           GeometryAccess::Data<Real>& data) {
  const GeometryView<Real> view = flat.arrays.view();
  const std::uint32_t hittable = flat.first.back() - flat.never_hit - flat.skipped;
  const bvh::PlacesById places(view);
  if (!bvh::IsTreeOver(view, hittable, places, data.tree)) return false;
  if (data.built_cost < 0) data.built_cost = bvh::CostOfTree(data.tree);
  bvh::RefitTree(view, places, data.tree);
  data.view = data.tree.view();
  data.scale = scale;
  return bvh::CostOfTree(data.tree) <= rebuild_above * data.built_cost;
}

// The same for plain meshes, without arrays between. Where it is false, because something is not so
// plain or the tree is not good enough, the long way is to follow.
bool RefitPlain(const std::vector<bvh::FloatMesh>& meshes, double rebuild_above,
                GeometryAccess::Data<float>& data) {
  const std::uint32_t hittable = data.tree.of(PrimitiveKind::kTriangle).count;
  if (meshes.empty() || data.scale != 1 || data.normal[0][0].size() > 0 ||
      data.first.size() != meshes.size() + 1 || data.first.back() != hittable) {
    return false;
  }
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    const std::size_t count = data.first[i + 1] - data.first[i];
    if (meshes[i].first != data.first[i] || meshes[i].indices.size() != 3 * count) return false;
  }
  if (!bvh::AreModerate(meshes)) return false;
  if (data.built_cost < 0) data.built_cost = bvh::CostOfTree(data.tree);
  const bool is_fit = bvh::RefitMeshes(meshes, data.tree);
  data.view = data.tree.view();
  return is_fit && bvh::CostOfTree(data.tree) <= rebuild_above * data.built_cost;
}

}  // namespace

std::vector<bvh::FloatMesh> GeometryAccess::PlainMeshes(const GeometryInput& input) {
  std::vector<bvh::FloatMesh> meshes;
  std::size_t first = 0;
  for (const auto& [kind, numbers, indices, normals] : input.objects_) {
    const bool is_plain = kind == 0 && normals.floats.empty() && normals.doubles.empty() &&
                          numbers.floats.data() != nullptr && numbers.floats.size() % 3 == 0 &&
                          indices.data() != nullptr && indices.size() % 3 == 0 &&
                          !indices.empty() && first <= kMaxTreePrimitives;
    if (!is_plain) return {};
    meshes.push_back({numbers.floats, indices, static_cast<std::uint32_t>(first)});
    first += indices.size() / 3;
  }
  return meshes;
}

template <typename Real>
Result<Updated> GeometryOf<Real>::Update(const GeometryInput& input, const UpdateOptions& options) {
  if (!(options.rebuild_above >= 1)) {
    return Error{ErrorKind::kUsage,
                 "rebuild_above is " + std::to_string(options.rebuild_above) + ", at least 1"};
  }
  oneapi::tbb::task_arena arena(ThreadCount(options.threads));
  if constexpr (std::is_same_v<Real, float>) {
    const bool is_refit = data_ && arena.execute([&] {
      return RefitPlain(GeometryAccess::PlainMeshes(input), options.rebuild_above, *data_);
    });
    if (is_refit) return Updated::kRefit;
  }
  Result<FlatInputOf<Real>> flattened =
      GeometryAccess::FlattenTo<Real>(input, {options.threads, options.not_finite});
  if (!flattened) return flattened.error();
  FlatInputOf<Real>& flat = flattened.value();
  const Real scale = Rescale(flat);
  if (data_ && data_->first == flat.first && data_->first_triangle == flat.first_triangle) {
    const bool is_refit =
        arena.execute([&] { return Refit(flat, scale, options.rebuild_above, *data_); });
    if (is_refit) {
      data_->Take(flat, scale);
      return Updated::kRefit;
    }
  }
  const Status built = GeometryAccess::BuildFrom(flat, scale, options.threads, *this);
  if (!built) return built.error();
  return Updated::kRebuilt;
}

template Result<Updated> GeometryOf<float>::Update(const GeometryInput&, const UpdateOptions&);
template Result<Updated> GeometryOf<double>::Update(const GeometryInput&, const UpdateOptions&);

}  // namespace sheaf
