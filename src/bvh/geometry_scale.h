// At which scale the triangles of a geometry can be tested: a power of two, which rounds nothing.
//
// An edge function is a product of two lengths. Where lengths are large it overflows; where they
// are small the determinant is a denormal, which counts as 0. So a geometry that lies beyond is
// traced at another scale, and its rays with it: t, u and v stay what they are (docs/numerics.md).
#ifndef SHEAF_BVH_GEOMETRY_SCALE_H_
#define SHEAF_BVH_GEOMETRY_SCALE_H_

#include <algorithm>
#include <cmath>
#include <limits>

#include "src/core/has_area.h"

namespace sheaf {

// Exponents of two. Rays start up to 2^5 times as far away as kReach, whose products still fit.
template <typename Real>
struct ScaleLimits;
template <>
struct ScaleLimits<float> {
  static constexpr int kReach = 56;     // of coordinates below
  static constexpr int kArea = -102;    // wanted of areas: down to grazing angles of 2^-24
  static constexpr int kNoArea = -125;  // an area below this is never hit
  static constexpr int kLargest = 64;   // of the scale itself, so that directions stay in range
};
template <>
struct ScaleLimits<double> {
  // So that surfaces too, which square areas, stay in range.
  static constexpr int kReach = 250, kArea = -500, kNoArea = -530, kLargest = 480;
};

inline constexpr int kBoxReach = 35;  // box tests hold up to 2^39

// How large triangles are that can be hit.
struct TriangleSizes {
  double reach = 0;                                             // the largest coordinate
  double least_area = std::numeric_limits<double>::infinity();  // along an axis, twice the area

  void Include(const double (&vertex)[3][3]) {
    for (const auto& point : vertex) {
      for (const double x : point) reach = std::max(reach, std::abs(x));
    }
    least_area = std::min(least_area, LargestArea(vertex));
  }
  void Include(const TriangleSizes& other) {
    reach = std::max(reach, other.reach);
    least_area = std::min(least_area, other.least_area);
  }
};

// The exponent of the scale that triangles of these sizes are tested at, as near to 0 as will do.
// What is large comes down to kReach; what is small grows to 1 at most, so that a speck in a scene
// of everyday size does not send the rest to the limits of boxes.
template <typename Real>
int ScaleExponent(const TriangleSizes& sizes) {
  using Limits = ScaleLimits<Real>;
  if (sizes.reach == 0) return 0;
  const int size = std::ilogb(sizes.reach);
  const bool is_small = sizes.least_area < std::ldexp(1.0, Limits::kArea);
  const int missing = Limits::kArea - std::ilogb(std::min(sizes.least_area, 0x1p1000));
  if (size >= Limits::kReach) {
    // All the way to where box tests hold, unless small triangles would lose their areas there.
    const int wanted = std::max(kBoxReach - size, (missing + 1) / 2);
    return std::min(Limits::kReach - 1 - size, wanted);
  }
  if (size >= 0 || !is_small) return 0;
  return std::min({(missing + 1) / 2, -size, Limits::kLargest});
}

// Whether a triangle of this area, at this scale, is one that no ray can hit.
template <typename Real>
bool HasNoAreaAt(double area, int exponent) {
  return area < std::ldexp(1.0, ScaleLimits<Real>::kNoArea - 2 * exponent);
}

}  // namespace sheaf

#endif  // SHEAF_BVH_GEOMETRY_SCALE_H_
