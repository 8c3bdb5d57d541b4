#include "src/app/denoised_rows.h"

#include <algorithm>

#include "src/app/choose.h"

namespace sheaf {
namespace {

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

RenderOptions DenoisedRows::Widen(RenderOptions options) {
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

DenoisedRows::DenoisedRows(const RenderOptions& options, DenoiseFilter filter)
    : options_(options),
      filter_(filter),
      asked_(AreaOf(options)),
      rendered_(AreaOf(Widen(options))) {
  film_.Resize(rendered_.width(), rendered_.height(), Widen(options).layers);
}

void DenoisedRows::AddRows(const Film& rows) {
  for (int y = 0; y < rows.height; ++y) CopyPixels(rows, 0, y, rows.width, film_, rows_++);
}

Result<Film> DenoisedRows::Finish() {
  // Precision is of rendering; the filter has one arithmetic.
  Result<Film> denoised = Denoise(film_, {options_.target, options_.threads, filter_});
  if (!denoised || !options_.crop) return denoised;
  const Film& whole = denoised.value();
  Film asked(asked_.width(), asked_.height(), whole.held_layers());
  for (int y = 0; y < asked.height; ++y) {
    CopyPixels(whole, asked_.x0 - rendered_.x0, asked_.y0 - rendered_.y0 + y, asked.width, asked,
               y);
  }
  return asked;
}

}  // namespace sheaf
