// A picture of where a frame's time went, tile by tile.
#ifndef SHEAF_VIEW_HEAT_PICTURE_H_
#define SHEAF_VIEW_HEAT_PICTURE_H_

#include <array>
#include <string>
#include <vector>

#include "sheaf/error.h"
#include "sheaf/film.h"
#include "sheaf/render.h"
#include "src/view/show_layer.h"

namespace sheaf {

// Every pixel shows its tile: microseconds a pixel in red, the share of live lanes in green, rays a
// pixel in blue. A .pfm holds the numbers; elsewhere red and blue are parts of what one tile in a
// hundred exceeds, so that the picture is known when all tiles are.
class HeatPicture {
 public:
  explicit HeatPicture(const RenderOptions& options);

  // Keeps the heat layer of the frame's next rows, a whole number of tiles but for the last.
  void AddRows(const Film& rows);

  // After all rows.
  Status Write(const std::string& path) const;

  // What the channels are multiplied with: 1, or for a display as said above. After all rows.
  using Heat = std::array<float, 3>;
  Heat ScaleOf(LayerLook look) const;
  // Pixel row `y` of the picture, as wide as that: three numbers a pixel.
  void FillRow(int y, const Heat& scale, float* rgb) const;

 private:
  float UsualMost(std::size_t channel) const;
  std::size_t columns() const;

  PixelRect area_;
  int tile_size_;
  std::vector<Heat> tiles_;  // row by row
};

}  // namespace sheaf

#endif  // SHEAF_VIEW_HEAT_PICTURE_H_
