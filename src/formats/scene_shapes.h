// The shapes of scene JSON, read and written.
#ifndef SHEAF_FORMATS_SCENE_SHAPES_H_
#define SHEAF_FORMATS_SCENE_SHAPES_H_

#include <string_view>
#include <vector>

#include "sheaf/scene.h"
#include "src/formats/json_cursor.h"
#include "src/formats/scene_values.h"

namespace sheaf {

using Shape = decltype(Object::shape);

// The keys of an object under which a shape may stand.
std::vector<std::string_view> ShapeKeys();

// The shape that stands under such a key.
Shape ReadShape(const JsonCursor& value);

// An object of that one key.
Json ShapeJson(const Shape& shape);

}  // namespace sheaf

#endif  // SHEAF_FORMATS_SCENE_SHAPES_H_
