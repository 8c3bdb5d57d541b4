// How much of a surface a ray stands for.
//
// A ray is the axis of a cone (Amanatides, "Ray Tracing with Cones", SIGGRAPH 1984; Akenine-Möller
// et al., "Texture Level of Detail Strategies for Real-Time Ray Tracing", Ray Tracing Gems, chapter
// 20), as wide as what a sample covers of its pixel. It grows by the same spread along the whole
// path: mirrors and lenses count as flat. Different here: the cone's ellipse on the surface is
// measured along u and along v, so that a ground seen at a flat angle loses detail along the view
// and not across it.
#ifndef SHEAF_SCALAR_FOOTPRINT_H_
#define SHEAF_SCALAR_FOOTPRINT_H_

#include <cmath>
#include <numbers>

#include "simd/primitives.h"
#include "simd/shading.h"
#include "src/scalar/disk.h"
#include "src/scalar/surface.h"

namespace sheaf::scalar {

// Two vectors in a surface's plane, each the slope of a surface coordinate times a normal n, in the
// sense of a cross product, and n times the ray's direction. The length of n counts for nothing.
template <typename Real>
struct CoordinateSlopes {
  Vec3<Real> u, v;
  Real facing;
};

// By a set of its coordinates.
template <typename Real>
CoordinateSlopes<Real> SlopesOnTriangle(const TriangleArrays<Real>& triangles,
                                        const Real* const (&uv)[3][2], std::uint32_t i,
                                        Vec3<Real> direction) {
  const auto vertex = [&](int k) -> Vec3<Real> {
    return {triangles.vertex[k][0][i], triangles.vertex[k][1][i], triangles.vertex[k][2][i]};
  };
  const Vec3<Real> e1 = vertex(1) - vertex(0), e2 = vertex(2) - vertex(0);
  const auto slope = [&](int axis) {
    const Real first = uv[0][axis][i];
    return e2 * (uv[1][axis][i] - first) - e1 * (uv[2][axis][i] - first);
  };
  return {slope(0), slope(1), Dot(Cross(e1, e2), direction)};
}

// On a sphere, whose normal is `n` on either side.
template <typename Real>
CoordinateSlopes<Real> SlopesOnSphere(Real radius, Vec3<Real> n, Vec3<Real> direction) {
  const Real square = n.x * n.x + n.z * n.z;  // of the distance from the axis
  const Real around = (2 * std::numbers::pi_v<Real>)*radius;
  const Real to_u = 1 / (around * square), to_v = 2 / (around * std::sqrt(square));
  const Vec3<Real> along_v = {-(n.x * n.y), square, -(n.z * n.y)}, along_u = {n.z, 0, -n.x};
  return {along_v * to_u, along_u * to_v, Dot(n, direction)};
}

// On a disk, whose front's normal is `n`.
template <typename Real>
CoordinateSlopes<Real> SlopesOnDisk(Real radius, Vec3<Real> n, Vec3<Real> direction) {
  const Frame<Real> frame(n);
  const Real scale = Real(0.5) / radius;
  return {frame.y * scale, frame.x * scale, Dot(n, direction)};
}

// The extent of a cone along a surface coordinate: infinite or NaN where the surface is seen from
// its edge, or the coordinate has no slope, as at the poles of spheres.
template <typename Real>
Real ExtentAlong(Vec3<Real> slope, Real facing, Vec3<Real> direction, Real width) {
  const Vec3<Real> across = Cross(slope, direction);
  return width * std::sqrt(Dot(across, across)) / std::abs(facing);
}

template <typename Real>
CoordinateSlopes<Real> SlopesAt(const GeometryView<Real>& geometry, std::uint32_t place,
                                const Surface<Real>& surface) {
  const std::uint32_t i = IndexIn(place);
  switch (KindOf(place)) {
    case PrimitiveKind::kTriangle:
      return SlopesOnTriangle(geometry.triangles, geometry.triangles.uv, i, surface.direction);
    case PrimitiveKind::kSphere:
      return SlopesOnSphere(geometry.spheres.radius[i], surface.face, surface.direction);
    case PrimitiveKind::kDisk:
      break;
  }
  const Vec3<Real> front = surface.inside() ? -surface.face : surface.face;
  return SlopesOnDisk(geometry.disks.radius[i], front, surface.direction);
}

// Sets the width of the cone of a ray that starts `start` wide and hits at `t`, and what the cone
// covers of the surface's coordinates, of both sets.
template <typename Real>
void MeasureFootprint(const GeometryView<Real>& geometry, std::uint32_t place, Real start,
                      Real spread, Real t, Surface<Real>& surface) {
  surface.width = start + spread * t;
  const TriangleArrays<Real>& triangles = geometry.triangles;
  const bool is_triangle = KindOf(place) == PrimitiveKind::kTriangle;
  if (is_triangle && !triangles.uv[0][0]) return;
  const auto extent = [&](Vec3<Real> slope, Real facing) {
    return ExtentAlong(slope, facing, surface.direction, surface.width);
  };
  const CoordinateSlopes<Real> slopes = SlopesAt(geometry, place, surface);
  surface.footprint_u = extent(slopes.u, slopes.facing);
  surface.footprint_v = extent(slopes.v, slopes.facing);
  surface.footprint_u2 = surface.footprint_u;
  surface.footprint_v2 = surface.footprint_v;
  if (!is_triangle || !triangles.uv2[0][0]) return;
  const CoordinateSlopes<Real> second =
      SlopesOnTriangle(triangles, triangles.uv2, IndexIn(place), surface.direction);
  surface.footprint_u2 = extent(second.u, second.facing);
  surface.footprint_v2 = extent(second.v, second.facing);
}

}  // namespace sheaf::scalar

#endif  // SHEAF_SCALAR_FOOTPRINT_H_
