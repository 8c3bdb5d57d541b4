// What the vertices of triangles carry besides positions: normals, colours, alphas, a second
// set of coordinates.
#ifndef SHEAF_SIMD_BLEND_VERTICES_H_
#define SHEAF_SIMD_BLEND_VERTICES_H_

#include "simd/shading.h"
#include "simd/streams.h"
#include "simd/tree.h"

namespace sheaf {

// Of surfaces[0, batch.count) that TriangleSurfaces left: with kNeedsNormals in `needs` keeps the
// face's normal as the face, and puts the shading normal in its place where the vertices have one;
// where NeedsCurves(needs) writes where shadow rays end and the bend; with kNeedsTint writes the
// tint; with kNeedsVertexAlpha the alpha; with kNeedsSecondSet u2 and v2. Bits: as
// sheaf::scalar::TriangleSurface. Reads and writes PaddedCount(batch.count) lanes.
template <typename Real>
using BlendVerticesKernel = void(const TriangleArrays<Real>& triangles, const HitView<Real>& hits,
                                 const HitBatch& batch, std::uint32_t needs,
                                 const SurfaceOutput<Real>& surfaces);

}  // namespace sheaf

#endif  // SHEAF_SIMD_BLEND_VERTICES_H_
