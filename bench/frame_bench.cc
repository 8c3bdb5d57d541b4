// Whole frames: the scalar baseline and every usable SIMD target, one thread,
// building the tree and writing the picture excluded. Run with
// --benchmark_enable_random_interleaving for ratios (docs/benchmarking.md).
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include "bench/frame_scenes.h"
#include "simd/target.h"
#include "src/formats/scene_json.h"
#include "src/render/render.h"

namespace {

using namespace sheaf;  // NOLINT: a program of its own

// Renders `camera` with one sample a pixel, as often as the benchmark asks.
void RenderFrame(benchmark::State& state, const Scene& scene, const Camera& camera,
                 const std::string& target) {
  RenderOptions options;
  options.width = scene.settings.width;
  options.height = scene.settings.height;
  options.max_depth = scene.settings.max_depth;
  options.threads = 1;
  options.engine = target == "scalar" ? Engine::kScalar : Engine::kSimd;
  if (options.engine == Engine::kSimd && !simd::ForceTarget(target)) {
    state.SkipWithError("the target is not usable");
    return;
  }
  RenderStats stats;
  for (auto _ : state) {
    const Result<Film> film = Render(scene, camera, options, &stats);
    benchmark::DoNotOptimize(film.value().rgb.data());
    state.SetIterationTime(stats.wall_seconds);
  }
  if (stats.target != target) state.SkipWithError("another target ran");
  state.counters["Mray/s"] = benchmark::Counter(static_cast<double>(stats.rays.traced()) * 1e-6,
                                                benchmark::Counter::kIsIterationInvariantRate);
}

}  // namespace

int main(int argc, char** argv) {
  Result<Scene> scene = ReadSceneJson(SHEAF_SOURCE_DIR "/scenes/crystal-ball.json");
  if (!scene) {
    fmt::print(stderr, "{}\n", scene.error().message);
    return EXIT_FAILURE;
  }
  std::vector<std::string> targets = simd::UsableTargets();
  targets.push_back("scalar");
  Scene crystal_ball = std::move(scene).value();
  crystal_ball.settings.width = 1280;
  crystal_ball.settings.height = 960;
  std::vector<std::pair<std::string, Scene>> scenes = {{"crystal-ball", crystal_ball}};
  for (const bench::FrameScene& frame : bench::FrameScenes()) {
    scenes.emplace_back(frame.name, frame.make());
  }
  for (const auto& [title, shown] : scenes) {
    for (const Camera& camera : shown.cameras) {
      for (const std::string& target : targets) {
        const std::string name = fmt::format("Frame/{}/{}/{}", title, camera.name, target);
        benchmark::RegisterBenchmark(name.c_str(),
                                     [&shown, &camera, target](benchmark::State& state) {
                                       RenderFrame(state, shown, camera, target);
                                     })
            ->Unit(benchmark::kMillisecond)
            ->UseManualTime();
      }
    }
  }
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return EXIT_FAILURE;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return EXIT_SUCCESS;
}
