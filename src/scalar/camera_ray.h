// The primary ray of one sample of one pixel.
#ifndef SHEAF_SCALAR_CAMERA_RAY_H_
#define SHEAF_SCALAR_CAMERA_RAY_H_

#include <cmath>

#include "simd/shading.h"
#include "src/scalar/ray.h"
#include "src/scalar/sin_cos.h"
#include "src/scalar/warp.h"

namespace sheaf::scalar {

// Pixel (x, y), counted from the top left, at the point (sx, sy) in [0, 1)^2 of it, through the
// middle of the lens.
template <typename Real>
Ray<Real> PinholeRay(const CameraData<Real>& camera, Real x, Real y, Real sx, Real sy) {
  const Vec3<Real> eye = FromArray(camera.eye), forward = FromArray(camera.forward);
  // Counted from the picture's centre, where half pixels are exact.
  const Real a = (x + sx) - camera.half_width;
  const Real b = camera.half_height - (y + sy);
  const auto across = [&] { return FromArray(camera.right) * a + FromArray(camera.up) * b; };
  switch (camera.model) {
    case CameraModel::kPerspective:
      return {eye, Normalize(forward + across())};
    case CameraModel::kOrthographic:
      return {eye + across(), forward};
    case CameraModel::kEquirectangular: {
      const SinCos<Real> longitude = SinCosOf(a * camera.turns_x);
      const SinCos<Real> latitude = SinCosOf(b * camera.turns_y);
      const Vec3<Real> level = forward * longitude.cos + FromArray(camera.right) * longitude.sin;
      return {eye, Normalize(level * latitude.cos + FromArray(camera.up) * latitude.sin)};
    }
    case CameraModel::kFisheye:
      break;
  }
  const Real distance = std::sqrt(a * a + b * b);
  const SinCos<Real> angle = SinCosOf(distance * camera.turns_y);
  const Real scale = distance > 0 ? angle.sin / distance : Real(0);
  return {eye, Normalize(forward * angle.cos + across() * scale)};
}

// The same through a point of the lens: it meets the other in the plane that is sharp.
template <typename Real>
Ray<Real> CameraRay(const CameraData<Real>& camera, Real x, Real y, Real sx, Real sy,
                    SamplePoint<Real> lens = {}) {
  Ray<Real> ray = PinholeRay(camera, x, y, sx, sy);
  if (camera.lens == LensUse::kNone) return ray;
  const PlanePoint<Real> p =
      camera.blades > 0 ? PolygonPoint(camera.blades, camera.blade_turn, lens) : DiskPoint(lens);
  const Vec3<Real> aside = FromArray(camera.lens_right) * p.x + FromArray(camera.lens_up) * p.y;
  const Real nearness = Dot(ray.direction, FromArray(camera.forward)) / camera.focus;
  ray.direction = Normalize(ray.direction - aside * nearness);
  ray.origin = ray.origin + aside;
  return ray;
}

}  // namespace sheaf::scalar

#endif  // SHEAF_SCALAR_CAMERA_RAY_H_
