// How far rounding can carry a point, in roundoffs: shared by src/scalar and the kernels.
#ifndef SHEAF_SIMD_ROUNDOFFS_H_
#define SHEAF_SIMD_ROUNDOFFS_H_

#include <limits>

namespace sheaf {

// Half an ULP of 1: the largest relative error of one rounding.
template <typename Real>
inline constexpr Real kRoundoff = std::numeric_limits<Real>::epsilon() / 2;

// A rounded position is within one roundoff of each coordinate and the rounded start of a ray
// within another. What is more leaves the start on its side.
template <typename Real>
inline constexpr Real kPositionRoundoffs = Real(2.5) * kRoundoff<Real>;

// A triangle's neighbours lie in its plane but for the rounding of corners: one of its own and
// three of the triangle's, as far off as they are. So the start is above what is folded up by 4
// roundoffs of |p|. Where corners lie farther off than p, triangles are that large, and the fold is
// flatter than 16 roundoffs: only a ray as flat may meet it.
template <typename Real>
inline constexpr Real kFoldRoundoffs = 6 * kRoundoff<Real>;

// A point is found wide, from center + radius * normal or from where the ray meets a plane: this
// many wide roundoffs of those terms. A test that meets the same plane again errs by as few.
template <typename Wide>
inline constexpr Wide kTermRoundoffs = 64 * kRoundoff<Wide>;

// How far beyond a triangle's extent, relative to its reach from the ray's origin, a hit may lie.
template <typename Real>
inline constexpr Real kExtentRoundoffs = 8 * kRoundoff<Real>;

// A triangle that reaches so many times as far from a ray's origin as its hit, along the dominant
// axis, has the hit's t computed wide: in float, t errs relative to the vertices.
template <typename Real>
inline constexpr Real kFarReach = 2;
// But not where t lies below the ray's start by more than this part of the reach: no rounding of a
// ray that is 2^-11 steep or more carries t so far. A ray that starts on a mesh meets the plane of
// its own triangle there.
template <typename Real>
inline constexpr Real kBehindReach = Real(0x1p-12);

// Where the squared sine of a ray above a triangle's plane is less than this, the plane tells t
// worse than the edges do: t of the plane errs by wide roundoffs over the sine, t of the edges by
// narrow ones.
template <typename Real, typename Wide>
inline constexpr Wide kFlatSquare = (kRoundoff<Wide> / static_cast<Wide>(kRoundoff<Real>)) *
                                    (kRoundoff<Wide> / static_cast<Wide>(kRoundoff<Real>));

// From a light, t = 1 is the surface and every rounding is relative to the distance d: one for the
// direction, and for a triangle of the same plane up to kFarReach for a vertex seen from the light
// and six times that for t. Along the normal n that is sixteen times |n| . |d| componentwise.
template <typename Real>
inline constexpr Real kLightRoundoffs = 16 * kRoundoff<Real>;

// Lights that no shadow ray may start from (LightKind::kPointFromSurface): farther from the scene
// than this many of its diameters, kLightRoundoffs of the distance would show.
inline constexpr double kMaxLightDiameters = 64;

}  // namespace sheaf

#endif  // SHEAF_SIMD_ROUNDOFFS_H_
