// From the surfaces of an object to those of its instances.
//
// A hit is computed where the object is, with the ray mapped there; then its surface goes to where
// the instance stands. Normals go with the inverse transposed, which keeps fronts fronts under
// mirrors too.
#ifndef SHEAF_SCALAR_PLACE_SURFACE_H_
#define SHEAF_SCALAR_PLACE_SURFACE_H_

#include <cmath>

#include "simd/roundoffs.h"
#include "src/scalar/instances.h"
#include "src/scalar/surface.h"
#include "src/stream/frame_view.h"

namespace sheaf::scalar {

// The nearest hit of a ray in a frame, and whether there is any.
template <typename Real>
Hit<Real> TraceClosest(const FrameView<Real>& frame, const Ray<Real>& ray) {
  const Hit<Real> hit = TraceClosest(frame.tree, ray);
  return frame.has_instances() ? TraceClosest(frame.instances, ray, hit) : hit;
}

template <typename Real>
bool TraceOccluded(const FrameView<Real>& frame, const Ray<Real>& ray) {
  return TraceOccluded(frame.tree, ray) ||
         (frame.has_instances() && TraceOccluded(frame.instances, ray));
}

// The ray as what it hit sees it.
template <typename Real>
Ray<Real> RayAtHit(const FrameView<Real>& frame, const Ray<Real>& ray, std::uint32_t instance) {
  return instance == kNoInstance ? ray : MapRay(frame.instances, instance, ray);
}

// A normal where the instance stands, of any length.
template <typename Real>
Vec3<double> MapNormal(const AffineMap& to_object, Vec3<Real> normal) {
  const Vec3<double> n = normal.template To<double>();
  const auto along = [&](int axis) {
    return (to_object.row[0][axis] * n.x + to_object.row[1][axis] * n.y) +
           to_object.row[2][axis] * n.z;
  };
  return {along(0), along(1), along(2)};
}

// The sizes of what is added up for a point's coordinates.
template <typename Real>
Vec3<double> TermsOf(const AffineMap& map, Vec3<Real> point) {
  const Vec3<double> p = point.template To<double>();
  const auto of = [&](int k) {
    const auto& row = map.row[k];
    return ((std::abs(row[0] * p.x) + std::abs(row[1] * p.y)) + std::abs(row[2] * p.z)) +
           std::abs(row[3]);
  };
  return {of(0), of(1), of(2)};
}

// How much wider a ray's cone is in the object than in the world. `direction`: of the mapped ray.
template <typename Real>
Real StretchOf(Vec3<Real> direction) {
  return std::sqrt(Dot(direction, direction));
}

// Takes a surface of an object, whose ray was mapped, to where the instance stands. The offset
// grows by the roundings of that, and of the next ray's way back into the object.
template <typename Real>
void PlaceSurface(const FrameView<Real>& frame, const Ray<Real>& ray, std::uint32_t instance,
                  Surface<Real>& surface) {
  const AffineMap& to_object = frame.instances.to_object[instance];
  const AffineMap& to_world = frame.to_world[instance];
  const double roundoffs = static_cast<double>(kPositionRoundoffs<Real>);
  const Vec3<double> face = MapNormal(to_object, surface.face);
  const double length = std::sqrt(Dot(face, face));
  const double before = static_cast<double>(surface.offset) +
                        roundoffs * AbsDot(surface.face.template To<double>(),
                                           surface.position.template To<double>());
  const Vec3<double> terms = TermsOf(to_world, surface.position);
  surface.position = MapPoint(to_world, surface.position);
  surface.shadow_end = MapPoint(to_world, surface.shadow_end);
  const Vec3<double> unit = face / length;
  surface.offset = static_cast<Real>(
      (before / length + roundoffs * AbsDot(unit, surface.position.template To<double>())) +
      kTermRoundoffs<double> * AbsDot(unit, terms));
  surface.face = unit.template To<Real>();
  const Vec3<double> normal = MapNormal(to_object, surface.normal);
  surface.normal = (normal / std::sqrt(Dot(normal, normal))).template To<Real>();
  surface.direction = ray.direction;
  surface.instance = instance;
}

}  // namespace sheaf::scalar

#endif  // SHEAF_SCALAR_PLACE_SURFACE_H_
