// Reads the geometry of an object from a scene file.
#ifndef SHEAF_FORMATS_SCENE_SHAPES_H_
#define SHEAF_FORMATS_SCENE_SHAPES_H_

#include "sheaf/scene.h"
#include "src/formats/json_cursor.h"

namespace sheaf {

Sphere ReadSphere(const JsonCursor& value);

// A quad that is degenerate, bent (by more than 1e-6 of its size) or not convex is an error.
Quad ReadQuad(const JsonCursor& value);

// A triangle without area is valid: it is never hit.
Triangle ReadTriangle(const JsonCursor& value);

}  // namespace sheaf

#endif  // SHEAF_FORMATS_SCENE_SHAPES_H_
