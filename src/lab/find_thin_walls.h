// Glass that is thinner than strict arithmetic can tell.
#ifndef SHEAF_LAB_FIND_THIN_WALLS_H_
#define SHEAF_LAB_FIND_THIN_WALLS_H_

#include <cstddef>
#include <vector>

#include "sheaf/scene.h"

namespace sheaf {

// Where an object's glass is thinnest against what a ray needs that enters there: the offsets of
// docs/numerics.md. Lengths are the scene's.
struct ThinWall {
  std::size_t object;
  double thickness, needed;
};

// At most one an object, in their order. Looks along the inward normal, at the middle of each
// triangle and disk and at 26 points of each sphere. The scene is valid.
std::vector<ThinWall> FindThinWalls(const Scene& scene);

}  // namespace sheaf

#endif  // SHEAF_LAB_FIND_THIN_WALLS_H_
