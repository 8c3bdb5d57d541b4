// The tables through which a kernel is found by target.
//
// Every kernel file follows one pattern. Highway compiles it once a target (foreach_target.h);
// there the template over the lane type gets two names, NAMEF32 and NAMEF64, which HWY_EXPORT puts
// into a table by target. Once, under HWY_ONCE, SHEAF_EXPORT makes those tables and a function that
// looks one up, which simd/kernels.cc calls: one look-up a frame or a batch.
#ifndef SHEAF_SIMD_DISPATCH_H_
#define SHEAF_SIMD_DISPATCH_H_

#include <cstddef>
#include <type_traits>

#include "hwy/highway.h"
#include "simd/arithmetic.h"

namespace sheaf {

// Where a kernel for one target has no table but one entry, as without dynamic dispatch, that is
// it.
template <typename Kernel, std::size_t kSize>
constexpr Kernel* EntryOf(Kernel* const (&table)[kSize], std::size_t index) {
  return table[kSize == 1 ? 0 : index];
}

}  // namespace sheaf

// Names the float and the double version of NAMELanes, inside HWY_NAMESPACE; and, outside, defines
// NAMEKernel<Real>* FindNAME<Real>(index) by DispatchIndex of simd/target.h. Fast arithmetic is for
// float alone.
#ifdef SHEAF_FAST
#define SHEAF_NAME_KERNELS(NAME) constexpr auto& NAME##F32 = NAME##Lanes<float>
#define SHEAF_EXPORT(NAME)                                \
  HWY_EXPORT(NAME##F32);                                  \
  template <typename Real>                                \
  NAME##Kernel<Real>* Find##NAME(std::size_t index) {     \
    return EntryOf(HWY_DISPATCH_TABLE(NAME##F32), index); \
  }                                                       \
  template NAME##Kernel<float>* Find##NAME<float>(std::size_t)
#else
#define SHEAF_NAME_KERNELS(NAME)                  \
  constexpr auto& NAME##F32 = NAME##Lanes<float>; \
  constexpr auto& NAME##F64 = NAME##Lanes<double>
#define SHEAF_EXPORT(NAME)                                      \
  HWY_EXPORT(NAME##F32);                                        \
  HWY_EXPORT(NAME##F64);                                        \
  template <typename Real>                                      \
  NAME##Kernel<Real>* Find##NAME(std::size_t index) {           \
    if constexpr (std::is_same_v<Real, float>) {                \
      return EntryOf(HWY_DISPATCH_TABLE(NAME##F32), index);     \
    } else {                                                    \
      return EntryOf(HWY_DISPATCH_TABLE(NAME##F64), index);     \
    }                                                           \
  }                                                             \
  template NAME##Kernel<float>* Find##NAME<float>(std::size_t); \
  template NAME##Kernel<double>* Find##NAME<double>(std::size_t)
#endif

#endif  // SHEAF_SIMD_DISPATCH_H_
