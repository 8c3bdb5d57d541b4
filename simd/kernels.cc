#include "simd/kernels.h"

namespace sheaf {
namespace {

template <typename Real>
Kernels<Real> KernelsCompiledHere() {
  return {&SHEAF_SIMD::TraceClosest<Real>, &SHEAF_SIMD::TraceOccluded<Real>,
          &SHEAF_SIMD::SphereSurfaces<Real>, &SHEAF_SIMD::ShadeLight<Real>,
          &SHEAF_SIMD::SpawnRays<Real>};
}

}  // namespace

#ifdef SHEAF_FAST
Kernels<float> FastKernels() { return KernelsCompiledHere<float>(); }
#else
template <typename Real>
Kernels<Real> StrictKernels() {
  return KernelsCompiledHere<Real>();
}
template Kernels<float> StrictKernels();
template Kernels<double> StrictKernels();
#endif

}  // namespace sheaf
