// How far rounding can carry a point, in roundoffs: shared by src/scalar and the kernels.
#ifndef SHEAF_SIMD_ROUNDOFFS_H_
#define SHEAF_SIMD_ROUNDOFFS_H_

#include <limits>

namespace sheaf {

// Half an ULP of 1: the largest relative error of one rounding.
template <typename Real>
inline constexpr Real kRoundoff = std::numeric_limits<Real>::epsilon() / 2;

// A rounded position is within one roundoff of each coordinate, the rounded start of a ray within
// another, and a triangle test that meets the same plane again in a neighbour errs by a few more:
// eight times covers them.
template <typename Real>
inline constexpr Real kPositionRoundoffs = 8 * kRoundoff<Real>;

// A sphere's point is center + radius * normal, evaluated wide: this many wide roundoffs of those
// terms.
template <typename Wide>
inline constexpr Wide kTermRoundoffs = 64 * kRoundoff<Wide>;

// How far beyond a triangle's extent, relative to its reach from the ray's origin, a hit may lie.
template <typename Real>
inline constexpr Real kExtentRoundoffs = 8 * kRoundoff<Real>;

// From a light, t = 1 is the surface and every rounding is relative to the distance d: one for the
// direction, one for a vertex seen from the light, six for t. Along the normal n that is eight
// times |n| . |d| componentwise.
template <typename Real>
inline constexpr Real kLightRoundoffs = 8 * kRoundoff<Real>;

// Lights that no shadow ray may start from (LightKind::kPointFromSurface): farther from the scene
// than this many of its diameters, kLightRoundoffs of the distance would show.
inline constexpr double kMaxLightDiameters = 64;

}  // namespace sheaf

#endif  // SHEAF_SIMD_ROUNDOFFS_H_
