#include "src/render/clamp_speckles.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "src/core/parallel.h"

namespace sheaf {
namespace {

// A picture is noisy from this deviation on, as a share of what is brightest around.
constexpr float kNoisyShare = 0.05f;

// The brightest of nine pixels of a noisy plane lies so far above the others, now and then.
constexpr float kUsualDeviations = 1;

float BrightestAround(const float* at, std::ptrdiff_t stride) {
  const auto column = [&](std::ptrdiff_t x) {
    return std::max(std::max(at[x - stride], at[x + stride]), at[x]);
  };
  return std::max(std::max(column(-1), column(1)), std::max(at[-stride], at[stride]));
}

// The same of light times albedo, over the albedo of the pixel itself. Where the two pixels'
// albedos differ, by texture or because the layer knows one sample alone, colours may be alike
// though lights are not.
float BrightestByColour(const Film& film, const NoisyPlane& light, int x, int y, int channel) {
  float most = 0;
  for (int j = std::max(y - 1, 0); j <= std::min(y + 1, film.height - 1); ++j) {
    for (int i = std::max(x - 1, 0); i <= std::min(x + 1, film.width - 1); ++i) {
      if (i == x && j == y) continue;
      most = std::max(most, *light.at(i, j) * NoisyAlbedo(film, i, j, channel));
    }
  }
  return most / NoisyAlbedo(film, x, y, channel);
}

}  // namespace

void ClampSpeckles(const Film& film, const NoisyPicture& picture, int threads,
                   NoisyPlane (&clamped)[3]) {
  const std::ptrdiff_t stride = picture.variance.stride();
  ParallelFor(threads, static_cast<std::uint64_t>(film.height), [&](int /*worker*/, auto row) {
    const int y = static_cast<int>(row);
    const float* const variance = picture.variance.at(0, y);
    for (int x = 0; x < film.width; ++x) {
      float most[3], square = 0;
      for (int c = 0; c < 3; ++c) {
        most[c] = BrightestAround(picture.colour[c].at(x, y), stride);
        square += most[c] * most[c];
      }
      const bool is_noisy = variance[x] > kNoisyShare * kNoisyShare * square;
      const float usual = kUsualDeviations * std::sqrt(variance[x]);
      for (int c = 0; c < 3; ++c) {
        float colour = *picture.colour[c].at(x, y);
        if (is_noisy && colour > most[c] + usual) {
          const float by_colour = BrightestByColour(film, picture.colour[c], x, y, c);
          colour = std::min(colour, std::max(most[c], by_colour) + usual);
        }
        *clamped[c].at(x, y) = colour;
      }
    }
  });
}

}  // namespace sheaf
