// Whole frames: the scalar baseline and every usable SIMD target, POV-Ray where it is installed,
// and what each feature of a scene costs. One thread; building the tree and writing the picture
// excluded. Run with --benchmark_enable_random_interleaving for ratios (docs/benchmarking.md).
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <cstdint>
#include <cstdlib>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "bench/frame_scenes.h"
#include "sheaf/render.h"
#include "sheaf/target.h"
#include "src/core/running_target.h"
#include "src/formats/scene_json.h"
#include "src/lab/pov_ray.h"
#include "src/render/render_frame.h"

namespace {

using namespace sheaf;  // NOLINT: a program of its own

// Renders `camera` with one sample a pixel, as often as the benchmark asks.
void RenderFrame(benchmark::State& state, const Scene& scene, const Camera& camera,
                 const std::string& target, Skips skips) {
  RenderOptions options;
  options.samples = 1;
  options.threads = 1;
  const std::optional<Target> chosen = Target::Named(target);
  if (!chosen) {
    state.SkipWithError("the target is not usable");
    return;
  }
  options.target = *chosen;
  // As the command does it, but for the writing.
  const BandSink drop = [](const Film& rows) {
    benchmark::DoNotOptimize(rows.rgb.data());
    return Status(Done{});
  };
  RenderStats stats;
  for (auto _ : state) {
    ScenePreparer preparer(scene);
    if (!RenderFrame(preparer, camera, options, skips, drop, &stats, nullptr)) {
      state.SkipWithError("rendering failed");
      return;
    }
    state.SetIterationTime(stats.wall_seconds);
  }
  if (stats.target != target) state.SkipWithError("another target ran");
  state.counters["Mray/s"] = benchmark::Counter(static_cast<double>(stats.rays.traced()) * 1e-6,
                                                benchmark::Counter::kIsIterationInvariantRate);
}

void Register(const std::string& name, std::function<void(benchmark::State&)> run) {
  benchmark::RegisterBenchmark(name.c_str(), std::move(run))
      ->Unit(benchmark::kMillisecond)
      ->UseManualTime();
}

// ---- POV-Ray ----

void TimePovRay(benchmark::State& state, const Scene& scene, const Camera& camera) {
  for (auto _ : state) {
    const Result<PovRender> render = RenderWithPovRay(
        scene, camera, scene.settings.width, scene.settings.height, "-A", PovPicture::kNone);
    if (!render) {
      state.SkipWithError(render.error().message.c_str());
      return;
    }
    state.SetIterationTime(render.value().seconds);
  }
}

// ---- What a feature costs ----

struct Feature {
  const char* name;
  void (*remove)(Scene& scene);
};

constexpr Feature kFeatures[] = {
    {"transmission",
     [](Scene& scene) {
       for (Material& material : scene.materials) material.transmit = Colour(0.0);
     }},
    {"reflection",
     [](Scene& scene) {
       for (Material& material : scene.materials) material.reflect = Colour(0.0);
     }},
    {"highlights",
     [](Scene& scene) {
       for (Material& material : scene.materials) material.ks = 0;
     }},
    {"checker",
     [](Scene& scene) {
       for (Material& material : scene.materials) {
         const auto* checker = std::get_if<Checker>(&material.base_colour);
         if (checker != nullptr) material.base_colour = Colour(checker->even);
       }
     }},
    {"shadows",
     [](Scene& scene) {
       for (Light& light : scene.lights) light.casts_shadows = false;
     }},
    {"lights", [](Scene& scene) { scene.lights.clear(); }},
};

// `scene` as it is, without the feature, and the same with what could be skipped computed.
void RegisterFeature(const std::string& name, const Scene& with, const Scene& without,
                     const std::string& target) {
  const auto add = [&](const char* row, const Scene& scene, Skips skips) {
    Register(fmt::format("Feature/{}/{}", name, row),
             [scene, target, skips](benchmark::State& state) {
               RenderFrame(state, scene, scene.cameras.at(0), target, skips);
             });
  };
  add("with", with, Skips::kOn);
  add("without", without, Skips::kOn);
  add("forced", without, Skips::kOff);
}

// The scene with an image on its first material, filtered across footprints.
Scene WithTexture(Scene scene) {
  auto image = std::make_shared<Image>(Image{"", 1024, 1024, {}});
  std::uint32_t noise = 1;
  for (int i = 0; i < 1024 * 1024; ++i) {
    noise = noise * 1664525u + 1013904223u;
    image->texels.push_back(0xff000000u | noise >> 8);
  }
  scene.materials.at(0).base_colour = Texture{image};
  return scene;
}

void RegisterFeatures(const Scene& crystal_ball, const std::string& target) {
  Scene with = crystal_ball;
  for (Material& material : with.materials) material.reflect = Colour(0.2);
  Scene bare = with;
  for (const Feature& feature : kFeatures) {
    Scene without = with;
    feature.remove(without);
    feature.remove(bare);
    RegisterFeature(feature.name, with, without, target);
  }
  RegisterFeature("everything", with, bare, target);
}

}  // namespace

int main(int argc, char** argv) {
  Result<Scene> scene = ReadSceneJson(SHEAF_SOURCE_DIR "/scenes/crystal-ball.json");
  if (!scene) {
    fmt::print(stderr, "{}\n", scene.error().message);
    return EXIT_FAILURE;
  }
  std::vector<std::string> targets = UsableTargets();
  targets.push_back("scalar");
  Scene crystal_ball = std::move(scene).value();
  crystal_ball.settings.width = 1280;
  crystal_ball.settings.height = 960;
  std::vector<std::pair<std::string, Scene>> scenes = {{"crystal-ball", crystal_ball}};
  for (const bench::FrameScene& frame : bench::FrameScenes()) {
    scenes.emplace_back(frame.name, frame.make());
  }
  const bool has_pov_ray = HasPovRay();
  if (!has_pov_ray) fmt::print(stderr, "frame_bench: povray is not installed: no rows of it\n");
  for (const auto& titled : scenes) {
    const auto& title = titled.first;
    const auto& shown = titled.second;
    for (const Camera& camera : shown.cameras) {
      const std::string row = fmt::format("Frame/{}/{}/", title, camera.name);
      for (const std::string& target : targets) {
        Register(row + target, [&shown, &camera, target](benchmark::State& state) {
          RenderFrame(state, shown, camera, target, Skips::kOn);
        });
      }
      if (has_pov_ray) {
        Register(row + "povray",
                 [&shown, &camera](benchmark::State& state) { TimePovRay(state, shown, camera); });
      }
    }
  }
  RegisterFeatures(crystal_ball, targets.front());
  for (const auto& [title, plain] : scenes) {
    if (title == "knot") RegisterFeature("texture", WithTexture(plain), plain, targets.front());
  }
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return EXIT_FAILURE;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return EXIT_SUCCESS;
}
