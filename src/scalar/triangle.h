// Ray against triangle: Woop, Benthin, Wald, "Watertight Ray/Triangle Intersection" (JCGT 2013),
// unfused.
//
// An edge function is a difference of two products of the same four numbers for both triangles at
// the edge. Rounding is monotonic, so its sign is exact whenever it is not zero, and zero counts as
// inside on both sides: no ray slips between them, at edges or vertices. A fused multiply-add
// breaks this. Different from the paper: no double-precision fallback (it could only refuse hits
// within rounding of a silhouette), no winding swap (either sign counts), t by two divisions and
// from scaled edge functions, so that no product over- or underflows, and no hit outside the
// triangle's own extent.
#ifndef SHEAF_SCALAR_TRIANGLE_H_
#define SHEAF_SCALAR_TRIANGLE_H_

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <type_traits>

#include "simd/primitives.h"
#include "simd/query.h"
#include "simd/roundoffs.h"
#include "src/scalar/ray.h"
#include "src/scalar/surface.h"

namespace sheaf::scalar {

// The ray's part of the test: its dominant axis, and the shear that makes that axis the ray.
template <typename Real>
struct TriangleShear {
  int kx, ky, kz;
  Real sx, sy, dz;
};

template <typename Real>
TriangleShear<Real> ShearOf(Vec3<Real> direction) {
  const Real ax = std::abs(direction.x), ay = std::abs(direction.y), az = std::abs(direction.z);
  const int kz = ax >= ay && ax >= az ? 0 : ay >= az ? 1 : 2;
  const int kx = (kz + 1) % 3, ky = (kz + 2) % 3;
  const Real dz = direction[kz];
  return {kx, ky, kz, direction[kx] / dz, direction[ky] / dz, dz};
}

template <typename Real>
struct TriangleHit {
  Real t;
  Real u, v;  // barycentric weights of the second and third vertex
};

template <typename Real>
struct Extent {
  Real low, high;
};

// The extent of three coordinates relative to the ray's origin, with slack for the rounding of a
// hit.
template <typename Real>
Extent<Real> ExtentOf(Real a, Real b, Real c) {
  const Real low = std::min(std::min(a, b), c), high = std::max(std::max(a, b), c);
  const Real slack = std::max(-low, high) * kExtentRoundoffs<Real>;
  return {low - slack, high + slack};
}

// A power of two that takes a positive or negative normal number to [2, 4): what is left of the
// exponent's bits.
template <typename Real>
Real ScaleOf(Real x) {
  using Bits = std::conditional_t<sizeof(Real) == 4, std::uint32_t, std::uint64_t>;
  const Bits exponent = std::bit_cast<Bits>(std::numeric_limits<Real>::infinity());
  return std::bit_cast<Real>(~std::bit_cast<Bits>(x) & exponent);
}

// Whether the sheared triangle, of which these are the coordinates along one axis, lies beside the
// ray.
template <typename Real>
bool IsBeside(Real a, Real b, Real c) {
  return (a > 0 && b > 0 && c > 0) || (a < 0 && b < 0 && c < 0);
}

template <typename Real>
bool IsOutside(Extent<Real> extent, Real position) {
  return position < extent.low || position > extent.high;
}

// For a ray in the triangle's plane, all but, the edge functions are zero or rounding error: t is
// somewhere between the vertices along kz, but the ray may be nowhere near the triangle there. t
// then moves to where the ray meets the triangle's box, so that no box around the triangle, of
// whatever tree, excludes the hit; a ray that does not meet the box misses, which gives NaN. (It
// opens no gap: what Woop's argument needs are hits of triangles that the ray does meet, once
// sheared, and the slack covers the rounding of that.)
template <typename Real>
Real KeepInExtent(Real t, Vec3<Real> direction, const TriangleShear<Real>& shear, Vec3<Real> a,
                  Vec3<Real> b, Vec3<Real> c) {
  constexpr Real kMiss = std::numeric_limits<Real>::quiet_NaN();
  Real enter = -std::numeric_limits<Real>::infinity(), leave = -enter;
  for (const int axis : {shear.kx, shear.ky, shear.kz}) {
    const Extent<Real> extent = ExtentOf(a[axis], b[axis], c[axis]);
    if (direction[axis] == 0) {
      if (IsOutside(extent, Real(0))) return kMiss;
      continue;
    }
    const bool forward = direction[axis] > 0;
    enter = std::max(enter, (forward ? extent.low : extent.high) / direction[axis]);
    leave = std::min(leave, (forward ? extent.high : extent.low) / direction[axis]);
  }
  if (!(enter <= leave)) return kMiss;
  t = t < enter ? enter : t;  // false for NaN, which stays
  return t > leave ? leave : t;
}

template <typename Real>
SHEAF_INLINE std::optional<TriangleHit<Real>> IntersectTriangle(Vec3<Real> origin,
                                                                Vec3<Real> direction,
                                                                const TriangleShear<Real>& shear,
                                                                const Vec3<Real> (&vertex)[3]) {
  const Vec3<Real> a = vertex[0] - origin, b = vertex[1] - origin, c = vertex[2] - origin;
  const auto [kx, ky, kz, sx, sy, dz] = shear;
  const Real ax = a[kx] - sx * a[kz], ay = a[ky] - sy * a[kz];
  const Real bx = b[kx] - sx * b[kz], by = b[ky] - sy * b[kz];
  const Real cx = c[kx] - sx * c[kz], cy = c[ky] - sy * c[kz];

  const Real u = cx * by - cy * bx;
  const Real v = ax * cy - ay * cx;
  const Real w = bx * ay - by * ax;
  // Every comparison is false for NaN: such a triangle or ray misses.
  const bool inside = (u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0);
  const Real det = (u + v) + w;
  // A denormal det counts as 0.
  if (!inside || !(std::abs(det) >= std::numeric_limits<Real>::min())) return std::nullopt;
  // Two edge functions that round to 0 would let the third alone decide, which holds for a ray far
  // beside a triangle in whose plane it runs.
  if (IsBeside(ax, bx, cx) || IsBeside(ay, by, cy)) return std::nullopt;

  // A power of two rounds nothing. Without it, products of three lengths would leave the range of
  // float where lengths leave 2^-42 to 2^42.
  const Real scale = ScaleOf(det);
  const Real scaled_t = ((u * scale) * a[kz] + (v * scale) * b[kz]) + (w * scale) * c[kz];
  Real t = (scaled_t / (det * scale)) / dz;
  // Along kz t is a mean of the vertices already.
  if (IsOutside(ExtentOf(a[kx], b[kx], c[kx]), t * direction[kx]) ||
      IsOutside(ExtentOf(a[ky], b[ky], c[ky]), t * direction[ky])) {
    t = KeepInExtent(t, direction, shear, a, b, c);
    if (std::isnan(t)) return std::nullopt;
  }
  return TriangleHit<Real>{t, v / det, w / det};
}

template <typename Real>
Vec3<Real> TriangleVertex(const TriangleArrays<Real>& triangles, std::uint32_t i, int vertex) {
  return {triangles.vertex[vertex][0][i], triangles.vertex[vertex][1][i],
          triangles.vertex[vertex][2][i]};
}

// The hit of one triangle in [t_min, t_max]; the source triangle is never hit.
template <typename Real>
SHEAF_INLINE std::optional<TriangleHit<Real>> HitTriangle(const Ray<Real>& ray,
                                                          const TriangleShear<Real>& shear,
                                                          const TriangleArrays<Real>& triangles,
                                                          std::uint32_t i) {
  if ((ray.source & ~kInsideBit) == triangles.id[i]) return std::nullopt;
  const Vec3<Real> vertices[3] = {TriangleVertex(triangles, i, 0), TriangleVertex(triangles, i, 1),
                                  TriangleVertex(triangles, i, 2)};
  const auto hit = IntersectTriangle(ray.origin, ray.direction, shear, vertices);
  if (!hit || !(ray.t_min <= hit->t && hit->t <= ray.t_max)) return std::nullopt;
  return hit;
}

template <typename Real>
Vec3<Wide<Real>> VertexValue(const Real* const (&values)[3][3], int vertex, std::uint32_t i) {
  return Vec3<Real>{values[vertex][0][i], values[vertex][1][i], values[vertex][2][i]}
      .template To<Wide<Real>>();
}

// The position is the barycentric mean of the vertices, whose error lies almost wholly in the
// plane.
template <typename Real>
Surface<Real> TriangleSurface(const Ray<Real>& ray, const Hit<Real>& hit,
                              const TriangleArrays<Real>& triangles, std::uint32_t i) {
  using W = Wide<Real>;
  const Vec3<W> v0 = TriangleVertex(triangles, i, 0).template To<W>();
  const Vec3<W> v1 = TriangleVertex(triangles, i, 1).template To<W>();
  const Vec3<W> v2 = TriangleVertex(triangles, i, 2).template To<W>();
  const W w1 = static_cast<W>(hit.u), w2 = static_cast<W>(hit.v);
  const W w0 = (1 - w1) - w2;
  const Vec3<W> front = NormalizeWide(Cross(v1 - v0, v2 - v0));
  const bool inside = Dot(front, ray.direction.template To<W>()) > 0;
  const Vec3<W> position = (v0 * w0 + v1 * w1) + v2 * w2;

  Surface<Real> surface;
  surface.position = position.template To<Real>();
  surface.face = (inside ? -front : front).template To<Real>();
  surface.normal = surface.face;
  surface.direction = ray.direction;
  const auto mean = [&](const Real* const(&values)[3][3]) {
    return (VertexValue(values, 0, i) * w0 + VertexValue(values, 1, i) * w1) +
           VertexValue(values, 2, i) * w2;
  };
  if (triangles.normal[0][0]) {
    const Vec3<W> smooth = mean(triangles.normal);
    if (Dot(smooth, smooth) > 0) {  // not NaN either
      const Vec3<W> unit = NormalizeWide(smooth);
      // Files disagree on the side that normals show: it is the face's, which faces the ray.
      const bool turn = Dot(unit, surface.face.template To<W>()) < 0;
      surface.normal = (turn ? -unit : unit).template To<Real>();
    }
  }
  if (triangles.colour[0][0]) {
    // Equal colours give that colour, exactly: a mesh without any keeps its white.
    const auto colour = [&](int vertex) { return VertexValue(triangles.colour, vertex, i); };
    const Vec3<W> first = colour(0);
    surface.tint =
        ((first + (colour(1) - first) * w1) + (colour(2) - first) * w2).template To<Real>();
  }
  if (triangles.uv[0][0]) {
    const auto coordinate = [&](int axis) {
      const auto uv = [&](int vertex) { return static_cast<W>(triangles.uv[vertex][axis][i]); };
      return static_cast<Real>((uv(0) * w0 + uv(1) * w1) + uv(2) * w2);
    };
    surface.u = coordinate(0);
    surface.v = coordinate(1);
  }
  // A neighbour's plane is tested from vertices that are as large as these, not as this point.
  const Vec3<W> terms = {(std::abs(v0.x) + std::abs(v1.x)) + std::abs(v2.x),
                         (std::abs(v0.y) + std::abs(v1.y)) + std::abs(v2.y),
                         (std::abs(v0.z) + std::abs(v1.z)) + std::abs(v2.z)};
  surface.offset =
      static_cast<Real>(static_cast<W>(kPositionRoundoffs<Real>) * AbsDot(front, terms));
  surface.source = hit.primitive | (inside ? kInsideBit : 0);
  return surface;
}

}  // namespace sheaf::scalar

#endif  // SHEAF_SCALAR_TRIANGLE_H_
