// Whether a triangle has an area: three points of a line have no normal, and no ray may hit them.
#ifndef SHEAF_CORE_HAS_AREA_H_
#define SHEAF_CORE_HAS_AREA_H_

#include <algorithm>
#include <cmath>

namespace sheaf {

// Twice the area as a vector along the normal, in double from the coordinates of vertices, which
// are floats or rounded to what they are traced as.
struct AreaVector {
  double x, y, z;

  explicit AreaVector(const double (&vertex)[3][3]) {
    double a[3], b[3];
    for (int axis = 0; axis < 3; ++axis) {
      a[axis] = vertex[1][axis] - vertex[0][axis];
      b[axis] = vertex[2][axis] - vertex[0][axis];
    }
    x = a[1] * b[2] - a[2] * b[1];
    y = a[2] * b[0] - a[0] * b[2];
    z = a[0] * b[1] - a[1] * b[0];
  }
};

// False for NaN.
inline bool HasArea(const double (&vertex)[3][3]) {
  const AreaVector area(vertex);
  return std::abs(area.x) + std::abs(area.y) + std::abs(area.z) > 0;
}

// Twice the area as seen along the axis that shows most of it.
inline double LargestArea(const double (&vertex)[3][3]) {
  const AreaVector area(vertex);
  return std::max({std::abs(area.x), std::abs(area.y), std::abs(area.z)});
}

}  // namespace sheaf

#endif  // SHEAF_CORE_HAS_AREA_H_
