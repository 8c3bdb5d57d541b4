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

// The plane of a triangle, of which `n` is any normal, as a ray meets it.
template <typename W>
struct PlaneMeeting {
  W t, slope;  // slope: n . d

  PlaneMeeting(Vec3<W> o, Vec3<W> d, Vec3<W> vertex, Vec3<W> n)
      : t(Dot(n, vertex - o) / Dot(n, d)), slope(Dot(n, d)) {}
};

// Whether a ray is steep enough for t to be the plane's. False for NaN. Where there is nothing
// wider than Real, only a perpendicular ray may be.
template <typename Real, typename W>
bool IsSteep(W slope, Vec3<W> n, Vec3<W> d) {
  return slope * slope > kFlatSquare<Real, W> * (Dot(n, n) * Dot(d, d));
}

// Whether a triangle, of which a, b and c are the distances along the dominant axis, reaches far
// beyond a hit at t. A mean of vertices that far away errs by roundoffs of them. What lies well
// below t_min is no hit, whatever rounding does.
template <typename Real>
bool ReachesFar(Real t, Real t_min, Real dz, Real a, Real b, Real c) {
  if (std::is_same_v<Wide<Real>, Real>) return false;  // nothing is wider
  const Real reach = std::max(std::max(std::abs(a), std::abs(b)), std::abs(c));
  return reach > kFarReach<Real> * std::abs(t * dz) &&
         (t_min - t) * std::abs(dz) <= kBehindReach<Real> * reach;
}

// t of such a hit: the plane, computed wide, knows better.
template <typename Real>
Real RefineT(Real t, Vec3<Real> origin, Vec3<Real> direction, const Vec3<Real> (&vertex)[3]) {
  using W = Wide<Real>;
  const Vec3<W> o = origin.template To<W>(), d = direction.template To<W>();
  const Vec3<W> v0 = vertex[0].template To<W>();
  const Vec3<W> n = Cross(vertex[1].template To<W>() - v0, vertex[2].template To<W>() - v0);
  const PlaneMeeting<W> plane(o, d, v0, n);
  return IsSteep<Real>(plane.slope, n, d) ? static_cast<Real>(plane.t) : t;
}

template <typename Real>
SHEAF_INLINE std::optional<TriangleHit<Real>> IntersectTriangle(Vec3<Real> origin,
                                                                Vec3<Real> direction, Real t_min,
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
  const bool is_far = ReachesFar(t, t_min, dz, a[kz], b[kz], c[kz]);
  if (is_far) t = RefineT(t, origin, direction, vertex);
  // Along kz a mean of the vertices is within their extent already.
  if (IsOutside(ExtentOf(a[kx], b[kx], c[kx]), t * direction[kx]) ||
      IsOutside(ExtentOf(a[ky], b[ky], c[ky]), t * direction[ky]) ||
      (is_far && IsOutside(ExtentOf(a[kz], b[kz], c[kz]), t * dz))) {
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
  const auto hit = IntersectTriangle(ray.origin, ray.direction, ray.t_min, shear, vertices);
  if (!hit || !(ray.t_min <= hit->t && hit->t <= ray.t_max)) return std::nullopt;
  return hit;
}

template <typename Real>
Vec3<Wide<Real>> VertexValue(const Real* const (&values)[3][3], int vertex, std::uint32_t i) {
  return Vec3<Real>{values[vertex][0][i], values[vertex][1][i], values[vertex][2][i]}
      .template To<Wide<Real>>();
}

// A vertex's normal, unit and on the side of the face; the face's own where the vertex has none.
template <typename W, typename Real>
Vec3<W> UnitNormal(const TriangleArrays<Real>& triangles, int vertex, std::uint32_t i,
                   Vec3<W> face) {
  const Vec3<W> normal = VertexValue(triangles.normal, vertex, i);
  if (!(Dot(normal, normal) > 0)) return face;  // NaN either
  const Vec3<W> unit = NormalizeWide(normal);
  return Dot(unit, face) < 0 ? -unit : unit;
}

// Smooth normals stand for a curved surface, which flat faces cut. Shadow rays go to the point of
// that surface over the hit: Hanika, "Hacking the Shadow Terminator" (Ray Tracing Gems II, chapter
// 4). Different here: a light may lie below the face too, by as much as the normals of the vertices
// differ. So light fades over the edges of faces, and what is lit from behind stays dark.
template <typename Real>
void Curve(const TriangleArrays<Real>& triangles, std::uint32_t i, const Vec3<Wide<Real>>& weights,
           Surface<Real>& surface) {
  using W = Wide<Real>;
  const Vec3<W> position = surface.position.template To<W>();
  const Vec3<W> face = surface.face.template To<W>();
  Vec3<W> unit[3];
  for (int k = 0; k < 3; ++k) unit[k] = UnitNormal(triangles, k, i, face);
  Vec3<W> lift = {0, 0, 0};
  for (int k = 0; k < 3; ++k) {
    // How far the point lies below the plane that touches the surface at the vertex.
    const W depth = Dot(TriangleVertex(triangles, i, k).template To<W>() - position, unit[k]);
    lift = lift + unit[k] * ((depth > 0 ? depth : W(0)) * weights[k]);
  }
  W square = 0;
  for (int k = 0; k < 3; ++k) {
    const Vec3<W> turn = unit[(k + 1) % 3] - unit[k];
    square = std::max(square, Dot(turn, turn));
  }
  surface.shadow_end = (position + lift).template To<Real>();
  surface.bend = static_cast<Real>(std::sqrt(square));
}

// The position is where the ray meets the plane, wide: its error is the rounding. A ray that is too
// flat for that has the barycentric mean of the vertices, which errs by roundoffs of the triangle,
// but within the plane.
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
  const Vec3<W> o = ray.origin.template To<W>(), d = ray.direction.template To<W>();
  const PlaneMeeting<W> plane(o, d, v0, front);
  const bool inside = plane.slope > 0;
  const Vec3<W> position =
      IsSteep<Real>(plane.slope, front, d) ? o + d * plane.t : (v0 * w0 + v1 * w1) + v2 * w2;

  Surface<Real> surface;
  surface.position = position.template To<Real>();
  surface.shadow_end = surface.position;
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
      Curve(triangles, i, {w0, w1, w2}, surface);
    }
  }
  if (triangles.colour[0][0]) {
    // Equal colours give that colour, exactly: a mesh without any keeps its white.
    const auto colour = [&](int vertex) { return VertexValue(triangles.colour, vertex, i); };
    const Vec3<W> first = colour(0);
    surface.tint =
        ((first + (colour(1) - first) * w1) + (colour(2) - first) * w2).template To<Real>();
  }
  if (triangles.alpha[0][0]) {
    const auto alpha = [&](int vertex) { return static_cast<W>(triangles.alpha[vertex][0][i]); };
    const W first = alpha(0);
    const auto mixed =
        static_cast<Real>((first + (alpha(1) - first) * w1) + (alpha(2) - first) * w2);
    // Rounding can carry it past 0 and 1.
    surface.alpha = mixed > 0 ? (mixed < 1 ? mixed : Real(1)) : Real(0);
  }
  const auto coordinate = [&](const Real* const(&uv)[3][2], int axis) {
    const auto at = [&](int vertex) { return static_cast<W>(uv[vertex][axis][i]); };
    return static_cast<Real>((at(0) * w0 + at(1) * w1) + at(2) * w2);
  };
  if (triangles.uv[0][0]) {
    surface.u = coordinate(triangles.uv, 0);
    surface.v = coordinate(triangles.uv, 1);
  }
  if (triangles.uv2[0][0]) {
    surface.u2 = coordinate(triangles.uv2, 0);
    surface.v2 = coordinate(triangles.uv2, 1);
  }
  // What is wide errs by roundoffs of its terms; a neighbour's plane has vertices as large as
  // these.
  const auto sizes = [&](int axis) {
    return ((std::abs(v0[axis]) + std::abs(v1[axis])) + std::abs(v2[axis])) + std::abs(o[axis]);
  };
  const Vec3<W> terms = {sizes(0), sizes(1), sizes(2)};
  surface.offset =
      static_cast<Real>(static_cast<W>(kFoldRoundoffs<Real>) * AbsDot(front, position) +
                        kTermRoundoffs<W> * AbsDot(front, terms));
  surface.source = hit.primitive | (inside ? kInsideBit : 0);
  return surface;
}

}  // namespace sheaf::scalar

#endif  // SHEAF_SCALAR_TRIANGLE_H_
