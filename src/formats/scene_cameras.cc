#include "src/formats/scene_cameras.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>
#include <variant>

#include "src/core/match.h"

namespace sheaf {
namespace {

using Projection = decltype(Camera::projection);

constexpr NumberRange kFovY{kSmallestPositive, 0x1.67fffffffffffp7, "a number in (0, 180)"};
constexpr NumberRange kHeight{kSmallestPositive, 1e30, "a number in (0, 1e30]"};

Projection ReadPerspective(const JsonCursor& value) {
  Perspective perspective;
  value.Read(kFovY, &perspective.fov_y);
  return perspective;
}

Projection ReadOrthographic(const JsonCursor& value) {
  Orthographic orthographic;
  JsonObject lens(value);
  lens.Required("height").Read(kHeight, &orthographic.height);
  lens.Finish();
  return orthographic;
}

// A camera without any of them is a perspective one.
constexpr KeyedReader<Projection> kProjections[] = {{"fov_y", &ReadPerspective},
                                                    {"orthographic", &ReadOrthographic}};

void WriteProjection(const Projection& projection, Json* json) {
  Match(
      projection, [&](const Perspective& perspective) { (*json)["fov_y"] = perspective.fov_y; },
      [&](const Orthographic& orthographic) {
        (*json)["orthographic"] = {{"height", orthographic.height}};
      });
}

}  // namespace

Camera ReadCamera(const JsonCursor& value, NameTable* names) {
  Camera camera;
  JsonObject object(value);
  const JsonCursor name = object.Required("name");
  if (ReadNonEmptyName(name, &camera.name)) names->Add(camera.name, name);
  const bool has_eye = ReadVector(object.Required("eye"), &camera.eye);
  const JsonCursor look_at = object.Required("look_at");
  const bool has_target = ReadVector(look_at, &camera.look_at);
  const JsonCursor up = object.Optional("up");
  const bool has_up = !up.present() || ReadDirection(up, &camera.up);
  const JsonCursor projection = object.AtMostOneOf(KeysOf(kProjections));
  if (projection.present()) camera.projection = ReadByKey(projection, kProjections);
  object.Finish();

  if (!has_eye || !has_target || !has_up) return camera;
  const Vec3d view = camera.look_at - camera.eye;
  if (std::abs(view.x) < 1e-30 && std::abs(view.y) < 1e-30 && std::abs(view.z) < 1e-30) {
    look_at.Fail("the camera looks at its own eye");
  } else if (glm::length(glm::cross(Normalized(view), Normalized(camera.up))) < 1e-6) {
    (up.present() ? up : look_at).Fail("the view direction is parallel to up");
  }
  return camera;
}

Json CameraJson(const Camera& camera) {
  Json json = {{"name", camera.name},
               {"eye", VectorJson(camera.eye)},
               {"look_at", VectorJson(camera.look_at)},
               {"up", VectorJson(camera.up)}};
  WriteProjection(camera.projection, &json);
  return json;
}

}  // namespace sheaf
