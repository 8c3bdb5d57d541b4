// What a pixel shows, and the ray that found it.
#ifndef SHEAF_VIEW_PICK_H_
#define SHEAF_VIEW_PICK_H_

#include <optional>
#include <string>
#include <vector>

#include "sheaf/error.h"
#include "sheaf/stats.h"
#include "src/view/view_frame.h"

namespace sheaf {

struct Pick {
  int x = 0, y = 0;                   // the pixel
  std::optional<std::size_t> object;  // of the scene; nothing: the background
  std::string object_name, material_name;
  double distance = 0;  // from the ray's origin, in the scene's unit: its t
  Vec3d point{0.0}, normal{0.0}, albedo{0.0}, colour{0.0};
  RayCounts rays;   // of the pixel at one sample
  std::string ray;  // as `sheaf stress --replay` takes it, in the coordinates that are computed in
};

// Renders pixel (x, y) of the request's picture, with one sample.
Result<Pick> PickPixel(const ViewRequest& request, int x, int y);

// The same as lines for a person.
std::vector<std::string> LinesOf(const Pick& pick);

}  // namespace sheaf

#endif  // SHEAF_VIEW_PICK_H_
