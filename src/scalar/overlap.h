// Whether a primitive meets a box, in double. A sphere is its shell.
#ifndef SHEAF_SCALAR_OVERLAP_H_
#define SHEAF_SCALAR_OVERLAP_H_

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>

#include "simd/primitives.h"
#include "src/scalar/nearest.h"

namespace sheaf::scalar {

struct Box {
  Wide3 lower, upper;

  // False for NaN.
  bool is_empty() const {
    return !(lower.x <= upper.x && lower.y <= upper.y && lower.z <= upper.z);
  }
  Wide3 Clamp(Wide3 p) const {
    const auto clamp = [&](int k) { return std::min(std::max(p[k], lower[k]), upper[k]); };
    return {clamp(0), clamp(1), clamp(2)};
  }
};

// Whether box and triangle lie beside each other along an axis, which need not be unit.
inline bool IsApart(const Box& box, const Wide3 (&vertex)[3], Wide3 axis) {
  const auto end = [&](Wide3 at_plus, Wide3 at_minus) {
    const auto along = [&](int k) { return axis[k] * (axis[k] > 0 ? at_plus : at_minus)[k]; };
    return (along(0) + along(1)) + along(2);
  };
  const double a = Dot(axis, vertex[0]), b = Dot(axis, vertex[1]), c = Dot(axis, vertex[2]);
  return std::max(std::max(a, b), c) < end(box.lower, box.upper) ||
         std::min(std::min(a, b), c) > end(box.upper, box.lower);
}

// By separating axes: Akenine-Moeller, "Fast 3D Triangle-Box Overlap Testing" (JGT 6(1), 2001).
inline bool TriangleMeetsBox(const Box& box, const Wide3 (&given)[3]) {
  // Around one of the vertices, so that axes meet small numbers far from the origin too.
  const Box near = {box.lower - given[0], box.upper - given[0]};
  const Wide3 vertex[3] = {{0, 0, 0}, given[1] - given[0], given[2] - given[0]};
  const Wide3 unit[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const Wide3 edge[3] = {vertex[1], vertex[2] - vertex[1], -vertex[2]};
  for (const Wide3& axis : unit) {
    if (IsApart(near, vertex, axis)) return false;
  }
  if (IsApart(near, vertex, Cross(edge[0], edge[1]))) return false;
  for (const Wide3& along : edge) {
    for (const Wide3& axis : unit) {
      if (IsApart(near, vertex, Cross(axis, along))) return false;
    }
  }
  return true;
}

inline bool SphereMeetsBox(const Box& box, Wide3 center, double radius) {
  const Wide3 nearest = box.Clamp(center) - center;
  const auto reach = [&](int k) {
    return std::max(std::abs(box.lower[k] - center[k]), std::abs(box.upper[k] - center[k]));
  };
  const Wide3 furthest = {reach(0), reach(1), reach(2)};
  const double square = radius * radius;
  return Dot(nearest, nearest) <= square && square <= Dot(furthest, furthest);
}

// The point of the box and the plane that is nearest to the disk's center is where the line along
// the normal, held within the box, comes to the plane: the height of Clamp(center + s * normal)
// above it grows with s, straight between the few s at which a coordinate enters or leaves the box.
inline bool DiskMeetsBox(const Box& box, Wide3 center, double radius, Wide3 normal) {
  const Wide3 n = NormalizeWide(normal);
  const auto at = [&](double s) { return box.Clamp(center + n * s) - center; };
  double turn[6];
  int turns = 0;
  for (int k = 0; k < 3; ++k) {
    if (n[k] == 0) continue;
    for (const double plane : {box.lower[k], box.upper[k]}) {
      const double s = (plane - center[k]) / n[k];
      int place = turns++;
      for (; place > 0 && turn[place - 1] > s; --place) turn[place] = turn[place - 1];
      turn[place] = s;
    }
  }
  const double lowest = Dot(n, at(turn[0])), highest = Dot(n, at(turn[turns - 1]));
  if (!(lowest <= 0 && highest >= 0)) return false;
  double from = turn[0], from_height = lowest;
  for (int i = 1; i < turns; ++i) {
    const double height = Dot(n, at(turn[i]));
    if (height >= 0) {
      const double part = height == from_height ? 0 : -from_height / (height - from_height);
      const Wide3 point = at(from + (turn[i] - from) * part);
      return Dot(point, point) <= radius * radius;
    }
    from = turn[i];
    from_height = height;
  }
  return false;
}

// MeetsBox: whether primitive `i`, which is one that rays can hit, has a point in the box.

template <typename Real>
bool MeetsBox(const Box& box, const TriangleArrays<Real>& triangles, std::uint32_t i) {
  const auto vertex = [&](int k) { return TriangleVertex(triangles, i, k).template To<double>(); };
  return TriangleMeetsBox(box, {vertex(0), vertex(1), vertex(2)});
}

template <typename Real>
bool MeetsBox(const Box& box, const SphereArrays<Real>& spheres, std::uint32_t i) {
  const Vec3<Real> center = {spheres.center_x[i], spheres.center_y[i], spheres.center_z[i]};
  return SphereMeetsBox(box, center.template To<double>(), static_cast<double>(spheres.radius[i]));
}

template <typename Real>
bool MeetsBox(const Box& box, const DiskArrays<Real>& disks, std::uint32_t i) {
  return DiskMeetsBox(box, DiskCenter(disks, i).template To<double>(),
                      static_cast<double>(disks.radius[i]),
                      DiskNormal(disks, i).template To<double>());
}

}  // namespace sheaf::scalar

#endif  // SHEAF_SCALAR_OVERLAP_H_
