// Whether a triangle has an area: three points of a line have no normal, and no ray may hit them.
#ifndef SHEAF_CORE_HAS_AREA_H_
#define SHEAF_CORE_HAS_AREA_H_

namespace sheaf {

// As computed in double from the coordinates of its vertices, which are floats or rounded to what
// they are traced as. False for NaN.
inline bool HasArea(const double (&vertex)[3][3]) {
  double a[3], b[3];
  for (int axis = 0; axis < 3; ++axis) {
    a[axis] = vertex[1][axis] - vertex[0][axis];
    b[axis] = vertex[2][axis] - vertex[0][axis];
  }
  const double x = a[1] * b[2] - a[2] * b[1];
  const double y = a[2] * b[0] - a[0] * b[2];
  const double z = a[0] * b[1] - a[1] * b[0];
  return x * x + y * y + z * z > 0;
}

}  // namespace sheaf

#endif  // SHEAF_CORE_HAS_AREA_H_
