#include "src/app/denoised_rows.h"

#include <algorithm>
#include <utility>

#include "src/render/check_options.h"

namespace sheaf {
namespace {

RenderOptions Widen(RenderOptions options) {
  for (const Layer layer : {Layer::kAlbedo, Layer::kNormal, Layer::kDepth}) {
    options.layers.Add(layer);
  }
  if (options.crop) {
    PixelRect& crop = *options.crop;
    crop.x0 = std::max(crop.x0 - kDenoiseReach, 0);
    crop.y0 = std::max(crop.y0 - kDenoiseReach, 0);
    crop.x1 = std::min(crop.x1 + kDenoiseReach, options.width);
    crop.y1 = std::min(crop.y1 + kDenoiseReach, options.height);
  }
  return options;
}

// Copies `count` pixels with their layers, as far as both have them.
void CopyPixels(const Film& from, int from_x, int from_y, int count, Film& to, int to_y) {
  std::copy_n(from.pixel(from_x, from_y), 3 * count, to.pixel(0, to_y));
  for (int i = 0; i < kLayerCount; ++i) {
    const Layer layer = static_cast<Layer>(i);
    if (!from.has(layer) || !to.has(layer)) continue;
    std::copy_n(from.at(layer, from_x, from_y), kLayerChannels[i] * count, to.at(layer, 0, to_y));
  }
}

}  // namespace

DenoisedRows::DenoisedRows(const RenderOptions& options, std::optional<DenoiseFilter> filter,
                           RowSink sink)
    : options_(options),
      filter_(filter),
      sink_(std::move(sink)),
      work_(filter ? Widen(options) : options) {
  if (filter_) film_.Resize(AreaOf(work_).width(), AreaOf(work_).height(), work_.layers);
}

Status DenoisedRows::Write(const Film& rows) {
  if (!filter_) return sink_(rows);
  for (int y = 0; y < rows.height; ++y) CopyPixels(rows, 0, y, rows.width, film_, rows_++);
  return Done{};
}

Status DenoisedRows::Finish() {
  if (!filter_) return Done{};
  const Result<Film> denoised = Denoise(film_, {options_.target, options_.threads, *filter_});
  if (!denoised) return denoised.error();
  if (!options_.crop) return sink_(denoised.value());
  const PixelRect asked = AreaOf(options_), rendered = AreaOf(work_);
  Film rows(asked.width(), asked.height(), work_.layers);
  for (int y = 0; y < rows.height; ++y) {
    CopyPixels(denoised.value(), asked.x0 - rendered.x0, asked.y0 - rendered.y0 + y, rows.width,
               rows, y);
  }
  return sink_(rows);
}

}  // namespace sheaf
