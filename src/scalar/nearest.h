// The nearest point of a primitive's surface, computed wide, and which primitives meet a ball: they
// are those whose nearest point lies within it.
#ifndef SHEAF_SCALAR_NEAREST_H_
#define SHEAF_SCALAR_NEAREST_H_

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "simd/primitives.h"
#include "simd/query.h"
#include "src/core/vec3.h"
#include "src/scalar/disk.h"
#include "src/scalar/sphere.h"
#include "src/scalar/triangle.h"

namespace sheaf::scalar {

using Wide3 = Vec3<double>;

// Where a place's nearest point is, relative to the place.
struct Nearest {
  Wide3 offset{0, 0, 0};
  double square = 0;  // of the distance

  explicit Nearest(Wide3 to) : offset(to), square(Dot(to, to)) {}
};

// What follows takes primitives relative to the place, as differences in double: of floats they are
// exact, but for those that are 2^29 times as far apart as they are large.

// The nearest point of the segment from a to b.
inline Nearest NearestOfSegment(Wide3 a, Wide3 b) {
  const Wide3 along = b - a;
  const double length = Dot(along, along), way = -Dot(a, along);
  if (!(way > 0)) return Nearest(a);
  return way >= length ? Nearest(b) : Nearest(a + along * (way / length));
}

// The nearest point of an edge, or of the plane where the place is above the triangle. Whether it
// is is a matter of rounding only where both are all but equal.
inline Nearest NearestOfTriangle(Wide3 a, Wide3 b, Wide3 c) {
  Nearest nearest = NearestOfSegment(a, b);
  for (const Nearest& edge : {NearestOfSegment(b, c), NearestOfSegment(c, a)}) {
    if (edge.square < nearest.square) nearest = edge;
  }
  const Wide3 n = Cross(b - a, c - a);
  const bool is_above =
      Dot(n, Cross(a, b - a)) >= 0 && Dot(n, Cross(b, c - b)) >= 0 && Dot(n, Cross(c, a - c)) >= 0;
  if (!is_above) return nearest;
  const Nearest plane(n * (Dot(n, a) / Dot(n, n)));
  return plane.square < nearest.square ? plane : nearest;
}

// Of the shell, from inside as from outside.
inline Nearest NearestOfSphere(Wide3 center, double radius) {
  const double distance = std::sqrt(Dot(center, center));
  if (distance == 0) return Nearest({radius, 0, 0});  // all are as near
  return Nearest(center * ((distance - radius) / distance));
}

inline Nearest NearestOfDisk(Wide3 center, double radius, Wide3 normal) {
  const Wide3 n = NormalizeWide(normal);
  const Wide3 foot = n * Dot(n, center);
  const Wide3 out = foot - center;
  const double square = Dot(out, out);
  if (square <= radius * radius) return Nearest(foot);
  return Nearest(center + out * (radius / std::sqrt(square)));
}

// NearestOf: the nearest point of primitive `i`, which is one that rays can hit.

template <typename Real>
Nearest NearestOf(Wide3 place, const TriangleArrays<Real>& triangles, std::uint32_t i) {
  const auto vertex = [&](int k) {
    return TriangleVertex(triangles, i, k).template To<double>() - place;
  };
  return NearestOfTriangle(vertex(0), vertex(1), vertex(2));
}

template <typename Real>
Nearest NearestOf(Wide3 place, const SphereArrays<Real>& spheres, std::uint32_t i) {
  const Vec3<Real> center = {spheres.center_x[i], spheres.center_y[i], spheres.center_z[i]};
  return NearestOfSphere(center.template To<double>() - place,
                         static_cast<double>(spheres.radius[i]));
}

template <typename Real>
Nearest NearestOf(Wide3 place, const DiskArrays<Real>& disks, std::uint32_t i) {
  return NearestOfDisk(DiskCenter(disks, i).template To<double>() - place,
                       static_cast<double>(disks.radius[i]),
                       DiskNormal(disks, i).template To<double>());
}

// The nearest primitive so far, of equal distance the lowest.
struct NearestPrimitive {
  double square;  // nothing beyond counts
  std::uint32_t primitive = kNoPrimitive;
  Wide3 offset{0, 0, 0};

  void Take(const Nearest& nearest, std::uint32_t id) {
    // False for NaN: what no ray can hit, and places that are not finite.
    if (nearest.square < square || (nearest.square == square && id < primitive)) {
      *this = {nearest.square, id, nearest.offset};
    }
  }
};

// Over every primitive that `admits`.
template <typename Real, typename Admits>
NearestPrimitive FindNearest(const GeometryView<Real>& geometry, Wide3 place, double max_square,
                             Admits admits) {
  NearestPrimitive nearest{max_square};
  ForEachKind(geometry, [&](const auto& arrays) {
    for (std::uint32_t i = 0; i < arrays.count; ++i) {
      if (admits(arrays.id[i])) nearest.Take(NearestOf(place, arrays, i), arrays.id[i]);
    }
  });
  return nearest;
}

}  // namespace sheaf::scalar

#endif  // SHEAF_SCALAR_NEAREST_H_
