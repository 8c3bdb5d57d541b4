#include "src/render/find_surfaces.h"

#include "simd/shading.h"
#include "src/render/finish_surfaces.h"
#include "src/render/tint_surfaces.h"

namespace sheaf {

template <typename Real>
SurfaceView<Real> FindSurfaces(const FrameView<Real>& frame, const Kernels<Real>& kernels,
                               const HitBin& bin, const RayBatch<Real>& batch,
                               const HitView<Real>& hits, SurfaceStream<Real>& surfaces,
                               const TexelOutput<Real>& texels) {
  const MaterialData<Real>& material = frame.materials[bin.material];
  const SurfaceOutput<Real> output = surfaces.output();
  bool has_faces = false;
  kernels.surfaces_of(bin.kind)(frame.geometry, batch.rays, hits, bin.batch, material.needs,
                                output);
  if (bin.kind == PrimitiveKind::kTriangle) {
    if (material.needs & (kNeedsNormals | kNeedsTint | kNeedsVertexAlpha)) {
      kernels.blend_vertices(frame.geometry.triangles, hits, bin.batch, material.needs, output);
    }
    has_faces = (material.needs & kNeedsNormals) != 0;
  }
  const auto view = has_faces ? surfaces.view() : WithoutFaces(surfaces.view());
  if (bin.kind == PrimitiveKind::kSphere && (material.needs & kNeedsCoordinates)) {
    PlaceOnSpheres(bin, view, output);
  }
  if (material.needs & kNeedsWidth) {
    const ConeView<Real> cones = {batch.paths.width, frame.cone.width, frame.cone.spread};
    kernels.find_footprints(frame.geometry, bin.kind, cones, hits, bin.batch, material.needs, view,
                            output);
  }
  if (material.needs & kNeedsTint) TintSurfaces(frame, kernels, bin, view, texels, output);
  if (has_faces && material.finish.normals != kNoTexture) {
    BumpSurfaces(frame, kernels, bin, view, texels, output);
  }
  if (material.needs & kNeedsTerms) FinishSurfaces(frame, kernels, bin, view, texels, output);
  return view;
}

#define SHEAF_INSTANTIATE(Real)                                                           \
  template SurfaceView<Real> FindSurfaces(                                                \
      const FrameView<Real>&, const Kernels<Real>&, const HitBin&, const RayBatch<Real>&, \
      const HitView<Real>&, SurfaceStream<Real>&, const TexelOutput<Real>&);
SHEAF_INSTANTIATE(float)
SHEAF_INSTANTIATE(double)
#undef SHEAF_INSTANTIATE

}  // namespace sheaf
