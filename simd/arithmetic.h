// Which arithmetic a compilation of the kernels has, and the namespace that they then live in.
//
// Kernels that gain by it are compiled twice: for `simd`, strict, and with SHEAF_FAST, which also
// lets the compiler fuse, for `simd_fast` (docs/numerics.md). kernels.h offers either as one table.
#ifndef SHEAF_SIMD_ARITHMETIC_H_
#define SHEAF_SIMD_ARITHMETIC_H_

#ifdef SHEAF_FAST
#define SHEAF_SIMD simd_fast
#else
#define SHEAF_SIMD simd
#endif

namespace sheaf::SHEAF_SIMD {

#ifdef SHEAF_FAST
inline constexpr bool kIsFast = true;
#else
inline constexpr bool kIsFast = false;
#endif

}  // namespace sheaf::SHEAF_SIMD

#endif  // SHEAF_SIMD_ARITHMETIC_H_
