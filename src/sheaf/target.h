// The code that traces and shades: the scalar baseline or one of the SIMD targets of the processor.
#ifndef SHEAF_SHEAF_TARGET_H_
#define SHEAF_SHEAF_TARGET_H_

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sheaf/version.h"

namespace sheaf {

// Chosen for each frame or batch of rays; in strict arithmetic the choice changes no bit of a
// result. A value like an integer; nothing here throws but for want of memory, and all of it may be
// called from any number of threads.
class Target {
 public:
  // The best SIMD target that this processor runs.
  constexpr Target() = default;

  // The baseline: plain scalar code, one ray at a time.
  static constexpr Target Scalar() { return Target(kScalarId); }

  // "auto" (the best), "scalar" (the baseline), or a name of UsableTargets(). Nothing for a name
  // that is unknown or of a target that this processor does not run.
  SHEAF_API static std::optional<Target> Named(std::string_view name);

  constexpr bool is_scalar() const { return id_ == kScalarId; }

  // Like "avx2"; of the best, the name it has on this processor; "scalar" of the baseline.
  SHEAF_API std::string name() const;

  // Floats a vector, at least 1; 1 of the baseline.
  SHEAF_API int lanes() const;

  // Of the library's own use: 0 of the best, else a bit.
  constexpr std::int64_t id() const { return id_; }

  friend constexpr bool operator==(Target a, Target b) { return a.id_ == b.id_; }
  friend constexpr bool operator!=(Target a, Target b) { return a.id_ != b.id_; }

 private:
  static constexpr std::int64_t kScalarId = -1;
  explicit constexpr Target(std::int64_t id) : id_(id) {}

  std::int64_t id_ = 0;
};

// Names of the SIMD targets that the library was compiled for, best first; the baseline is not
// among them. The names are ssse3, sse4, avx2, avx3 (AVX-512), avx3_dl, neon, sve and so on, and
// hwy_scalar for kernels of one lane.
SHEAF_API std::vector<std::string> CompiledTargets();

// Those of them that this processor runs, best first; never empty.
SHEAF_API std::vector<std::string> UsableTargets();

}  // namespace sheaf

#endif  // SHEAF_SHEAF_TARGET_H_
