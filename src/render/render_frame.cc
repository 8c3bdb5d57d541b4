#include "src/render/render_frame.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <memory>
#include <vector>

#include "simd/shading.h"
#include "simd/tree.h"
#include "src/core/running_target.h"
#include "src/render/check_options.h"
#include "src/render/compile_scene.h"
#include "src/render/place_scene.h"
#include "src/render/prepare_scene.h"
#include "src/render/render_bands.h"
#include "src/render/render_rounds.h"
#include "src/render/sample_pattern.h"
#include "src/render/scalar_tile_renderer.h"
#include "src/render/tile_renderer.h"

namespace sheaf {
namespace {

using Clock = std::chrono::steady_clock;

// What a frame's rays read, and what owns it.
template <typename Real>
struct CompiledFrame {
  std::shared_ptr<const PreparedScene<Real>> scene;
  std::vector<Real> sample_x, sample_y;
  FrameView<Real> view;
};

// Whether there is anything to draw random points from.
template <typename Real>
bool IsDistributed(const FrameView<Real>& frame) {
  return frame.follows_paths || frame.camera.lens != LensUse::kNone ||
         std::any_of(frame.lights.begin(), frame.lights.end(),
                     [](const auto& light) { return light.shape != LightShape::kPoint; }) ||
         std::any_of(frame.materials.begin(), frame.materials.end(),
                     [](const auto& material) { return HasFacets(material); });
}

template <typename Real>
Result<std::unique_ptr<CompiledFrame<Real>>> CompileFrame(ScenePreparer& preparer,
                                                          const Camera& camera,
                                                          const RenderOptions& options,
                                                          Skips skips) {
  const Scene& scene = preparer.scene();
  const Integrator integrator = options.integrator.value_or(scene.settings.integrator);
  auto prepared = preparer.Prepare<Real>(camera, integrator, skips, options.threads);
  if (!prepared) return prepared.error();
  auto frame = std::make_unique<CompiledFrame<Real>>();
  frame->scene = std::move(prepared).value();
  const CompiledScene<Real>& compiled = frame->scene->compiled;
  const ScenePlacement& placement = frame->scene->placement;
  const PixelFilter filter = scene.settings.filter;
  const auto pattern = options.error ? SobolPattern(options.samples, filter)
                                     : SamplePattern(options.samples, filter);
  for (const glm::dvec2& point : pattern) {
    frame->sample_x.push_back(static_cast<Real>(point.x));
    frame->sample_y.push_back(static_cast<Real>(point.y));
  }
  frame->view = {
      compiled.geometry(),
      compiled.objects.data.tree.view(),
      compiled.objects.primitives,
      compiled.objects.object_of_primitive,
      compiled.materials,
      compiled.textures,
      compiled.lights,
      frame->sample_x,
      frame->sample_y,
      CompileCamera<Real>(camera, options.width, options.height, placement),
      {compiled.background[0], compiled.background[1], compiled.background[2]},
      compiled.environment,
      options.max_depth,
      options.width,
      options.height,
      static_cast<Real>(options.contrast.value_or(std::nan(""))),
      static_cast<Real>(options.min_throughput),
      std::any_of(compiled.materials.begin(), compiled.materials.end(),
                  [](const MaterialData<Real>& material) { return LetsLightPass(material); }),
      std::any_of(compiled.materials.begin(), compiled.materials.end(),
                  [](const MaterialData<Real>& material) { return material.attenuates; }),
      static_cast<Real>(1 / placement.scale)};
  frame->view.instances = compiled.objects.forest.view();
  frame->view.to_world = compiled.objects.to_world.data();
  if (integrator == Integrator::kWhitted) frame->view.camera.lens = LensUse::kNone;
  frame->view.error = static_cast<Real>(options.error.value_or(0));
  frame->view.follows_paths = integrator == Integrator::kPath;
  frame->view.is_distributed = IsDistributed(frame->view);
  // With adaptive sampling a pixel's only sample stands for all of it.
  const double parts = frame->view.is_adaptive() ? 1 : options.samples;
  frame->view.cone = CompileCone(frame->view.camera, parts);
  if (skips == Skips::kOff) {
    frame->view.tree.skips_boxes = frame->view.tree.node_count == 0;
  }
  return frame;
}

// Renders the compiled frame.
using Schedule = std::function<Status(const RenderOptions& options, const MakeWorker& make_worker)>;

template <typename Real>
Status RenderIn(ScenePreparer& scene, const Camera& camera, const RenderOptions& options,
                Skips skips, const Schedule& schedule, RenderStats& stats,
                RenderProgress& progress) {
  const Clock::time_point start = Clock::now();
  const auto compiled = CompileFrame<Real>(scene, camera, options, skips);
  if (!compiled) return compiled.error();
  const CompiledGeometry<Real>& objects = compiled.value()->scene->compiled.objects;
  stats.compile_seconds = std::chrono::duration<double>(Clock::now() - start).count();
  progress.stage.store(RenderStage::kRendering, std::memory_order_relaxed);
  stats.spheres = objects.data.arrays.count(PrimitiveKind::kSphere);
  stats.triangles = objects.data.arrays.count(PrimitiveKind::kTriangle);
  stats.disks = objects.data.arrays.count(PrimitiveKind::kDisk);
  stats.primitives = static_cast<std::uint32_t>(objects.primitives.size());
  stats.target = RunningTarget(options.target);

  const FrameView<Real>& frame = compiled.value()->view;
  const auto make_worker = [&]() -> std::unique_ptr<TileWorker> {
    if (options.target.is_scalar()) {
      return std::make_unique<ScalarTileRenderer<Real>>(frame, progress.stop);
    }
    return std::make_unique<TileRenderer<Real>>(frame, options, progress.stop);
  };
  return schedule(options, make_worker);
}

Status RenderScheduled(ScenePreparer& scene, const Camera& camera, const RenderOptions& options,
                       Skips skips, const Schedule& schedule, RenderStats& stats,
                       RenderProgress& progress) {
  const Result<RenderOptions> checked = CheckOptions(options, scene.scene().settings);
  if (!checked) return checked.error();
  if (Status sound = scene.Check(); !sound) return sound;
  if (Status sound = Validate(camera); !sound) return sound;
  stats = {};
  const auto render = options.precision == Precision::kDouble ? RenderIn<double> : RenderIn<float>;
  return render(scene, camera, checked.value(), skips, schedule, stats, progress);
}

}  // namespace

Status RenderFrame(ScenePreparer& scene, const Camera& camera, const RenderOptions& options,
                   Skips skips, const BandSink& sink, RenderStats* stats,
                   RenderProgress* progress) {
  RenderStats ignored_stats;
  RenderProgress ignored_progress;
  RenderStats& kept_stats = stats ? *stats : ignored_stats;
  RenderProgress& kept_progress = progress ? *progress : ignored_progress;
  if (options.budget) {
    const TimeUsed used = [start = Clock::now(), budget = *options.budget] {
      return std::chrono::duration<double>(Clock::now() - start).count() / budget;
    };
    return RenderWhile(used, scene, camera, options, sink, kept_stats, kept_progress);
  }
  const Schedule bands = [&](const RenderOptions& checked, const MakeWorker& make_worker) {
    return RenderBands(AreaOf(checked), checked, make_worker, sink, kept_stats, kept_progress);
  };
  return RenderScheduled(scene, camera, options, skips, bands, kept_stats, kept_progress);
}

Status RenderWhile(const TimeUsed& used, ScenePreparer& scene, const Camera& camera,
                   const RenderOptions& options, const BandSink& sink, RenderStats& stats,
                   RenderProgress& progress) {
  const Schedule rounds = [&](const RenderOptions& checked, const MakeWorker& make_worker) {
    return RenderRounds(checked, make_worker, used, sink, stats, progress);
  };
  return RenderScheduled(scene, camera, options, Skips::kOn, rounds, stats, progress);
}

Status RenderAreas(const Scene& scene, const Camera& camera, const RenderOptions& options,
                   const AreaSource& next, const AreaSink& sink, RenderStats* stats,
                   RenderProgress* progress) {
  const Schedule areas = [&](RenderOptions checked, const MakeWorker& make_worker) {
    checked.band_rows = kMaxImageSide;
    int threads = 0;
    Status status = Done{};
    PixelRect area;
    const BandSink keep = [&](Film& pixels) { return sink(area, pixels); };
    while (status && next(&area)) {
      status = RenderBands(area, checked, make_worker, keep, *stats, *progress);
      threads = std::max(threads, stats->threads);
    }
    stats->threads = threads;
    return status;
  };
  ScenePreparer preparer(scene);
  return RenderScheduled(preparer, camera, options, Skips::kOn, areas, *stats, *progress);
}

}  // namespace sheaf
