// Choosing the float or the double version of a kernel, on the target in force.
//
// Every kernel file follows one pattern. Highway compiles it once a target (foreach_target.h);
// there the template over the lane type gets two names, NAMEF32 and NAMEF64, which HWY_EXPORT puts
// into a table by target. Once, under HWY_ONCE, the public function looks up the table: one
// dispatch a batch.
#ifndef SHEAF_SIMD_DISPATCH_H_
#define SHEAF_SIMD_DISPATCH_H_

#include <type_traits>

#include "hwy/highway.h"
#include "simd/arithmetic.h"

namespace sheaf::SHEAF_SIMD {

template <typename Real, typename FloatKernel, typename DoubleKernel>
constexpr auto KernelFor(FloatKernel* for_float, DoubleKernel* for_double) {
  if constexpr (std::is_same_v<Real, float>) {
    return for_float;
  } else {
    return for_double;
  }
}

}  // namespace sheaf::SHEAF_SIMD

// NAMEF32 and NAMEF64, HWY_EXPORT of both, and the public function for float and double. Fast
// arithmetic is for float alone.
#ifdef SHEAF_FAST
#define SHEAF_NAME_KERNELS(NAME) constexpr auto& NAME##F32 = NAME##Lanes<float>
#define SHEAF_EXPORT(NAME) HWY_EXPORT(NAME##F32)
#define SHEAF_INSTANTIATE(NAME) template decltype(NAME<float>) NAME<float>
#define SHEAF_DISPATCH(Real, NAME) HWY_DYNAMIC_DISPATCH(NAME##F32)
#else
#define SHEAF_NAME_KERNELS(NAME)                  \
  constexpr auto& NAME##F32 = NAME##Lanes<float>; \
  constexpr auto& NAME##F64 = NAME##Lanes<double>
#define SHEAF_EXPORT(NAME) \
  HWY_EXPORT(NAME##F32);   \
  HWY_EXPORT(NAME##F64)
#define SHEAF_INSTANTIATE(NAME)               \
  template decltype(NAME<float>) NAME<float>; \
  template decltype(NAME<double>) NAME<double>
#define SHEAF_DISPATCH(Real, NAME) \
  KernelFor<Real>(HWY_DYNAMIC_DISPATCH(NAME##F32), HWY_DYNAMIC_DISPATCH(NAME##F64))
#endif

#endif  // SHEAF_SIMD_DISPATCH_H_
