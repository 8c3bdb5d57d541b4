#include "simd/kernels.h"

#include "simd/arithmetic.h"

namespace sheaf {

// Defined by SHEAF_EXPORT in each kernel's file.
#define SHEAF_DECLARE_FIND(NAME, field) \
  template <typename Real>              \
  NAME##Kernel<Real>* Find##NAME(std::size_t index);
#define SHEAF_FILL(NAME, field) kernels.field = SHEAF_SIMD::Find##NAME<Real>(index);
#define SHEAF_FILL_SURFACES(NAME, kind) \
  kernels.surfaces[IndexOf(PrimitiveKind::kind)] = SHEAF_SIMD::Find##NAME<Real>(index);

namespace SHEAF_SIMD {
#ifndef SHEAF_FAST
SHEAF_STRICT_KERNELS(SHEAF_DECLARE_FIND)
SHEAF_SURFACE_KERNELS(SHEAF_DECLARE_FIND)
#else
SHEAF_FAST_SURFACE_KERNELS(SHEAF_DECLARE_FIND)
#endif
SHEAF_FAST_KERNELS(SHEAF_DECLARE_FIND)
}  // namespace SHEAF_SIMD

#ifdef SHEAF_FAST
Kernels<float> FastKernels(std::int64_t target) {
  using Real = float;
  const std::size_t index = simd::DispatchIndex(target);
  Kernels<Real> kernels = StrictKernels<Real>(target);
  SHEAF_FAST_KERNELS(SHEAF_FILL)
  SHEAF_FAST_SURFACE_KERNELS(SHEAF_FILL_SURFACES)
  return kernels;
}
#else
template <typename Real>
Kernels<Real> StrictKernels(std::int64_t target) {
  const std::size_t index = simd::DispatchIndex(target);
  Kernels<Real> kernels;
  SHEAF_STRICT_KERNELS(SHEAF_FILL)
  SHEAF_FAST_KERNELS(SHEAF_FILL)
  SHEAF_SURFACE_KERNELS(SHEAF_FILL_SURFACES)
  return kernels;
}
template Kernels<float> StrictKernels(std::int64_t);
template Kernels<double> StrictKernels(std::int64_t);
#endif

#undef SHEAF_DECLARE_FIND
#undef SHEAF_FILL
#undef SHEAF_FILL_SURFACES

}  // namespace sheaf
