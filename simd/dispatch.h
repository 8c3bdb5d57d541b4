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

namespace sheaf::simd {

template <typename Real, typename FloatKernel, typename DoubleKernel>
constexpr auto KernelFor(FloatKernel* for_float, DoubleKernel* for_double) {
  if constexpr (std::is_same_v<Real, float>) {
    return for_float;
  } else {
    return for_double;
  }
}

}  // namespace sheaf::simd

#define SHEAF_DISPATCH(Real, NAME) \
  KernelFor<Real>(HWY_DYNAMIC_DISPATCH(NAME##F32), HWY_DYNAMIC_DISPATCH(NAME##F64))

#endif  // SHEAF_SIMD_DISPATCH_H_
