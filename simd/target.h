// Lists, forces and names the SIMD targets that the kernels are compiled for.
//
// Names are Highway's in lower case (ssse3, sse4, avx2, avx3, avx3_dl, neon, ...). Highway's own
// one-lane fallback is called hwy_scalar, because `scalar` names the baseline in src/scalar.
#ifndef SHEAF_SIMD_TARGET_H_
#define SHEAF_SIMD_TARGET_H_

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace sheaf::simd {

// Targets the kernels were compiled for, best first.
std::vector<std::string> CompiledTargets();

// Those of them that this processor runs, best first; never empty.
std::vector<std::string> UsableTargets();

// Every later kernel call of the process runs `name` ("auto": the best usable). Returns false, and
// changes nothing, where the target is unknown or not usable. Not to be called while kernels run.
bool ForceTarget(std::string_view name);

// The name of the target that a kernel call runs on now, as reported from inside such a call.
std::string RunningTarget();

// float lanes a vector on the running target.
std::size_t RunningLanes();

}  // namespace sheaf::simd

#endif  // SHEAF_SIMD_TARGET_H_
