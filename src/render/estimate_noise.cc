#include "src/render/estimate_noise.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "simd/streams.h"
#include "src/core/parallel.h"

namespace sheaf {
namespace {

// Blocks of a median: those that begin from kFirst to kLast pixels after the pixel, each way.
constexpr int kFirst = -3, kLast = 2, kBlocks = kLast - kFirst + 1;
constexpr int kBandRows = 16;

// Finds the medians of a band of rows.
class Band {
 public:
  Band(FindMediansKernel<float>* find_medians, int width, int y0, int y1)
      : find_medians_(find_medians),
        width_(static_cast<std::uint32_t>(width)),
        stride_(PaddedCount(width_)),
        y0_(y0),
        y1_(y1),
        blocks_(stride_ + kMaxLanes),
        medians_(std::size_t{stride_} * (kBandRows + kBlocks - 1)) {}

  // Calls use(y, variances), where one number belongs to each pixel of the row.
  template <typename Use>
  void ForEachRow(const NoisyPlane& plane, Use use) {
    for (int y = y0_ + kFirst; y < y1_ + kLast; ++y) FindAcross(plane, y);
    constexpr float kOverMedian = 1 / 0.6745f;
    for (int y = y0_; y < y1_; ++y) {
      float* const row = MediansOf(y + kFirst);  // which is not needed any more
      find_medians_(row, stride_, width_, row);
      for (std::uint32_t x = 0; x < width_; ++x) {
        const float deviation = row[x] * kOverMedian;
        row[x] = deviation * deviation;
      }
      use(y, row);
    }
  }

 private:
  // The medians of one row's blocks.
  void FindAcross(const NoisyPlane& plane, int y) {
    const float* const above = plane.at(kFirst, y);
    const float* const below = plane.at(kFirst, y + 1);
    for (std::uint32_t x = 0; x < width_ + kBlocks - 1; ++x) {
      blocks_[x] = std::abs(((above[x] - above[x + 1]) - below[x]) + below[x + 1]) * 0.5f;
    }
    find_medians_(blocks_.data(), 1, width_, MediansOf(y));
  }
  float* MediansOf(int y) {
    return medians_.data() + static_cast<std::ptrdiff_t>(stride_) * (y - y0_ - kFirst);
  }

  FindMediansKernel<float>* const find_medians_;
  const std::uint32_t width_, stride_;
  const int y0_, y1_;
  std::vector<float> blocks_, medians_;  // padded
};

// Of the rows of `band`, from y0 to y1.
void EstimateBand(const Film& film, Band& band, int y0, int y1, const NoisyPlane (&colours)[3],
                  NoisyPicture* picture) {
  const auto width = static_cast<std::size_t>(film.width);
  std::vector<float> of_light(width * kBandRows);
  for (int y = y0; y < y1; ++y) std::fill_n(picture->mean_variance.at(0, y), width, 0.0f);
  for (int c = 0; c < 3; ++c) {
    const auto kept = [&](int y) { return &of_light[width * static_cast<std::size_t>(y - y0)]; };
    band.ForEachRow(picture->colour[c],
                    [&](int y, const float* row) { std::copy_n(row, width, kept(y)); });
    band.ForEachRow(colours[c], [&](int y, const float* row) {
      float* const sum = picture->mean_variance.at(0, y);
      for (int x = 0; x < film.width; ++x) {
        const float albedo = NoisyAlbedo(film, x, y, c);
        const float of_colour = row[x] / (albedo * albedo);
        sum[x] += std::min(of_colour, kept(y)[x]);
      }
    });
  }
}

}  // namespace

void EstimateNoise(const Film& film, FindMediansKernel<float>* find_medians, int threads,
                   NoisyPlane (&scratch)[3], NoisyPicture* picture) {
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
    const int y1 = std::min(y0 + kBandRows, film.height);
    Band rows(find_medians, film.width, y0, y1);
    EstimateBand(film, rows, y0, y1, scratch, picture);
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
