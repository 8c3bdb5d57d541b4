// The kernels that exist in strict and in fast arithmetic, as tables to choose from at run time.
#ifndef SHEAF_SIMD_KERNELS_H_
#define SHEAF_SIMD_KERNELS_H_

#include "simd/arithmetic.h"
#include "simd/shade_light.h"
#include "simd/spawn_rays.h"
#include "simd/sphere_surface.h"
#include "simd/trace_closest.h"
#include "simd/trace_occluded.h"

namespace sheaf {

// Each as its header says, on the target in force.
template <typename Real>
struct Kernels {
  decltype(&SHEAF_SIMD::TraceClosest<Real>) trace_closest;
  decltype(&SHEAF_SIMD::TraceOccluded<Real>) trace_occluded;
  decltype(&SHEAF_SIMD::SphereSurfaces<Real>) sphere_surfaces;
  decltype(&SHEAF_SIMD::ShadeLight<Real>) shade_light;
  decltype(&SHEAF_SIMD::SpawnRays<Real>) spawn_rays;
};

template <typename Real>
Kernels<Real> StrictKernels();

// The same contracts but for the bits, which are not those of src/scalar and differ by target:
// errors as measured in docs/numerics.md.
Kernels<float> FastKernels();

}  // namespace sheaf

#endif  // SHEAF_SIMD_KERNELS_H_
