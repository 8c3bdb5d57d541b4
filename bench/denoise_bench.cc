// The denoiser on the baseline and every usable SIMD target. One thread. Its time depends on the
// number of pixels alone, not on what they show.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "bench/make_scenes.h"
#include "sheaf/render.h"
#include "sheaf/target.h"
#include "src/core/running_target.h"

namespace {

using namespace sheaf;  // NOLINT: a program of its own

constexpr int kSide = 1024;

Film NoisyFilm() {
  Layers layers;
  for (const Layer layer : {Layer::kAlbedo, Layer::kNormal, Layer::kDepth}) layers.Add(layer);
  Film film(kSide, kSide, layers);
  for (std::size_t i = 0; i < film.rgb.size(); ++i) {
    film.rgb[i] = static_cast<float>(bench::HashUnit(i));
  }
  for (auto& layer : film.layers) std::fill(layer.begin(), layer.end(), 0.5f);
  return film;
}

void DenoiseFilm(benchmark::State& state, const std::string& name) {
  const std::optional<Target> target = Target::Named(name);
  if (!target || RunningTarget(*target) != name) {
    state.SkipWithError("the target is not usable");
    return;
  }
  const Film film = NoisyFilm();
  for (auto _ : state) {
    const Result<Film> denoised = Denoise(film, {*target, 1});
    benchmark::DoNotOptimize(denoised.value().rgb.data());
  }
  state.counters["Mpixel/s"] = benchmark::Counter(static_cast<double>(film.pixel_count()) * 1e-6,
                                                  benchmark::Counter::kIsIterationInvariantRate);
}

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  std::vector<std::string> targets = UsableTargets();
  targets.push_back("scalar");
  for (const std::string& target : targets) {
    benchmark::RegisterBenchmark(("Denoise/1024x1024/" + target).c_str(),
                                 [target](benchmark::State& state) { DenoiseFilm(state, target); })
        ->Unit(benchmark::kMillisecond)
        ->UseRealTime();
  }
  benchmark::RunSpecifiedBenchmarks();
}
