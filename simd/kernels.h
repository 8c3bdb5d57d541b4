// The table of kernels: every kernel of one target and one arithmetic.
#ifndef SHEAF_SIMD_KERNELS_H_
#define SHEAF_SIMD_KERNELS_H_

#include "simd/blend_vertices.h"
#include "simd/choose_lobes.h"
#include "simd/draw_facets.h"
#include "simd/draw_samples.h"
#include "simd/face_light.h"
#include "simd/filter_noise.h"
#include "simd/find_footprints.h"
#include "simd/find_medians.h"
#include "simd/generate_primary.h"
#include "simd/generate_shadow.h"
#include "simd/instances_closest.h"
#include "simd/instances_occluded.h"
#include "simd/report_target.h"
#include "simd/sample_texture.h"
#include "simd/scatter_diffuse.h"
#include "simd/shade_ambient.h"
#include "simd/shade_light.h"
#include "simd/spawn_rays.h"
#include "simd/surfaces.h"
#include "simd/target.h"
#include "simd/trace_all.h"
#include "simd/trace_closest.h"
#include "simd/trace_occluded.h"

// The one list of kernels but for those of simd/surfaces.h, each by name and by field of the table.
// These gain nothing by fast arithmetic, and are compiled once.
#define SHEAF_STRICT_KERNELS(X)          \
  X(ReportTarget, report_target)         \
  X(GeneratePrimary, generate_primary)   \
  X(BlendVertices, blend_vertices)       \
  X(ChooseLobes, choose_lobes)           \
  X(DrawFacets, draw_facets)             \
  X(DrawSamples, draw_samples)           \
  X(FindFootprints, find_footprints)     \
  X(SampleTexture, sample_texture)       \
  X(ScatterDiffuse, scatter_diffuse)     \
  X(ShadeAmbient, shade_ambient)         \
  X(TraceAll, trace_all)                 \
  X(FaceLight, face_light)               \
  X(GenerateShadow, generate_shadow)     \
  X(FindMedians, find_medians)           \
  X(FilterNoise, filter_noise)           \
  X(InstancesClosest, instances_closest) \
  X(InstancesOccluded, instances_occluded)
// These are compiled for fast arithmetic once more (CMakeLists.txt).
#define SHEAF_FAST_KERNELS(X)      \
  X(TraceClosest, trace_closest)   \
  X(TraceOccluded, trace_occluded) \
  X(ShadeLight, shade_light)       \
  X(SpawnRays, spawn_rays)

namespace sheaf {

// Each as its header says, under NAMEKernel. Safe to call from any number of threads.
template <typename Real>
struct Kernels {
#define SHEAF_FIELD(NAME, field) NAME##Kernel<Real>* field;
  SHEAF_STRICT_KERNELS(SHEAF_FIELD)
  SHEAF_FAST_KERNELS(SHEAF_FIELD)
#undef SHEAF_FIELD
  SurfacesKernel<Real>* surfaces[kKindCount];  // by kind

  SurfacesKernel<Real>* surfaces_of(PrimitiveKind kind) const { return surfaces[IndexOf(kind)]; }
};

// `target` is a bit of simd::UsableTargets(), or 0 for the best.
template <typename Real>
Kernels<Real> StrictKernels(std::int64_t target);

// The same contracts but for the bits, which are not those of src/scalar and differ by target:
// errors as measured in docs/numerics.md.
Kernels<float> FastKernels(std::int64_t target);

}  // namespace sheaf

#endif  // SHEAF_SIMD_KERNELS_H_
