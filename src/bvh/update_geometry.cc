// Geometry::Update: primitives that move.
#include <oneapi/tbb/task_arena.h>

#include <string>
#include <utility>

#include "sheaf/geometry.h"
#include "src/bvh/geometry_access.h"
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

}  // namespace

template <typename Real>
Result<Updated> GeometryOf<Real>::Update(const GeometryInput& input, const UpdateOptions& options) {
  if (!(options.rebuild_above >= 1)) {
    return Error{ErrorKind::kUsage,
                 "rebuild_above is " + std::to_string(options.rebuild_above) + ", at least 1"};
  }
  Result<FlatInputOf<Real>> flattened =
      GeometryAccess::FlattenTo<Real>(input, {options.threads, options.not_finite});
  if (!flattened) return flattened.error();
  FlatInputOf<Real>& flat = flattened.value();
  const Real scale = Rescale(flat);
  if (data_ && data_->first == flat.first && data_->first_triangle == flat.first_triangle) {
    oneapi::tbb::task_arena arena(ThreadCount(options.threads));
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
