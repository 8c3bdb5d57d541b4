// The point that a ray hit: where, facing which way, and how far off a new ray has to start.
//
// Positions are reprojected onto the primitive, so that their error does not grow with the distance
// the ray came; what is left is bounded, and a secondary ray starts that bound away (Pharr, Jakob,
// Humphreys, "Physically Based Rendering", 4th ed., 6.8). No epsilon is tuned and no scale of the
// world assumed.
#ifndef SHEAF_SCALAR_SURFACE_H_
#define SHEAF_SCALAR_SURFACE_H_

#include "simd/query.h"
#include "simd/roundoffs.h"
#include "simd/tree.h"
#include "src/scalar/trace.h"

namespace sheaf::scalar {

// What SurfaceFields of simd/streams.h holds for one hit.
template <typename Real>
struct Surface {
  Vec3<Real> position;
  Vec3<Real> normal;     // for shading: unit, on the face's side
  Vec3<Real> face;       // the face's own: unit, facing the ray
  Vec3<Real> direction;  // of the ray, unit
  Real u = 0, v = 0;
  Vec3<Real> tint = {1, 1, 1};  // of the vertices' colours
  Real offset;
  std::uint32_t source;

  bool inside() const { return (source & kInsideBit) != 0; }
  std::uint32_t primitive() const { return source & ~kInsideBit; }
};

// With `hit.v`, the root has bits enough for a normal without the rounding of t.
template <typename Real>
Surface<Real> SphereSurface(const Ray<Real>& ray, const Hit<Real>& hit,
                            const SphereArrays<Real>& spheres, std::uint32_t i) {
  using W = Wide<Real>;
  const Vec3<Real> center = {spheres.center_x[i], spheres.center_y[i], spheres.center_z[i]};
  const Vec3<W> c = center.template To<W>();
  const Vec3<W> d = ray.direction.template To<W>();
  const bool leaves = hit.u != 0;
  const W t = static_cast<W>(hit.t) + static_cast<W>(hit.v);
  const Vec3<W> out = NormalizeWide((ray.origin.template To<W>() - c) + d * t);
  const W r = static_cast<W>(spheres.radius[i]);
  const Vec3<W> position = c + out * r;

  Surface<Real> surface;
  surface.position = position.template To<Real>();
  surface.normal = (leaves ? -out : out).template To<Real>();
  surface.face = surface.normal;
  surface.direction = ray.direction;
  // Where c + r n cancels, the error is that of its wide terms.
  const Vec3<W> terms = {std::abs(c.x) + r, std::abs(c.y) + r, std::abs(c.z) + r};
  surface.offset =
      static_cast<Real>(static_cast<W>(kPositionRoundoffs<Real>) * AbsDot(out, position) +
                        kTermRoundoffs<W> * AbsDot(out, terms));
  surface.source = hit.primitive | (leaves ? kInsideBit : 0);
  return surface;
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

#endif  // SHEAF_SCALAR_SURFACE_H_
