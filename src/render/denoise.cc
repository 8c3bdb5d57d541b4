#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <utility>

#include "sheaf/render.h"
#include "simd/kernels.h"
#include "src/core/parallel.h"
#include "src/render/clamp_speckles.h"
#include "src/render/estimate_noise.h"
#include "src/render/noisy_picture.h"
#include "src/render/oidn_filter.h"
#include "src/scalar/filter_noise.h"
#include "src/scalar/median_of_six.h"

namespace sheaf {
namespace {

// A pass looks as far as the filter does, and takes the mean of the variances there.
// One more pixel is where speckles are looked for.
constexpr int kReachOfPasses =
    1 + kDenoiseRadius * ((1 << kDenoiseLevels) - 1) + 2 * kDenoiseLevels;
static_assert(kReachOfPasses + kNoiseReach <= kDenoiseReach);

struct Tiles {
  explicit Tiles(const Film& film)
      : across((film.width + kColumns - 1) / kColumns),
        count(across * ((film.height + kRows - 1) / kRows)) {}

  static constexpr int kColumns = static_cast<int>(kDenoiseColumns);
  static constexpr int kRows = static_cast<int>(kDenoiseRows);
  int across, count;
};

struct DenoiseKernels {
  FindMediansKernel<float>* find_medians;
  FilterNoiseKernel<float>* filter_noise;
};

DenoiseKernels KernelsOf(Target target) {
  if (target.is_scalar()) return {&scalar::FindMedians<float>, &scalar::FilterNoise<float>};
  const Kernels<float> kernels = StrictKernels<float>(target.id());
  return {kernels.find_medians, kernels.filter_noise};
}

class Denoiser {
 public:
  Denoiser(const Film& film, const DenoiseOptions& options)
      : film_(film),
        threads_(ThreadCount(options.threads)),
        kernels_(KernelsOf(options.target)),
        picture_(SplitFilm(film, threads_)) {
    for (NoisyPlane& plane : next_) plane.Allocate(film.width, film.height);
    next_variance_.Allocate(film.width, film.height);
  }

  Film Run() {
    EstimateNoise(film_, kernels_.find_medians, threads_, next_, &picture_);
    ClampSpeckles(film_, picture_, threads_, next_);
    TakeColours();
    for (int level = 0; level < kDenoiseLevels; ++level) Filter(1 << level);
    return Join();
  }

 private:
  // One pass over the whole picture.
  void Filter(int step) {
    MeanOfPatches(picture_.variance, film_.width, film_.height, threads_, &picture_.mean_variance);
    picture_.mean_variance.RepeatEdges();
    const Tiles tiles(film_);
    ParallelFor(threads_, static_cast<std::uint64_t>(tiles.count), [&](int /*worker*/, auto item) {
      const int x = static_cast<int>(item) % tiles.across * Tiles::kColumns;
      const int y = static_cast<int>(item) / tiles.across * Tiles::kRows;
      const NoisyTile tile{next_variance_.stride(),
                           static_cast<std::uint32_t>(std::min(Tiles::kColumns, film_.width - x)),
                           static_cast<std::uint32_t>(std::min(Tiles::kRows, film_.height - y)),
                           step};
      kernels_.filter_noise(
          picture_.ViewAt(x, y), tile,
          {{next_[0].at(x, y), next_[1].at(x, y), next_[2].at(x, y)}, next_variance_.at(x, y)});
    });
    TakeColours();
    std::swap(picture_.variance, next_variance_);
    picture_.variance.RepeatEdges();
  }

  void TakeColours() {
    for (int c = 0; c < 3; ++c) {
      std::swap(picture_.colour[c], next_[c]);
      picture_.colour[c].RepeatEdges();
    }
  }

  // What the light has changed by is added, times the albedo, so that what has not changed keeps
  // its bits. No rounding makes light negative.
  Film Join() const {
    Film film = film_;
    ParallelFor(threads_, static_cast<std::uint64_t>(film.height), [&](int /*worker*/, auto row) {
      const int y = static_cast<int>(row);
      for (int x = 0; x < film.width; ++x) {
        for (int c = 0; c < 3 && picture_.is_usable(x, y); ++c) {
          float& colour = film.pixel(x, y)[c];
          const float albedo = NoisyAlbedo(film, x, y, c);
          const float change = *picture_.colour[c].at(x, y) - colour / albedo;
          if (change == 0) continue;
          const float sum = colour + albedo * change;
          colour = sum < 0 && colour >= 0 ? 0 : sum;
        }
      }
    });
    return film;
  }

  const Film& film_;
  const int threads_;
  const DenoiseKernels kernels_;
  NoisyPicture picture_;
  NoisyPlane next_[3], next_variance_;
};

}  // namespace

Result<Film> Denoise(const Film& film, const DenoiseOptions& options) {
  if (options.threads < 0 || options.threads > kMaxThreads) {
    return Error{ErrorKind::kUsage, fmt::format("threads must lie in [0, {}]", kMaxThreads)};
  }
  if (film.width < 1 || film.height < 1) return film;
  if (options.filter == DenoiseFilter::kOidn) return DenoiseByOidn(film, options.threads);
  return Denoiser(film, options).Run();
}

}  // namespace sheaf
