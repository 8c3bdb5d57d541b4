// Light that passes surfaces which are not all there, or which transmit.
#ifndef SHEAF_SCALAR_PASS_LIGHT_H_
#define SHEAF_SCALAR_PASS_LIGHT_H_

#include <cmath>

#include "simd/query.h"
#include "src/scalar/attenuate.h"
#include "src/scalar/finish.h"
#include "src/scalar/place_surface.h"
#include "src/scalar/ray.h"
#include "src/scalar/sphere_coordinates.h"
#include "src/scalar/trace_tree.h"
#include "src/stream/frame_view.h"

namespace sheaf::scalar {

// Light passes at most this many surfaces.
inline constexpr int kMostPasses = 256;

// In the object, where the hit is an instance's; then the ray is mapped.
template <typename Real>
Surface<Real> SurfaceOf(const FrameView<Real>& frame, const MaterialData<Real>& material,
                        const Ray<Real>& ray, const Hit<Real>& hit) {
  const PrimitiveInfo& primitive = frame.primitives[hit.primitive];
  Surface<Real> surface = SurfaceAt(ray, hit, frame.geometry, primitive.place);
  const bool has_coordinates = (material.needs & kNeedsCoordinates) != 0;
  if (has_coordinates && primitive.kind() == PrimitiveKind::kSphere) PlaceOnSphere(surface);
  if (primitive.kind() != PrimitiveKind::kTriangle) surface.u2 = surface.u, surface.v2 = surface.v;
  return surface;
}

// Where the instance stands.
template <typename Real>
Surface<Real> PlacedSurfaceOf(const FrameView<Real>& frame, const MaterialData<Real>& material,
                              const Ray<Real>& ray, const Hit<Real>& hit) {
  const Ray<Real> mapped = MapRay(frame.instances, hit.instance, ray);
  Surface<Real> surface = SurfaceOf(frame, material, mapped, hit);
  PlaceSurface(frame, ray, hit.instance, surface);
  return surface;
}

// Whether there is any.
template <typename Real>
bool IsLight(Vec3<Real> share) {
  return share.x > 0 || share.y > 0 || share.z > 0;
}

// What becomes of a shadow ray: it is at its end, it starts anew beyond what it met, or no light is
// left.
enum class Passing { kArrived, kGoesOn, kBlocked };

// Takes a shadow ray past what it hit: it starts anew beyond, with the same end. `share` is what is
// left of the light.
template <typename Real>
Passing PassOn(const FrameView<Real>& frame, const Hit<Real>& hit, Ray<Real>& ray,
               Vec3<Real>& share) {
  const bool is_end = hit.primitive == kNoPrimitive;
  // A ray that ends at 1 ends at a point; others have a direction alone.
  const bool ends_at_point = ray.t_max == 1;
  if (frame.attenuates && (!is_end || ends_at_point)) {
    const Real length = hit.t * std::sqrt(Dot(ray.direction, ray.direction));
    share = MultiplyColours(share, TransmittanceOf(frame, ray.source, length));
  }
  if (is_end) return Passing::kArrived;
  const MaterialData<Real>& material = frame.materials[frame.primitives[hit.primitive].material];
  if (!LetsLightPass(material)) return Passing::kBlocked;
  const Surface<Real> surface = hit.instance == kNoInstance
                                    ? SurfaceOf(frame, material, ray, hit)
                                    : PlacedSurfaceOf(frame, material, ray, hit);
  share = MultiplyColours(share, PassedAt(material, frame.textures, surface));
  if (!IsLight(share)) return Passing::kBlocked;
  const Vec3<Real> start = surface.position - surface.face * surface.offset;
  if (ends_at_point) ray.direction = (ray.origin + ray.direction) - start;
  ray.origin = start;
  ray.source = surface.source ^ kInsideBit;
  ray.instance = surface.instance;
  return Passing::kGoesOn;
}

// The share of the light along a shadow ray that arrives.
template <typename Real>
Vec3<Real> LightShare(const FrameView<Real>& frame, Ray<Real> ray) {
  Vec3<Real> share = {1, 1, 1};
  if (!TraceOccluded(frame, ray)) return share;
  if (!frame.passes_light) return {0, 0, 0};
  for (int i = 0; i < kMostPasses; ++i) {
    const Passing passing = PassOn(frame, TraceClosest(frame, ray), ray, share);
    if (passing == Passing::kArrived) return share;
    if (passing == Passing::kBlocked) break;
  }
  return {0, 0, 0};
}

}  // namespace sheaf::scalar

#endif  // SHEAF_SCALAR_PASS_LIGHT_H_
