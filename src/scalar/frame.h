// Axes around a direction.
#ifndef SHEAF_SCALAR_FRAME_H_
#define SHEAF_SCALAR_FRAME_H_

#include <cmath>

#include "src/core/vec3.h"

namespace sheaf::scalar {

// Two unit vectors that make a right-handed frame with the unit vector n: Duff et al., "Building an
// Orthonormal Basis, Revisited" (JCGT 6(1), 2017).
template <typename W>
struct Frame {
  Vec3<W> x, y;

  explicit Frame(Vec3<W> n) {
    const W sign = std::copysign(W(1), n.z);
    const W a = -1 / (sign + n.z);
    const W b = (n.x * n.y) * a;
    x = {1 + sign * ((n.x * n.x) * a), sign * b, -(sign * n.x)};
    y = {b, sign + (n.y * n.y) * a, -n.y};
  }
};

}  // namespace sheaf::scalar

#endif  // SHEAF_SCALAR_FRAME_H_
