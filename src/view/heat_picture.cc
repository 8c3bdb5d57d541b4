#include "src/view/heat_picture.h"

#include <algorithm>
#include <cstddef>

#include "src/formats/picture.h"
#include "src/render/check_options.h"

namespace sheaf {

HeatPicture::HeatPicture(const RenderOptions& options)
    : area_(AreaOf(options)), tile_size_(options.tile_size) {}

void HeatPicture::AddRows(const Film& rows) {
  for (int y = 0; y < rows.height; y += tile_size_) {
    for (int x = 0; x < rows.width; x += tile_size_) {
      const float* heat = rows.at(Layer::kHeat, x, y);
      tiles_.push_back({heat[0], heat[1], heat[2]});
    }
  }
}

// The value that a hundredth of the tiles exceed: a tile that another process interrupted would
// leave all others dark.
float HeatPicture::UsualMost(std::size_t channel) const {
  std::vector<float> values;
  for (const Heat& heat : tiles_) values.push_back(heat[channel]);
  const auto at = values.begin() + static_cast<std::ptrdiff_t>((values.size() - 1) * 99 / 100);
  std::nth_element(values.begin(), at, values.end());
  return *at > 0 ? *at : 1;
}

std::size_t HeatPicture::columns() const {
  return static_cast<std::size_t>((area_.width() + tile_size_ - 1) / tile_size_);
}

HeatPicture::Heat HeatPicture::ScaleOf(LayerLook look) const {
  if (look == LayerLook::kNumbers) return {1, 1, 1};
  return {1 / UsualMost(0), 1, 1 / UsualMost(2)};
}

void HeatPicture::FillRow(int y, const Heat& scale, float* rgb) const {
  const Heat* tiles = &tiles_[static_cast<std::size_t>(y / tile_size_) * columns()];
  for (int x = 0; x < area_.width(); ++x) {
    const Heat& heat = tiles[x / tile_size_];
    for (std::size_t i = 0; i < 3; ++i) *rgb++ = heat[i] * scale[i];
  }
}

Status HeatPicture::Write(const std::string& path) const {
  const Heat scale = ScaleOf(HoldsFloats(path) ? LayerLook::kNumbers : LayerLook::kDisplay);
  PictureSpec spec = WholePicture(area_.width(), area_.height(), Transfer::kLinear);
  spec.values = Values::kNumbers;
  Result<PictureWriter> writer = PictureWriter::Create(path, spec);
  if (!writer) return writer.error();
  Film row(area_.width(), 1);
  for (int y = 0; y < area_.height(); ++y) {
    FillRow(y, scale, row.pixel(0, 0));
    if (const Status written = writer.value().WriteRows(row); !written) return written;
  }
  return writer.value().Finish();
}

}  // namespace sheaf
