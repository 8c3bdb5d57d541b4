// The SIMD targets that the kernels are compiled for.
//
// Names are Highway's in lower case (ssse3, sse4, avx2, avx3, avx3_dl, neon, ...). Highway's own
// one-lane fallback is called hwy_scalar, because `scalar` names the baseline in src/scalar.
#ifndef SHEAF_SIMD_TARGET_H_
#define SHEAF_SIMD_TARGET_H_

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace sheaf::simd {

// Highway's bits of the targets that the kernels were compiled for, best first.
std::vector<std::int64_t> CompiledTargets();

// Those of them that this processor runs, best first; never empty.
std::vector<std::int64_t> UsableTargets();

std::string TargetName(std::int64_t target);

// Where Highway's tables have the usable target, or the best where `target` is 0.
std::size_t DispatchIndex(std::int64_t target);

}  // namespace sheaf::simd

#endif  // SHEAF_SIMD_TARGET_H_
