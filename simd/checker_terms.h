// What filtered checkers are computed with, in src/scalar and in the kernels.
#ifndef SHEAF_SIMD_CHECKER_TERMS_H_
#define SHEAF_SIMD_CHECKER_TERMS_H_

namespace sheaf {

// A box of this many cells has as many of either kind: it has the mean of both, and so have larger
// ones.
inline constexpr int kManyCells = 1024;

}  // namespace sheaf

#endif  // SHEAF_SIMD_CHECKER_TERMS_H_
