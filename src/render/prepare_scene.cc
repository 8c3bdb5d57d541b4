#include "src/render/prepare_scene.h"

#include <type_traits>
#include <utility>

#include "simd/shading.h"
#include "src/bvh/build_tree.h"
#include "src/render/round_corners.h"
#include "src/scene/shapes.h"

namespace sheaf {
namespace {

// Whether what was prepared is what this camera's placement would make again.
template <typename Real>
bool IsFor(const PreparedScene<Real>& prepared, const Scene& scene, const ScenePlacement& placement,
           Integrator integrator, Skips skips) {
  const ScenePlacement& old = prepared.placement;
  if (old.origin != placement.origin || old.scale != placement.scale ||
      prepared.integrator != integrator || prepared.skips != skips) {
    return false;
  }
  if (std::is_same_v<Real, double> || old.nearest == placement.nearest) return true;
  return !prepared.has_rounded_corners && RoundCorners(scene, placement).empty();
}

template <typename Real>
Result<std::shared_ptr<const PreparedScene<Real>>> Compile(const Scene& scene,
                                                           const ScenePlacement& placement,
                                                           Integrator integrator, Skips skips,
                                                           int threads) {
  if (const Status counts = CheckCounts(CountPrimitives(scene)); !counts.ok()) {
    return Error{ErrorKind::kScene, counts.error().message};
  }
  auto prepared = std::make_shared<PreparedScene<Real>>();
  CompiledScene<Real>& compiled = prepared->compiled;
  compiled = CompileScene<Real>(scene, placement, integrator);
  if (skips == Skips::kOff) {
    for (MaterialData<Real>& material : compiled.materials) material.needs |= kNeedsAll;
  }
  if (const Status built = compiled.objects.BuildTrees(threads); !built.ok()) {
    return Error{ErrorKind::kScene, built.error().message};
  }
  prepared->placement = placement;
  prepared->integrator = integrator;
  prepared->skips = skips;
  prepared->has_rounded_corners = compiled.objects.has_rounded_corners;
  return std::shared_ptr<const PreparedScene<Real>>(std::move(prepared));
}

}  // namespace

Status ScenePreparer::Check() {
  {
    const std::lock_guard lock(mutex_);
    if (is_sound_) return Done{};
  }
  const Status sound = Validate(scene_);
  if (!sound) return sound;
  const std::lock_guard lock(mutex_);
  is_sound_ = true;
  return Done{};
}

template <typename Real>
Result<std::shared_ptr<const PreparedScene<Real>>> ScenePreparer::Prepare(const Camera& camera,
                                                                          Integrator integrator,
                                                                          Skips skips,
                                                                          int threads) {
  const ScenePlacement placement = PlaceScene(scene_, camera);
  Kept<Real> kept;
  {
    const std::lock_guard lock(mutex_);
    kept = std::get<Kept<Real>>(kept_);
  }
  if (kept && IsFor(*kept, scene_, placement, integrator, skips)) return kept;
  // Not under the lock: while the trees are built a thread may take up another frame's work, which
  // would wait for itself.
  auto made = Compile<Real>(scene_, placement, integrator, skips, threads);
  if (!made) return made.error();
  const std::lock_guard lock(mutex_);
  std::get<Kept<Real>>(kept_) = made.value();
  return made;
}

template Result<std::shared_ptr<const PreparedScene<float>>> ScenePreparer::Prepare(const Camera&,
                                                                                    Integrator,
                                                                                    Skips, int);
template Result<std::shared_ptr<const PreparedScene<double>>> ScenePreparer::Prepare(const Camera&,
                                                                                     Integrator,
                                                                                     Skips, int);

}  // namespace sheaf
