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
// exact, but for those that are 2^29 times as far apart as they are large. A distance that is much
// smaller than these numbers is a difference of rounded products, and is computed anew from
// products that are not.
inline constexpr double kSmallSquare = 0x1p-40;  // part of the square of a coordinate

// a * b - c * d to 1.5 units in the last place: Kahan; see Jeannerod, Louvet, Muller, "Further
// Analysis of Kahan's Algorithm" (Math. Comp. 82, 2013).
inline double DifferenceOfProducts(double a, double b, double c, double d) {
  const double cd = c * d;
  return std::fma(a, b, -cd) + std::fma(-c, d, cd);
}

inline Wide3 AccurateCross(Wide3 a, Wide3 b) {
  return {DifferenceOfProducts(a.y, b.z, a.z, b.y), DifferenceOfProducts(a.z, b.x, a.x, b.z),
          DifferenceOfProducts(a.x, b.y, a.y, b.x)};
}

// A sum of products as in twice the digits, rounded: Dot2 of the paper at CompensatedSum.
class AccurateDot {
 public:
  void Add(double a, double b) {
    const double product = a * b;
    sum_.Add(product);
    rest_ += std::fma(a, b, -product);
  }
  double value() const { return sum_.sum + (sum_.error + rest_); }

 private:
  CompensatedSum<double> sum_{0};
  double rest_ = 0;
};

// a . (b x c)
inline double AccurateVolume(Wide3 a, Wide3 b, Wide3 c) {
  AccurateDot volume;
  for (int k = 0; k < 3; ++k) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    // Each component of the product in two parts.
    const double high = b[i] * c[j] - b[j] * c[i];
    AccurateDot low;
    low.Add(b[i], c[j]);
    low.Add(-b[j], c[i]);
    low.Add(-high, 1);
    volume.Add(a[k], high);
    volume.Add(a[k], low.value());
  }
  return volume.value();
}

// The nearest point of the segment from a to b.
inline Nearest NearestOfSegment(Wide3 a, Wide3 b) {
  const Wide3 along = b - a;
  const double length = Dot(along, along), way = -Dot(a, along);
  if (!(way > 0)) return Nearest(a);
  if (way >= length) return Nearest(b);
  const Nearest nearest(a + along * (way / length));
  if (nearest.square >= kSmallSquare * Dot(a, a)) return nearest;
  return Nearest(Cross(along, AccurateCross(a, along)) / length);
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
  Nearest plane(n * (Dot(n, a) / Dot(n, n)));
  if (plane.square < kSmallSquare * Dot(a, a)) {
    plane = Nearest(n * (AccurateVolume(a, b - a, c - a) / Dot(n, n)));
  }
  return plane.square < nearest.square ? plane : nearest;
}

// Of the shell, from inside as from outside.
inline Nearest NearestOfSphere(Wide3 center, double radius) {
  const double square = Dot(center, center), distance = std::sqrt(square);
  if (distance == 0) return Nearest({radius, 0, 0});  // all are as near
  const Nearest nearest(center * ((distance - radius) / distance));
  if (nearest.square >= kSmallSquare * square) return nearest;
  AccurateDot difference;
  for (int k = 0; k < 3; ++k) difference.Add(center[k], center[k]);
  difference.Add(-radius, radius);
  return Nearest(center * (difference.value() / (distance + radius) / distance));
}

inline Nearest NearestOfDisk(Wide3 center, double radius, Wide3 normal) {
  const Wide3 n = NormalizeWide(normal);
  Wide3 foot = n * Dot(n, center);
  if (Dot(foot, foot) < kSmallSquare * Dot(center, center)) {
    AccurateDot height;
    for (int k = 0; k < 3; ++k) height.Add(normal[k], center[k]);
    foot = normal * (height.value() / Dot(normal, normal));
  }
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
