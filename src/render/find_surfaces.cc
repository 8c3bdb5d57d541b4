#include "src/render/find_surfaces.h"

#include "simd/shading.h"
#include "src/render/finish_surfaces.h"
#include "src/render/tint_surfaces.h"

namespace sheaf {

template <typename Real>
SurfaceView<Real> FindSurfaces(const FrameView<Real>& frame, const Kernels<Real>& kernels,
                               const HitBin& bin, const RayView<Real>& rays,
                               const HitView<Real>& hits, SurfaceStream<Real>& surfaces) {
  const MaterialData<Real>& material = frame.materials[bin.material];
  const SurfaceOutput<Real> output = surfaces.output();
  bool has_faces = false;
  kernels.surfaces_of(bin.kind)(frame.geometry, rays, hits, bin.batch, material.needs, output);
  if (bin.kind == PrimitiveKind::kTriangle) {
    if (material.needs & (kNeedsNormals | kNeedsTint)) {
      kernels.blend_vertices(frame.geometry.triangles, hits, bin.batch, material.needs, output);
    }
    has_faces = (material.needs & kNeedsNormals) != 0;
  }
  const auto view = has_faces ? surfaces.view() : WithoutFaces(surfaces.view());
  if (bin.kind == PrimitiveKind::kSphere && (material.needs & kNeedsCoordinates)) {
    PlaceOnSpheres(bin, view, output);
  }
  if (material.needs & kNeedsTint) TintSurfaces(material, frame.textures, bin, view, output);
  if (has_faces && material.finish.normals != kNoTexture) BumpSurfaces(frame, bin, view, output);
  if (material.needs & kNeedsTerms) FinishSurfaces(frame, bin, view, output);
  return view;
}

template SurfaceView<float> FindSurfaces(const FrameView<float>&, const Kernels<float>&,
                                         const HitBin&, const RayView<float>&,
                                         const HitView<float>&, SurfaceStream<float>&);
template SurfaceView<double> FindSurfaces(const FrameView<double>&, const Kernels<double>&,
                                          const HitBin&, const RayView<double>&,
                                          const HitView<double>&, SurfaceStream<double>&);

}  // namespace sheaf
