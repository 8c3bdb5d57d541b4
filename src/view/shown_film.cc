#include "src/view/shown_film.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "src/core/parallel.h"
#include "src/formats/quantize.h"
#include "src/scene/develop.h"
#include "src/view/heat_picture.h"
#include "src/view/show_layer.h"

namespace sheaf {
namespace {

bool IsHeat(Shown shown) { return shown == Shown::kHeat || shown == Shown::kLanes; }

// Numbers are shown as they are; colours go through the scene's transfer.
bool IsLight(Shown shown) { return shown == Shown::kColour || shown == Shown::kAlbedo; }

Film Scaled(const Film& from, int width, int height) {
  Film film(width, height);
  for (int y = 0; y < height; ++y) {
    const int from_y = static_cast<int>(std::int64_t{y} * from.height / height);
    for (int x = 0; x < width; ++x) {
      const int from_x = static_cast<int>(std::int64_t{x} * from.width / width);
      std::copy_n(from.pixel(from_x, from_y), 3, film.pixel(x, y));
    }
  }
  return film;
}

}  // namespace

void ShownFilm::Begin(const ViewRequest& request, int width, int height) {
  const bool is_other_kind = shown_ != request.shown;
  shown_ = request.shown;
  development_ = request.development;
  transfer_ = request.scene->settings.transfer;
  threads_ = request.threads;
  if (shown_ == Shown::kDepth) far_ = FarthestDepth(*request.scene, request.camera);
  if (IsHeat(shown_)) {
    Layers heat;
    heat.Add(Layer::kHeat);
    heat_.Resize(width, height, heat);
  }
  if (film_.width == width && film_.height == height && !is_other_kind) return;
  if (film_.pixel_count() == 0 || is_other_kind) {
    film_ = Film(width, height);
    std::fill(film_.rgb.begin(), film_.rgb.end(), 0.0f);
  } else {
    film_ = Scaled(film_, width, height);
  }
  bytes_.resize(film_.rgb.size());
  Quantize({0, 0, width, height});
}

void ShownFilm::AddRows(const Film& rows, int x, int y) {
  if (IsHeat(shown_)) {
    for (int row = 0; row < rows.height; ++row) {
      const std::size_t floats = 3 * static_cast<std::size_t>(rows.width);
      std::copy_n(rows.at(Layer::kHeat, 0, row), floats, heat_.at(Layer::kHeat, x, y + row));
    }
    return;
  }
  const std::optional<Layer> layer = LayerOf(shown_);
  const Film made = layer ? ShowLayer(rows, *layer, LayerLook::kDisplay, far_) : Film();
  const Film& colours = layer ? made : rows;
  for (int row = 0; row < rows.height; ++row) {
    std::copy_n(colours.pixel(0, row), 3 * static_cast<std::size_t>(rows.width),
                film_.pixel(x, y + row));
  }
  Quantize({x, y, x + rows.width, y + rows.height});
}

void ShownFilm::Finish() {
  if (!IsHeat(shown_)) return;
  RenderOptions options;
  options.width = film_.width;
  options.height = film_.height;
  HeatPicture heat(options);
  heat.AddRows(heat_);
  const HeatPicture::Heat scale = heat.ScaleOf(LayerLook::kDisplay);
  for (int y = 0; y < film_.height; ++y) {
    float* const row = film_.pixel(0, y);
    heat.FillRow(y, scale, row);
    if (shown_ == Shown::kHeat) continue;
    for (int x = 0; x < film_.width; ++x) std::fill_n(row + 3 * x, 3, row[3 * x + 1]);
  }
  Quantize({0, 0, film_.width, film_.height});
}

void ShownFilm::Develop(const Development& development) {
  if (development == development_) return;
  development_ = development;
  Quantize({0, 0, film_.width, film_.height});
}

void ShownFilm::Quantize(const PixelRect& rect) {
  const bool develops = shown_ == Shown::kColour && development_ != Development();
  const Transfer transfer = IsLight(shown_) ? transfer_ : Transfer::kLinear;
  constexpr int kRows = 16;  // an item
  const auto items = static_cast<std::uint64_t>((rect.height() + kRows - 1) / kRows);
  ParallelFor(ThreadCount(threads_), items, [&](int, std::uint64_t item) {
    const int first = rect.y0 + static_cast<int>(item) * kRows;
    for (int y = first; y < std::min(first + kRows, rect.y1); ++y) {
      const std::size_t count = 3 * static_cast<std::size_t>(rect.width());
      const float* row = film_.pixel(rect.x0, y);
      Film developed;
      if (develops) {
        developed = Film(rect.width(), 1);
        std::copy_n(row, count, developed.pixel(0, 0));
        sheaf::Develop(development_.ev, development_.tone, developed);
        row = developed.pixel(0, 0);
      }
      QuantizeRowTo8Bit(row, count, transfer, &bytes_[3 * film_.index(rect.x0, y)]);
    }
  });
}

Status ShownFilm::Write(const std::string& path, const PictureMetadata& metadata) const {
  PictureSpec spec = WholePicture(film_.width, film_.height, transfer_);
  if (shown_ == Shown::kColour) {
    spec.ev = development_.ev;
    spec.tone = development_.tone;
  }
  if (!IsLight(shown_)) spec.values = Values::kNumbers;
  spec.metadata = metadata;
  return WritePicture(film_, spec, path);
}

}  // namespace sheaf
