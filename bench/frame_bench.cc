// Whole frames of the crystal ball: the scalar baseline and every usable SIMD target, one thread,
// picture writing excluded. Run with --benchmark_enable_random_interleaving for ratios
// (docs/benchmarking.md).
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <cstdlib>
#include <string>

#include "simd/target.h"
#include "src/formats/scene_json.h"
#include "src/render/render.h"

namespace {

using namespace sheaf;  // NOLINT: a program of its own

// Renders `camera` at 1280x960 with one sample a pixel, as often as the benchmark asks.
void RenderFrame(benchmark::State& state, const Scene& scene, const Camera& camera,
                 const std::string& target) {
  RenderOptions options;
  options.width = 1280;
  options.height = 960;
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
  }
  if (stats.target != target) state.SkipWithError("another target ran");
  state.counters["Mray/s"] = benchmark::Counter(static_cast<double>(stats.rays.traced()) * 1e-6,
                                                benchmark::Counter::kIsIterationInvariantRate);
}

}  // namespace

int main(int argc, char** argv) {
  const Result<Scene> scene = ReadSceneJson(SHEAF_SOURCE_DIR "/scenes/crystal-ball.json");
  if (!scene) {
    fmt::print(stderr, "{}\n", scene.error().message);
    return EXIT_FAILURE;
  }
  std::vector<std::string> targets = simd::UsableTargets();
  targets.push_back("scalar");
  for (const Camera& camera : scene.value().cameras) {
    for (const std::string& target : targets) {
      const std::string name = fmt::format("Frame/crystal-ball/{}/{}", camera.name, target);
      benchmark::RegisterBenchmark(name.c_str(), [&scene, &camera,
                                                  target](benchmark::State& state) {
        RenderFrame(state, scene.value(), camera, target);
      })->Unit(benchmark::kMillisecond);
    }
  }
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return EXIT_FAILURE;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return EXIT_SUCCESS;
}
