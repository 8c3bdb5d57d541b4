// What is asked of the shape of an object, each with an answer for every kind of shape.
#ifndef SHEAF_SCENE_SHAPES_H_
#define SHEAF_SCENE_SHAPES_H_

#include <array>
#include <cstdint>
#include <functional>
#include <glm/vec2.hpp>
#include <string>

#include "sheaf/scene.h"
#include "simd/primitives.h"
#include "src/scene/transform.h"

namespace sheaf {

using Shape = decltype(Object::shape);

// Calls include(point) for points whose smallest box is that of the shape.
void ForEachExtreme(const Shape& shape, const std::function<void(const Vec3d&)>& include);

// Moves the shape; returns "" or why it cannot be.
std::string TransformShape(const Transform& transform, Shape* shape);

// What is traced for a shape. Fields are those of the kind's arrays; uv is of triangles.
struct ShapePrimitive {
  PrimitiveKind kind;
  std::array<double, kMaxFields> fields;
  std::array<glm::dvec2, 3> uv;
};

// Calls add(primitive) for those of a shape, in order. A mesh's are its triangles, which share
// vertices: none is called for.
void ForEachPrimitive(const Shape& shape, const std::function<void(const ShapePrimitive&)>& add);

// Calls f(object) for the objects of a scene and then those of its groups, in order: by the numbers
// that frames give them.
template <typename F>
void ForEachObject(const Scene& scene, F f) {
  for (const Object& object : scene.objects) f(object);
  for (const Group& group : scene.groups) {
    for (const Object& object : group.objects) f(object);
  }
}

// The object of such a number.
const Object& ObjectAt(const Scene& scene, std::size_t number);

// How many primitives of each kind the objects of a scene and its groups are; a quad is two
// triangles.
CountsByKind<std::uint64_t> CountPrimitives(const Scene& scene);

}  // namespace sheaf

#endif  // SHEAF_SCENE_SHAPES_H_
