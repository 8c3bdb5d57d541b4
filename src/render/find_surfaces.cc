#include "src/render/find_surfaces.h"

#include "simd/shading.h"
#include "src/render/finish_surfaces.h"
#include "src/render/tint_surfaces.h"

namespace sheaf {

namespace {

// The step from surfaces to what their rays' cones cover. The second set of coordinates goes
// through the same kernel in the place of the first.
template <typename Real>
void MeasureFootprints(const FrameView<Real>& frame, const Kernels<Real>& kernels,
                       const HitBin& bin, const ConeView<Real>& cones, const HitView<Real>& hits,
                       const SurfaceView<Real>& surfaces, SurfaceOutput<Real> footprints) {
  const std::uint32_t needs = frame.materials[bin.material].needs;
  kernels.find_footprints(frame.geometry, bin.kind, cones, hits, bin.batch, needs, surfaces,
                          footprints);
  constexpr std::uint32_t kBoth = kNeedsSecondSet | kNeedsFootprint;
  if ((needs & kBoth) != kBoth || bin.kind != PrimitiveKind::kTriangle) return;
  GeometryView<Real> second = frame.geometry;
  for (int vertex = 0; vertex < 3; ++vertex) {
    for (int axis = 0; axis < 2; ++axis) {
      second.triangles.uv[vertex][axis] = second.triangles.uv2[vertex][axis];
    }
  }
  footprints.footprint_u = footprints.footprint_u2;
  footprints.footprint_v = footprints.footprint_v2;
  kernels.find_footprints(second, bin.kind, cones, hits, bin.batch, needs, surfaces, footprints);
}

}  // namespace

template <typename Real>
SurfaceView<Real> FindSurfaces(const FrameView<Real>& frame, const Kernels<Real>& kernels,
                               const HitBin& bin, const RayBatch<Real>& batch,
                               const HitView<Real>& hits, const InstancedHits<Real>& instanced,
                               SurfaceStream<Real>& surfaces, const TexelOutput<Real>& texels) {
  const MaterialData<Real>& material = frame.materials[bin.material];
  const SurfaceOutput<Real> output = surfaces.output();
  bool has_faces = false;
  kernels.surfaces_of(bin.kind)(frame.geometry, batch.rays, hits, bin.batch, material.needs,
                                output);
  if (bin.kind == PrimitiveKind::kTriangle) {
    if (material.needs & (kNeedsNormals | kNeedsTint | kNeedsVertexAlpha | kNeedsSecondSet)) {
      kernels.blend_vertices(frame.geometry.triangles, hits, bin.batch, material.needs, output);
    }
    has_faces = (material.needs & kNeedsNormals) != 0;
  }
  SurfaceView<Real> view = has_faces ? surfaces.view() : WithoutFaces(surfaces.view());
  if (bin.kind != PrimitiveKind::kTriangle) view = WithOneSet(view);
  if (bin.kind == PrimitiveKind::kSphere && (material.needs & kNeedsCoordinates)) {
    PlaceOnSpheres(bin, view, output);
  }
  if (material.needs & kNeedsWidth) {
    const ConeView<Real> cones = {batch.paths.width, frame.cone.width, frame.cone.spread};
    MeasureFootprints(frame, kernels, bin, cones, hits, view, output);
    instanced.StretchFootprints(bin, output);
  }
  if (material.needs & kNeedsTint) TintSurfaces(frame, kernels, bin, view, texels, output);
  if (has_faces && material.finish.normals != kNoTexture) {
    BumpSurfaces(frame, kernels, bin, view, texels, output);
  }
  instanced.Place(bin, view, output);
  if (material.needs & kNeedsTerms) FinishSurfaces(frame, kernels, bin, view, texels, output);
  return view;
}

#define SHEAF_INSTANTIATE(Real)                                                             \
  template SurfaceView<Real> FindSurfaces(const FrameView<Real>&, const Kernels<Real>&,     \
                                          const HitBin&, const RayBatch<Real>&,             \
                                          const HitView<Real>&, const InstancedHits<Real>&, \
                                          SurfaceStream<Real>&, const TexelOutput<Real>&);
SHEAF_INSTANTIATE(float)
SHEAF_INSTANTIATE(double)
#undef SHEAF_INSTANTIATE

}  // namespace sheaf
