// Light that passes surfaces which are not all there.
#ifndef SHEAF_SCALAR_PASS_LIGHT_H_
#define SHEAF_SCALAR_PASS_LIGHT_H_

#include "simd/query.h"
#include "src/scalar/finish.h"
#include "src/scalar/ray.h"
#include "src/scalar/sphere_coordinates.h"
#include "src/scalar/trace_tree.h"
#include "src/stream/frame_view.h"

namespace sheaf::scalar {

// Light passes at most this many surfaces.
inline constexpr int kMostPasses = 256;

template <typename Real>
Surface<Real> SurfaceOf(const FrameView<Real>& frame, const MaterialData<Real>& material,
                        const Ray<Real>& ray, const Hit<Real>& hit) {
  const PrimitiveInfo& primitive = frame.primitives[hit.primitive];
  Surface<Real> surface = SurfaceAt(ray, hit, frame.geometry, primitive.place);
  const bool has_coordinates = (material.needs & kNeedsCoordinates) != 0;
  if (has_coordinates && primitive.kind() == PrimitiveKind::kSphere) PlaceOnSphere(surface);
  return surface;
}

// Takes a shadow ray past what it hit: it starts anew beyond, with the same end, and `share` is
// what is left of the light. False where nothing is.
template <typename Real>
bool PassSurface(const FrameView<Real>& frame, const Hit<Real>& hit, Ray<Real>& ray, Real& share) {
  const MaterialData<Real>& material = frame.materials[frame.primitives[hit.primitive].material];
  if (material.finish.alpha == AlphaUse::kOpaque) return false;
  const Surface<Real> surface = SurfaceOf(frame, material, ray, hit);
  share = share * (1 - AlphaAt(material, frame.textures, surface));
  if (!(share > 0)) return false;
  const Vec3<Real> start = surface.position - surface.face * surface.offset;
  // A ray that ends at 1 ends at a point; others have a direction alone.
  if (ray.t_max == 1) ray.direction = (ray.origin + ray.direction) - start;
  ray.origin = start;
  ray.source = surface.source ^ kInsideBit;
  return true;
}

// The share of the light along a shadow ray that arrives.
template <typename Real>
Real LightShare(const FrameView<Real>& frame, Ray<Real> ray) {
  if (!TraceOccluded(frame.tree, ray)) return 1;
  if (!frame.has_alpha) return 0;
  Real share = 1;
  for (int i = 0; i < kMostPasses; ++i) {
    const Hit<Real> hit = TraceClosest(frame.tree, ray);
    if (hit.primitive == kNoPrimitive) return share;
    if (!PassSurface(frame, hit, ray, share)) return 0;
  }
  return 0;
}

}  // namespace sheaf::scalar

#endif  // SHEAF_SCALAR_PASS_LIGHT_H_
