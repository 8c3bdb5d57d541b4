// Which floats the corners of huge flat shapes become.
//
// The float nearest to a corner at 1e7 lies up to half a unit off, and takes the ground under the
// eye with it. Other floats there lie far nearer to the plane: the outline of so large a shape may
// give way a little, where its plane may not (docs/numerics.md).
#ifndef SHEAF_RENDER_ROUND_CORNERS_H_
#define SHEAF_RENDER_ROUND_CORNERS_H_

#include <cstdint>
#include <map>
#include <vector>

#include "sheaf/scene.h"
#include "src/render/place_scene.h"
#include "src/scene/shapes.h"

namespace sheaf {

// Moves the origin by less than the spacing of floats out there, so that a corner of the largest
// shape that rounding would take off its plane is a float. Where a plane's slope is a ratio of
// small whole numbers, no other float near it is closer to it than the nearest.
void FitCorner(const Scene& scene, ScenePlacement& placement);

// The triangles, where they are placed, of quads and triangles with a corner that is better not
// rounded to the nearest float; by the index of their object. Their corners are floats. A corner
// that another shape has too stays where it is, because what touches has to stay closed.
std::map<std::uint32_t, std::vector<ShapePrimitive>> RoundCorners(const Scene& scene,
                                                                  const ScenePlacement& placement);

}  // namespace sheaf

#endif  // SHEAF_RENDER_ROUND_CORNERS_H_
