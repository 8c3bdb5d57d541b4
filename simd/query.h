// What is asked of a ray, and what a caller knows of a batch of them.
#ifndef SHEAF_SIMD_QUERY_H_
#define SHEAF_SIMD_QUERY_H_

#include <cstdint>
#include <limits>

namespace sheaf {

// Primitive ids are positions in the input order, below kNoPrimitive.
inline constexpr std::uint32_t kNoPrimitive = 0x7fffffffu;
// A ray's `source` is the primitive it starts on. A triangle or a sphere that is the source is
// never hit, unless this bit says that the ray runs inside the sphere: then its far root alone
// counts.
inline constexpr std::uint32_t kInsideBit = 0x80000000u;

// Instances are numbered from 0, below 2^26. What belongs to none of them, as the primitives of a
// scene's own geometry, belongs to kNoInstance.
inline constexpr std::uint32_t kNoInstance = 0xffffffffu;

// A hit at t counts where t_min <= t <= t_max and t is finite. By default t_min is the smallest
// normal number, so that a hit at 0 does not count, whether or not the host flushes denormals to 0;
// and t_max is the largest finite one.
template <typename Real>
inline constexpr Real kDefaultTMin = std::numeric_limits<Real>::min();
template <typename Real>
inline constexpr Real kDefaultTMax = std::numeric_limits<Real>::max();

// The intervals of a batch of rays: an array where each ray has its own, else one value for all.
template <typename Real>
struct RayIntervals {
  const Real* t_min = nullptr;
  const Real* t_max = nullptr;
  Real all_t_min = kDefaultTMin<Real>;
  Real all_t_max = kDefaultTMax<Real>;
};

// What is asked of a ray: its nearest hit, or whether there is any.
enum class Query { kClosest, kOccluded };

// What a caller knows of a batch of rays. It may steer the choice of a kernel, never a result.
enum class Coherence {
  kUnknown,       // measured, packet by packet
  kCommonOrigin,  // the same, but no common direction is looked for
  kCoherent,      // neighbours go similar ways from different origins: packets as they come
  kIncoherent,    // neighbours go different ways: sorted by direction before anything else
};

}  // namespace sheaf

#endif  // SHEAF_SIMD_QUERY_H_
