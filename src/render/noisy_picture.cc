#include "src/render/noisy_picture.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "src/core/parallel.h"

namespace sheaf {
namespace {

// What may differ by one unit: albedo, normals, and depth as a share of itself.
constexpr float kAlbedoUnit = 0.02f, kNormalUnit = 0.1f, kDepthUnit = 0.02f;

constexpr float kApart = NoisyPicture::kApart;

bool IsUsable(const float* numbers, int count) {
  return std::all_of(numbers, numbers + count,
                     [](float number) { return std::abs(number) <= kApart; });  // not NaN
}

// Of one row of the picture.
class RowSplitter {
 public:
  RowSplitter(const Film& film, int y, NoisyPicture* picture)
      : film_(film), y_(y), picture_(*picture) {}

  void Split() {
    for (int x = 0; x < film_.width; ++x) {
      SplitColour(x);
      SplitGuides(x);
    }
  }

 private:
  // The colours of what is not usable are those of a neighbour: patches that it lies in are then as
  // if it were not there.
  void SplitColour(int x) {
    const bool is_usable = IsUsablePixel(x);
    const int from = is_usable                                     ? x
                     : x > 0 && IsUsablePixel(x - 1)               ? x - 1
                     : x < film_.width - 1 && IsUsablePixel(x + 1) ? x + 1
                                                                   : -1;
    for (int c = 0; c < 3; ++c) {
      *picture_.colour[c].at(x, y_) =
          from < 0 ? 0 : film_.pixel(from, y_)[c] / NoisyAlbedo(film_, from, y_, c);
    }
    *picture_.guide[0].at(x, y_) = is_usable ? GuideOf(Layer::kAlbedo, x, 0, kAlbedoUnit) : kApart;
  }

  void SplitGuides(int x) {
    for (int c = 1; c < 3; ++c) {
      *picture_.guide[c].at(x, y_) = GuideOf(Layer::kAlbedo, x, c, kAlbedoUnit);
    }
    for (int c = 0; c < 3; ++c) {
      *picture_.guide[3 + c].at(x, y_) = GuideOf(Layer::kNormal, x, c, kNormalUnit);
    }
    float nearness = 0;
    if (film_.has(Layer::kDepth)) {
      const float depth = *film_.at(Layer::kDepth, x, y_);
      if (depth > 0) nearness = std::min(1 / depth, kApart);  // not for NaN
    }
    *picture_.nearness.at(x, y_) = nearness;
    const float unit = nearness * kDepthUnit;
    *picture_.nearness_precision.at(x, y_) = 1 / (unit * unit + 1e-36f);
  }

  bool IsUsablePixel(int x) const {
    const bool has_depth =
        !film_.has(Layer::kDepth) || !std::isnan(*film_.at(Layer::kDepth, x, y_));
    return has_depth && IsUsable(film_.pixel(x, y_), 3) && IsUsableLayer(Layer::kAlbedo, x) &&
           IsUsableLayer(Layer::kNormal, x);
  }
  bool IsUsableLayer(Layer layer, int x) const {
    return !film_.has(layer) || IsUsable(film_.at(layer, x, y_), 3);
  }

  float GuideOf(Layer layer, int x, int channel, float unit) const {
    if (!film_.has(layer)) return 0;
    const float number = film_.at(layer, x, y_)[channel];
    return std::abs(number) <= kApart ? std::clamp(number / unit, -kApart, kApart) : 0.0f;
  }

  const Film& film_;
  const int y_;
  NoisyPicture& picture_;
};

// The smaller of the two differences to the neighbours, which is that on the pixel's own surface;
// at the picture's edge the only one.
float SlopeAt(const float* nearness, std::ptrdiff_t step, int i, int count) {
  const float before = nearness[0] - nearness[-step], after = nearness[step] - nearness[0];
  if (i == 0) return count == 1 ? 0.0f : after;
  if (i == count - 1) return before;
  return std::abs(before) < std::abs(after) ? before : after;
}

}  // namespace

void NoisyPlane::RepeatEdges() {
  for (int y = 0; y < height_; ++y) {
    std::fill_n(at(-kFilterMargin, y), kFilterMargin, *at(0, y));
    std::fill_n(at(width_, y), kFilterMargin, *at(width_ - 1, y));
  }
  for (int i = 1; i <= kFilterReach; ++i) {
    std::copy_n(at(-kFilterMargin, 0), stride_, at(-kFilterMargin, -i));
    std::copy_n(at(-kFilterMargin, height_ - 1), stride_, at(-kFilterMargin, height_ - 1 + i));
  }
}

void NoisyPlane::FillMargin(float value) {
  for (int y = 0; y < height_; ++y) {
    std::fill_n(at(-kFilterMargin, y), kFilterMargin, value);
    std::fill_n(at(width_, y), kFilterMargin, value);
  }
  for (int i = 1; i <= kFilterReach; ++i) {
    std::fill_n(at(-kFilterMargin, -i), stride_, value);
    std::fill_n(at(-kFilterMargin, height_ - 1 + i), stride_, value);
  }
}

NoisyView<float> NoisyPicture::ViewAt(int x, int y) const {
  NoisyView<float> view{};
  for (int c = 0; c < 3; ++c) view.colour[c] = colour[c].at(x, y);
  view.variance = variance.at(x, y);
  view.mean_variance = mean_variance.at(x, y);
  for (int i = 0; i < kGuideCount; ++i) view.guide[i] = guide[i].at(x, y);
  view.nearness = nearness.at(x, y);
  view.nearness_x = nearness_x.at(x, y);
  view.nearness_y = nearness_y.at(x, y);
  view.nearness_precision = nearness_precision.at(x, y);
  return view;
}

NoisyPicture SplitFilm(const Film& film, int threads) {
  NoisyPicture picture{film.width, film.height, {}, {}, {}, {}, {}, {}, {}, {}};
  const auto allocate = [&](NoisyPlane& plane) { plane.Allocate(film.width, film.height); };
  for (NoisyPlane& plane : picture.colour) allocate(plane);
  for (NoisyPlane& plane : picture.guide) allocate(plane);
  for (NoisyPlane* plane :
       {&picture.variance, &picture.mean_variance, &picture.nearness, &picture.nearness_x,
        &picture.nearness_y, &picture.nearness_precision}) {
    allocate(*plane);
  }
  const auto rows = static_cast<std::uint64_t>(film.height);
  ParallelFor(threads, rows, [&](int /*worker*/, std::uint64_t y) {
    RowSplitter(film, static_cast<int>(y), &picture).Split();
  });
  for (NoisyPlane& plane : picture.colour) plane.RepeatEdges();
  picture.guide[0].FillMargin(kApart);
  ParallelFor(threads, rows, [&](int /*worker*/, std::uint64_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < film.width; ++x) {
      const float* const nearness = picture.nearness.at(x, y);
      *picture.nearness_x.at(x, y) = SlopeAt(nearness, 1, x, film.width);
      *picture.nearness_y.at(x, y) = SlopeAt(nearness, picture.nearness.stride(), y, film.height);
    }
  });
  return picture;
}

}  // namespace sheaf
