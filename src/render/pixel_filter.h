// Where samples lie that weigh what is around a pixel.
#ifndef SHEAF_RENDER_PIXEL_FILTER_H_
#define SHEAF_RENDER_PIXEL_FILTER_H_

#include "sheaf/scene.h"

namespace sheaf {

// Where along a pixel's axis, 0 and 1 being its edges, `share` in [0, 1] of the filter's weight
// lies before. Correctly rounded operations alone, so the same bits everywhere.
double FilterPlace(PixelFilter filter, double share);

}  // namespace sheaf

#endif  // SHEAF_RENDER_PIXEL_FILTER_H_
