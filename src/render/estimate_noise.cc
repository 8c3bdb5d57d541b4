#include "src/render/estimate_noise.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "src/core/parallel.h"

namespace sheaf {
namespace {

// Blocks of a median: those that begin from kFirst to kLast pixels after the pixel, each way.
constexpr int kFirst = -3, kLast = 2, kBlocks = kLast - kFirst + 1;
constexpr int kBandRows = 16;

void Order(float& low, float& high) {
  const float least = low < high ? low : high;
  high = low < high ? high : low;
  low = least;
}

// The mean of the third and the fourth of six, by a network that leaves the others where they are.
float MiddleOf(const float* numbers, std::ptrdiff_t step) {
  float a = numbers[0], b = numbers[step], c = numbers[2 * step], d = numbers[3 * step],
        e = numbers[4 * step], f = numbers[5 * step];
  Order(a, b);
  Order(c, d);
  Order(e, f);
  // The least and the largest of all.
  Order(a, c);
  Order(a, e);
  Order(d, f);
  Order(b, f);
  // Of b, c, d and e the middle two.
  Order(b, c);
  Order(d, e);
  Order(b, d);
  Order(c, e);
  return (c + d) * 0.5f;
}

// The median of one row's blocks around each pixel.
void MedianAcross(const NoisyPlane& plane, int y, int width, float* blocks, float* medians) {
  const float* const above = plane.at(kFirst, y);
  const float* const below = plane.at(kFirst, y + 1);
  for (int x = 0; x < width + kBlocks - 1; ++x) {
    blocks[x] = std::abs(((above[x] - above[x + 1]) - below[x]) + below[x + 1]) * 0.5f;
  }
  for (int x = 0; x < width; ++x) medians[x] = MiddleOf(blocks + x, 1);
}

// Finds the medians of a band of rows.
class Band {
 public:
  Band(int width, int y0, int y1)
      : width_(width),
        y0_(y0),
        y1_(y1),
        blocks_(static_cast<std::size_t>(width + kBlocks)),
        medians_(static_cast<std::size_t>(width) * (kBandRows + kBlocks - 1)) {}

  // Calls use(y, variances), where one number belongs to each pixel of the row.
  template <typename Use>
  void ForEachRow(const NoisyPlane& plane, Use use) {
    for (int y = y0_ + kFirst; y < y1_ + kLast; ++y) {
      MedianAcross(plane, y, width_, blocks_.data(), MediansOf(y));
    }
    constexpr float kOverMedian = 1 / 0.6745f;
    for (int y = y0_; y < y1_; ++y) {
      float* const row = MediansOf(y + kFirst);  // which is not needed any more
      for (int x = 0; x < width_; ++x) {
        const float deviation = MiddleOf(row + x, width_) * kOverMedian;
        row[x] = deviation * deviation;
      }
      use(y, row);
    }
  }

 private:
  float* MediansOf(int y) {
    return medians_.data() + static_cast<std::ptrdiff_t>(width_) * (y - y0_ - kFirst);
  }

  const int width_, y0_, y1_;
  std::vector<float> blocks_, medians_;
};

void EstimateBand(const Film& film, int y0, int y1, const NoisyPlane (&colours)[3],
                  NoisyPlane* variance, NoisyPicture* picture) {
  Band band(film.width, y0, y1);
  const auto width = static_cast<std::size_t>(film.width);
  std::vector<float> of_light(width * kBandRows);
  for (int y = y0; y < y1; ++y) std::fill_n(variance->at(0, y), width, 0.0f);
  for (int c = 0; c < 3; ++c) {
    const auto kept = [&](int y) { return &of_light[width * static_cast<std::size_t>(y - y0)]; };
    band.ForEachRow(picture->colour[c],
                    [&](int y, const float* row) { std::copy_n(row, width, kept(y)); });
    band.ForEachRow(colours[c], [&](int y, const float* row) {
      float* const sum = variance->at(0, y);
      for (int x = 0; x < film.width; ++x) {
        const float albedo = NoisyAlbedo(film, x, y, c);
        const float of_colour = row[x] / (albedo * albedo);
        sum[x] += std::min(of_colour, kept(y)[x]);
      }
    });
  }
}

}  // namespace

void EstimateNoise(const Film& film, int threads, NoisyPlane (&scratch)[3], NoisyPicture* picture) {
  // Colours that are not usable are replaced as their light was.
  ParallelFor(threads, static_cast<std::uint64_t>(film.height), [&](int /*worker*/, auto row) {
    const int y = static_cast<int>(row);
    for (int c = 0; c < 3; ++c) {
      for (int x = 0; x < film.width; ++x) {
        const float colour = film.pixel(x, y)[c], light = *picture->colour[c].at(x, y);
        const float albedo = NoisyAlbedo(film, x, y, c);
        *scratch[c].at(x, y) = colour / albedo == light ? colour : light * albedo;
      }
    }
  });
  for (NoisyPlane& plane : scratch) plane.RepeatEdges();
  const int bands = (film.height + kBandRows - 1) / kBandRows;
  ParallelFor(threads, static_cast<std::uint64_t>(bands), [&](int /*worker*/, auto band) {
    const int y0 = static_cast<int>(band) * kBandRows;
    EstimateBand(film, y0, std::min(y0 + kBandRows, film.height), scratch, &picture->mean_variance,
                 picture);
  });
  picture->mean_variance.RepeatEdges();
  MeanOfPatches(picture->mean_variance, film.width, film.height, threads, &picture->variance);
  picture->variance.RepeatEdges();
}

void MeanOfPatches(const NoisyPlane& from, int width, int height, int threads, NoisyPlane* to) {
  const std::ptrdiff_t stride = from.stride();
  ParallelFor(threads, static_cast<std::uint64_t>(height), [&](int /*worker*/, auto row) {
    const float* const middle = from.at(0, static_cast<int>(row));
    float* const means = to->at(0, static_cast<int>(row));
    for (int x = 0; x < width; ++x) {
      const auto column = [&](int i) {
        return (middle[i - stride] + middle[i]) + middle[i + stride];
      };
      means[x] = ((column(x - 1) + column(x)) + column(x + 1)) * (1.0f / 9);
    }
  });
}

}  // namespace sheaf
