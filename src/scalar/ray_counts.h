// How many rays of each kind a frame took.
#ifndef SHEAF_SCALAR_RAY_COUNTS_H_
#define SHEAF_SCALAR_RAY_COUNTS_H_

#include <cstdint>

namespace sheaf {

// Reflected and refracted rays are counted where they are spawned. Of these, `beyond_depth` are
// deeper than the limit: black, and not traced.
struct RayCounts {
  std::uint64_t primary = 0, shadow = 0, reflected = 0, refracted = 0;
  std::uint64_t beyond_depth = 0;
  std::uint64_t traced() const { return primary + shadow + reflected + refracted - beyond_depth; }
  RayCounts& operator+=(const RayCounts& other) {
    primary += other.primary;
    shadow += other.shadow;
    reflected += other.reflected;
    refracted += other.refracted;
    beyond_depth += other.beyond_depth;
    return *this;
  }
};

}  // namespace sheaf

#endif  // SHEAF_SCALAR_RAY_COUNTS_H_
