// A ray as box tests see it.
//
// Slabs after Kay and Kajiya, conservative after Ize, "Robust BVH Ray Traversal" (JCGT 2013): a box
// that holds a primitive is never missed by a ray that hits it, as computed. Different from the
// paper: no component of a direction is zero here (docs/numerics.md), so that no NaN appears, and
// the origin moves by its own rounding error, so that plane * scale + offset may be fused or not.
#ifndef SHEAF_SCALAR_RAY_SLABS_H_
#define SHEAF_SCALAR_RAY_SLABS_H_

#include <algorithm>
#include <cmath>

#include "simd/tree.h"
#include "src/scalar/ray.h"

namespace sheaf::scalar {

// The ray meets the plane p of `axis` at p * scale + offset: an `enter` offset for the planes where
// it enters boxes, which bends the result down, and a `leave` offset, which bends it up.
template <typename Real>
struct RaySlabs {
  Real scale[3], enter[3], leave[3];
  int enter_row[3], leave_row[3];  // of TreeNode::bounds
  int octant;
};

template <typename Real>
Real LargestComponent(Vec3<Real> a) {
  return std::max(std::max(std::abs(a.x), std::abs(a.y)), std::abs(a.z));
}

// Whether box tests in Real hold for the ray. Others take them in double: WideSlabsOf.
template <typename Real>
bool FitsBoxes(const Ray<Real>& ray) {
  const Real size = LargestComponent(ray.direction);
  return LargestComponent(ray.origin) <= kMaxBoxCoordinate && size >= kMinBoxDirection &&
         size <= kMaxBoxDirection && ray.t_min >= 0;
}

// Whether they hold in double.
template <typename Real>
bool FitsWideBoxes(const Ray<Real>& ray) {
  const double size = static_cast<double>(LargestComponent(ray.direction));
  return LargestComponent(ray.origin) <= kMaxBoxCoordinate && size >= kMinWideDirection &&
         size <= kMaxWideDirection;
}

// `Real` is that of the slabs, `Tree` anything with `lower` and `upper`. Boxes give way by the part
// `give` of the ray's reach besides.
template <typename Real, typename Tree>
RaySlabs<Real> SlabsOf(const Tree& tree, const Ray<Real>& ray, Real give = 0) {
  const Real least = LargestComponent(ray.direction) * Real(kMinBoxSlope);
  Real reach = 0;
  for (int axis = 0; axis < 3; ++axis) {
    reach = std::max({reach, Real(tree.upper[axis]) - ray.origin[axis],
                      ray.origin[axis] - Real(tree.lower[axis])});
  }
  RaySlabs<Real> box{};
  for (int axis = 0; axis < 3; ++axis) {
    const Real o = ray.origin[axis], d = ray.direction[axis];
    const bool backward = std::signbit(d), steep = std::abs(d) < least;
    Real slack = std::abs(o) * Real(kBoxOriginSlack) + Real(kBoxAbsoluteSlack);
    if (steep) slack += reach * Real(2 * kMinBoxSlope);
    if (give > 0) slack += reach * give;
    if (backward) slack = -slack;
    box.scale[axis] = 1 / (steep ? std::copysign(least, d) : d);
    box.enter[axis] = -((o + slack) * box.scale[axis]);
    box.leave[axis] = -((o - slack) * box.scale[axis]);
    box.enter_row[axis] = backward ? axis + 3 : axis;
    box.leave_row[axis] = backward ? axis : axis + 3;
    box.octant |= int{backward} << axis;
  }
  return box;
}

// The slabs in double of a ray that FitsWideBoxes. They move distances by kBoxFarFactor themselves,
// because t may be negative: OutwardBy.
template <typename Tree, typename Real>
RaySlabs<double> WideSlabsOf(const Tree& tree, const Ray<Real>& ray, double give = 0) {
  const auto widen = [](Vec3<Real> a) {
    return Vec3<double>{static_cast<double>(a.x), static_cast<double>(a.y),
                        static_cast<double>(a.z)};
  };
  return SlabsOf(tree, Ray<double>{widen(ray.origin), widen(ray.direction)}, give);
}

// The distance t moved later, or with sign -1 earlier, by what box tests allow.
inline double OutwardBy(double t, double sign) {
  return t + sign * std::abs(t) * (static_cast<double>(kBoxFarFactor) - 1);
}

}  // namespace sheaf::scalar

#endif  // SHEAF_SCALAR_RAY_SLABS_H_
