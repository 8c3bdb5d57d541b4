// Numbers of scenes on their way to those of kernels.
#ifndef SHEAF_RENDER_COMPILE_VALUES_H_
#define SHEAF_RENDER_COMPILE_VALUES_H_

#include <cmath>
#include <glm/vec3.hpp>

#include "src/core/vec3.h"

namespace sheaf {

template <typename Real>
void Store(const glm::dvec3& from, Real (&to)[3]) {
  // Adding 0 turns -0 into 0, so that no sum of colours depends on where it starts.
  for (int i = 0; i < 3; ++i) to[i] = static_cast<Real>(from[i]) + Real(0);
}

inline Vec3<double> ToVec3(const glm::dvec3& v) { return {v.x, v.y, v.z}; }
inline glm::dvec3 ToGlm(const Vec3<double>& v) { return {v.x, v.y, v.z}; }

// GLM's own normalize multiplies by an inverse square root, whose bits are its business.
inline glm::dvec3 Unit(const glm::dvec3& v) { return ToGlm(Normalize(ToVec3(v))); }
inline glm::dvec3 CrossOf(const glm::dvec3& a, const glm::dvec3& b) {
  return ToGlm(Cross(ToVec3(a), ToVec3(b)));
}
inline double LengthOf(const glm::dvec3& v) { return std::sqrt(Dot(ToVec3(v), ToVec3(v))); }

}  // namespace sheaf

#endif  // SHEAF_RENDER_COMPILE_VALUES_H_
