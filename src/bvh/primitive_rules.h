// What each kind of primitive may be made of, which of them no ray can hit, and what contains them.
#ifndef SHEAF_BVH_PRIMITIVE_RULES_H_
#define SHEAF_BVH_PRIMITIVE_RULES_H_

#include <algorithm>
#include <cmath>
#include <limits>

#include "simd/primitives.h"
#include "src/bvh/round_outward.h"
#include "src/core/has_area.h"

namespace sheaf::bvh {

template <typename Real>
bool AreFinite(const Real* x, std::size_t count) {
  return std::all_of(x, x + count, [](Real value) { return std::isfinite(value); });
}

// The rules of a kind. They take the fields of one primitive, in the order of its arrays'
// ForEachField.
//   Fault: "", or what is wrong with numbers that a user gave.
//   IsHittable: false for a triangle without area, a sphere or disk of radius 0: what no ray may
//   hit. kMarkedField: which is NaN in the arrays of what is not hittable. kLengths: so many of the
//   fields, the first ones, are lengths. ExactBounds: along an axis, of finite fields, rounded
//   outward.
template <PrimitiveKind kKind>
struct Rules;

template <>
struct Rules<PrimitiveKind::kTriangle> {
  static constexpr int kMarkedField = 0, kLengths = 9;

  template <typename Real>
  static const char* Fault(const Real* vertices) {
    return AreFinite(vertices, 9) ? "" : "a coordinate is not finite";
  }
  template <typename Real>
  static bool IsHittable(const Real* vertices) {
    double exact[3][3];
    Widen(vertices, exact);
    return HasArea(exact);
  }
  template <typename Real>
  static void Widen(const Real* vertices, double (&exact)[3][3]) {
    for (int i = 0; i < 9; ++i) exact[i / 3][i % 3] = static_cast<double>(vertices[i]);
  }
  template <typename Real>
  static void ExactBounds(const Real* vertices, int axis, float& lower, float& upper) {
    const Real a = vertices[axis], b = vertices[3 + axis], c = vertices[6 + axis];
    lower = RoundDown(static_cast<double>(std::min(std::min(a, b), c)));
    upper = RoundUp(static_cast<double>(std::max(std::max(a, b), c)));
  }
};

template <>
struct Rules<PrimitiveKind::kSphere> {
  static constexpr int kMarkedField = 3, kLengths = 4;

  template <typename Real>
  static const char* Fault(const Real* sphere) {
    return !AreFinite(sphere, 3)       ? "a coordinate is not finite"
           : !std::isfinite(sphere[3]) ? "the radius is not finite"
           : sphere[3] < 0             ? "the radius is negative"
                                       : "";
  }
  template <typename Real>
  static bool IsHittable(const Real* sphere) {
    return sphere[3] > 0;
  }
  template <typename Real>
  static void ExactBounds(const Real* sphere, int axis, float& lower, float& upper) {
    const double center = static_cast<double>(sphere[axis]);
    const double radius = std::abs(static_cast<double>(sphere[3]));
    lower = RoundDown(-SumUp(-center, radius));
    upper = RoundUp(SumUp(center, radius));
  }
};

template <>
struct Rules<PrimitiveKind::kDisk> {
  static constexpr int kMarkedField = 3, kLengths = 4;

  template <typename Real>
  static const char* Fault(const Real* disk) {
    return !AreFinite(disk, 3)                            ? "a coordinate is not finite"
           : !std::isfinite(disk[3])                      ? "the radius is not finite"
           : disk[3] < 0                                  ? "the radius is negative"
           : !AreFinite(disk + 4, 3)                      ? "the normal is not finite"
           : disk[4] == 0 && disk[5] == 0 && disk[6] == 0 ? "the normal is 0"
                                                          : "";
  }
  template <typename Real>
  static bool IsHittable(const Real* disk) {
    return disk[3] > 0 && (disk[4] != 0 || disk[5] != 0 || disk[6] != 0);
  }
  template <typename Real>
  static void ExactBounds(const Real* disk, int axis, float& lower, float& upper) {
    // Along axis k the disk reaches r times the sine of the normal's angle with k. The factor
    // covers the rounding of that.
    const auto square = [&](int k) {
      const double n = static_cast<double>(disk[4 + k % 3]);
      return n * n;
    };
    const double across = square(axis + 1) + square(axis + 2);
    const double sine = std::sqrt(across / (across + square(axis)));
    const double center = static_cast<double>(disk[axis]);
    const double reach = std::abs(static_cast<double>(disk[3])) * sine * (1 + 0x1p-48);
    lower = RoundDown(-SumUp(-center, reach));
    upper = RoundUp(SumUp(center, reach));
  }
};

template <PrimitiveKind kKind, typename Real>
void MarkNeverHit(Real* fields) {
  fields[Rules<kKind>::kMarkedField] = std::numeric_limits<Real>::quiet_NaN();
}

// Marks a primitive that no ray can hit; returns whether one can.
template <PrimitiveKind kKind, typename Real>
bool MarkUnlessHittable(Real* fields) {
  const bool is_hittable = Rules<kKind>::IsHittable(fields);
  if (!is_hittable) MarkNeverHit<kKind>(fields);
  return is_hittable;
}

}  // namespace sheaf::bvh

#endif  // SHEAF_BVH_PRIMITIVE_RULES_H_
