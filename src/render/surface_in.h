// One surface of a stream, for what goes surface by surface.
#ifndef SHEAF_RENDER_SURFACE_IN_H_
#define SHEAF_RENDER_SURFACE_IN_H_

#include <cstdint>

#include "simd/shading.h"
#include "simd/streams.h"
#include "src/scalar/shade.h"
#include "src/scalar/surface.h"

namespace sheaf {

// Surface `i`, as far as textures look at it; `needs` says what of it was written.
template <typename Real>
scalar::Surface<Real> SurfaceIn(const SurfaceView<Real>& surfaces, std::uint32_t i,
                                std::uint32_t needs) {
  scalar::Surface<Real> surface{};
  surface.normal = {surfaces.normal_x[i], surfaces.normal_y[i], surfaces.normal_z[i]};
  surface.face = {surfaces.face_x[i], surfaces.face_y[i], surfaces.face_z[i]};
  if (needs & kNeedsCoordinates) surface.u = surfaces.u[i], surface.v = surfaces.v[i];
  if (needs & kNeedsFootprint) {
    surface.footprint_u = surfaces.footprint_u[i], surface.footprint_v = surfaces.footprint_v[i];
  }
  if (needs & kNeedsTint) {
    surface.tint = {surfaces.tint_r[i], surfaces.tint_g[i], surfaces.tint_b[i]};
  }
  surface.source = surfaces.source[i];
  return surface;
}

// The base colour of a surface whose tint holds its texture's colour already. Bits: as
// scalar::BaseColourAt.
template <typename Real>
Vec3<Real> TintedBase(const MaterialData<Real>& material, const scalar::Surface<Real>& surface) {
  return scalar::MultiplyColours(scalar::PatternAt(material, surface), surface.tint);
}

}  // namespace sheaf

#endif  // SHEAF_RENDER_SURFACE_IN_H_
