// What makes vectors directions, and a camera a view: one place for readers and for Validate.
#ifndef SHEAF_SCENE_DIRECTION_H_
#define SHEAF_SCENE_DIRECTION_H_

#include "sheaf/scene.h"

namespace sheaf {

// In size.
double LargestComponent(const Vec3d& vector);

// Whether the largest component is at least 1e-30 in size; false for NaN there.
bool GivesDirection(const Vec3d& vector);

// Whether both give directions, of which neither is the other's or its opposite.
bool SpansPlane(const Vec3d& u, const Vec3d& v);

// Unit length, of a vector that gives a direction.
Vec3d Normalized(const Vec3d& vector);

enum class ViewFault { kNone, kNoDirection, kParallelToUp };

// What keeps a camera, whose vectors are finite and whose up gives a direction, from a view.
ViewFault FindViewFault(const Camera& camera);
// "" for none.
const char* TextOf(ViewFault fault);

// Whether light is divided by more than 0: one of the terms is at least `least`.
bool HasTerm(const Falloff& falloff, double least);

}  // namespace sheaf

#endif  // SHEAF_SCENE_DIRECTION_H_
