// A picture of where a frame's time went, tile by tile.
#ifndef SHEAF_APP_HEAT_PICTURE_H_
#define SHEAF_APP_HEAT_PICTURE_H_

#include <string>

#include "sheaf/error.h"
#include "sheaf/render.h"

namespace sheaf {

// Every pixel shows its tile: microseconds a pixel in red, the share of live lanes in green, rays a
// pixel in blue. A .pfm holds the numbers; elsewhere red and blue are parts of what one tile in a
// hundred exceeds. `stats` has the tiles of a whole frame of `options`.
Status WriteHeatPicture(const RenderOptions& options, const RenderStats& stats,
                        const std::string& path);

}  // namespace sheaf

#endif  // SHEAF_APP_HEAT_PICTURE_H_
