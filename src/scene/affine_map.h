// Affine maps as rows of doubles, and back.
#ifndef SHEAF_SCENE_AFFINE_MAP_H_
#define SHEAF_SCENE_AFFINE_MAP_H_

#include <string>

#include "simd/instances.h"
#include "src/scene/transform.h"

namespace sheaf {

// A map whose |M| |M^-1| has a larger sum of a row flattens: hits would be too far off.
inline constexpr double kMaxCondition = 1e6;

AffineMap MapOf(const Transform& transform);

// "", or what is wrong with a map to the world.
std::string FaultOf(const AffineMap& to_world);

// The map back, of one that has no fault; and the largest sum of a row of |M| |M^-1|.
AffineMap InverseOf(const AffineMap& map);
double ConditionOf(const AffineMap& map, const AffineMap& inverse);

}  // namespace sheaf

#endif  // SHEAF_SCENE_AFFINE_MAP_H_
