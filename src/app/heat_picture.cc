#include "src/app/heat_picture.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "src/formats/picture.h"

namespace sheaf {
namespace {

using Heat = std::array<float, 3>;

// The value that a hundredth of the tiles exceed: a tile that another process interrupted would
// leave all others dark.
float UsualMost(const std::vector<TileCost>& tiles, std::size_t channel) {
  std::vector<float> values;
  for (const TileCost& cost : tiles) values.push_back(HeatOf(cost)[channel]);
  const auto at = values.begin() + static_cast<std::ptrdiff_t>((values.size() - 1) * 99 / 100);
  std::nth_element(values.begin(), at, values.end());
  return *at > 0 ? *at : 1;
}

}  // namespace

Status WriteHeatPicture(const RenderOptions& options, const RenderStats& stats,
                        const std::string& path) {
  std::vector<TileCost> tiles = stats.tiles;
  std::sort(tiles.begin(), tiles.end(), [](const TileCost& a, const TileCost& b) {
    return std::pair(a.tile.y0, a.tile.x0) < std::pair(b.tile.y0, b.tile.x0);
  });
  Heat scale = {1, 1, 1};
  if (!HoldsFloats(path)) {
    for (const std::size_t i : {0, 2}) scale[i] = 1 / UsualMost(tiles, i);
  }
  const PixelRect area = options.crop.value_or(PixelRect{0, 0, options.width, options.height});
  Result<PictureWriter> writer =
      PictureWriter::Create(path, area.width(), area.height(), Transfer::kLinear);
  if (!writer) return writer.error();
  Film row(area.width(), 1);
  for (auto tile = tiles.begin(); tile != tiles.end();) {
    const PixelRect first = tile->tile;
    for (; tile != tiles.end() && tile->tile.y0 == first.y0; ++tile) {
      const Heat heat = HeatOf(*tile);
      for (int x = tile->tile.x0; x < tile->tile.x1; ++x) {
        for (std::size_t i = 0; i < 3; ++i) row.pixel(x - area.x0, 0)[i] = heat[i] * scale[i];
      }
    }
    for (int y = first.y0; y < first.y1; ++y) {
      if (const Status written = writer.value().WriteRows(row); !written) return written;
    }
  }
  return writer.value().Finish();
}

}  // namespace sheaf
