#include "src/render/finish_surfaces.h"

#include "simd/shading.h"
#include "src/scalar/finish.h"
#include "src/scalar/sphere_coordinates.h"

namespace sheaf {
namespace {

// As much of a surface as textures ask for.
template <typename Real>
scalar::Surface<Real> SurfaceIn(const SurfaceView<Real>& surfaces, std::uint32_t i,
                                std::uint32_t needs) {
  scalar::Surface<Real> surface{};
  surface.normal = {surfaces.normal_x[i], surfaces.normal_y[i], surfaces.normal_z[i]};
  surface.face = {surfaces.face_x[i], surfaces.face_y[i], surfaces.face_z[i]};
  surface.u = surfaces.u[i];
  surface.v = surfaces.v[i];
  if (needs & kNeedsTint) {
    surface.tint = {surfaces.tint_r[i], surfaces.tint_g[i], surfaces.tint_b[i]};
  }
  surface.source = surfaces.source[i];
  return surface;
}

}  // namespace

template <typename Real>
void PlaceOnSpheres(const HitBin& bin, const SurfaceView<Real>& surfaces,
                    const SurfaceOutput<Real>& placed) {
  for (std::uint32_t i = 0; i < bin.batch.count; ++i) {
    scalar::Surface<Real> surface{};
    surface.normal = {surfaces.normal_x[i], surfaces.normal_y[i], surfaces.normal_z[i]};
    surface.source = surfaces.source[i];
    scalar::PlaceOnSphere(surface);
    placed.u[i] = surface.u;
    placed.v[i] = surface.v;
  }
}

template <typename Real>
void BumpSurfaces(const FrameView<Real>& frame, const HitBin& bin,
                  const SurfaceView<Real>& surfaces, const SurfaceOutput<Real>& bumped) {
  const MaterialData<Real>& material = frame.materials[bin.material];
  for (std::uint32_t i = 0; i < bin.batch.count; ++i) {
    const Vec3<Real> normal =
        scalar::BumpedNormal(material, frame.textures, frame.geometry.triangles, bin.batch.index[i],
                             SurfaceIn(surfaces, i, material.needs));
    bumped.normal_x[i] = normal.x;
    bumped.normal_y[i] = normal.y;
    bumped.normal_z[i] = normal.z;
  }
}

template <typename Real>
void FinishSurfaces(const FrameView<Real>& frame, const HitBin& bin,
                    const SurfaceView<Real>& surfaces, const SurfaceOutput<Real>& finished) {
  const MaterialData<Real>& material = frame.materials[bin.material];
  Real* const ambient[3] = {finished.ambient_r, finished.ambient_g, finished.ambient_b};
  Real* const emission[3] = {finished.emission_r, finished.emission_g, finished.emission_b};
  Real* const reflect[3] = {finished.reflect_r, finished.reflect_g, finished.reflect_b};
  Real* const transmit[3] = {finished.transmit_r, finished.transmit_g, finished.transmit_b};
  for (std::uint32_t i = 0; i < bin.batch.count; ++i) {
    const scalar::Surface<Real> surface = SurfaceIn(surfaces, i, material.needs);
    // Tints hold the texture's colour already.
    const Vec3<Real> base =
        scalar::MultiplyColours(scalar::PatternAt(material, surface), surface.tint);
    const MaterialData<Real> point = scalar::MaterialAt(material, frame.textures, surface, base);
    for (int c = 0; c < 3; ++c) {
      ambient[c][i] = point.ambient[c];
      emission[c][i] = point.emission[c];
      reflect[c][i] = point.reflect[c];
      transmit[c][i] = point.transmit[c];
    }
    finished.kd[i] = point.kd;
    finished.ks[i] = point.ks;
    finished.shininess[i] = point.shininess;
  }
}

#define SHEAF_INSTANTIATE(Real)                                                                 \
  template void PlaceOnSpheres(const HitBin&, const SurfaceView<Real>&,                         \
                               const SurfaceOutput<Real>&);                                     \
  template void BumpSurfaces(const FrameView<Real>&, const HitBin&, const SurfaceView<Real>&,   \
                             const SurfaceOutput<Real>&);                                       \
  template void FinishSurfaces(const FrameView<Real>&, const HitBin&, const SurfaceView<Real>&, \
                               const SurfaceOutput<Real>&);
SHEAF_INSTANTIATE(float)
SHEAF_INSTANTIATE(double)
#undef SHEAF_INSTANTIATE

}  // namespace sheaf
