#include "src/formats/scene_transform.h"

#include <glm/matrix.hpp>

#include "src/formats/scene_values.h"

namespace sheaf {
namespace {

constexpr NumberRange kDegrees{-1e6, 1e6, "a number in [-1e6, 1e6]"};
constexpr NumberRange kFactor{-1e30, 1e30, "a number in [-1e30, 1e30]"};

Transform ReadScale(const JsonCursor& value) {
  Transform transform;
  Vec3d scale(1.0);
  double uniform = 1;
  if (value.Is(JsonKind::kNumber)) {
    value.Read(kFactor, &uniform);
    scale = Vec3d(uniform);
  } else {
    ReadVector(value, &scale);
  }
  if (scale.x == 0 || scale.y == 0 || scale.z == 0) value.Fail("a scale of 0 leaves nothing");
  for (int axis = 0; axis < 3; ++axis) transform.linear[axis] *= scale[axis];
  return transform;
}

Transform ReadRotation(const JsonCursor& value) {
  Vec3d axis(0.0, 1.0, 0.0);
  double degrees = 0;
  JsonObject object(value);
  ReadDirection(object.Required("axis"), &axis);
  object.Required("degrees").Read(kDegrees, &degrees);
  object.Finish();
  return RotationAbout(axis, degrees);
}

// Three rows of four numbers.
Transform ReadMatrix(const JsonCursor& value) {
  Transform transform;
  const auto rows = value.ReadTuple<3>("3 rows of 4 numbers");
  if (!rows) return transform;
  for (int row = 0; row < 3; ++row) {
    const auto cells = (*rows)[static_cast<std::size_t>(row)].ReadTuple<4>("4 numbers");
    if (!cells) return transform;
    for (int column = 0; column < 3; ++column) {
      (*cells)[static_cast<std::size_t>(column)].Read(kFactor, &transform.linear[column][row]);
    }
    (*cells)[3].Read(kFactor, &transform.translation[row]);
  }
  if (!(glm::determinant(transform.linear) != 0)) value.Fail("the matrix is singular");
  return transform;
}

Transform ReadStep(const JsonCursor& value) {
  Transform transform;
  JsonObject object(value);
  const JsonCursor step = object.OneOf({"translate", "rotate", "scale", "matrix"});
  if (step.present()) {
    if (step.key() == "translate") ReadVector(step, &transform.translation);
    if (step.key() == "rotate") transform = ReadRotation(step);
    if (step.key() == "scale") transform = ReadScale(step);
    if (step.key() == "matrix") transform = ReadMatrix(step);
  }
  object.Finish();
  return transform;
}

}  // namespace

Transform ReadTransform(const JsonCursor& value) {
  if (!value.present()) return {};
  if (!value.Is(JsonKind::kArray)) return ReadStep(value);
  Transform transform;
  value.ForEachElement([&](const JsonCursor& step) { transform = ReadStep(step) * transform; });
  return transform;
}

}  // namespace sheaf
