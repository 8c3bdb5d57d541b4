#include "src/formats/scene_cameras.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <variant>

#include "src/core/strict_tan.h"
#include "src/formats/suggest_name.h"
#include "src/scene/direction.h"
#include "src/scene/projection.h"

namespace sheaf {
namespace {

// `projection` with the number that `value` holds, if any.
Projection ProjectionOf(const JsonCursor& value, Projection projection) {
  const ProjectionKind& kind = KindOf(projection);
  double number = ParameterOf(projection);
  value.Read({kSmallestPositive, kind.largest, kind.range}, &number);
  SetParameter(projection, number);
  return projection;
}

Projection ReadPerspective(const JsonCursor& value) { return ProjectionOf(value, Perspective()); }

Projection ReadOrthographic(const JsonCursor& value) {
  JsonObject lens(value);
  const Projection projection = ProjectionOf(lens.Required("height"), Orthographic());
  lens.Finish();
  return projection;
}

// The keys that say it without a name. A camera without any of them is a perspective one.
constexpr KeyedReader<Projection> kProjections[] = {{"fov_y", &ReadPerspective},
                                                    {"orthographic", &ReadOrthographic}};

// A name, or an object of one member, by the name: {"name": {"number's name": number}}.
Projection ReadProjection(const JsonCursor& value) {
  if (!value.Is(JsonKind::kObject)) {
    std::string name;
    if (!value.ReadString(&name)) return {};
    if (const auto projection = ProjectionNamed(name)) return *projection;
    value.Fail("unknown projection" + DidYouMean(name, ProjectionNames()));
    return {};
  }
  JsonObject object(value);
  Projection projection;
  int count = 0;
  for (const std::string_view name : ProjectionNames()) {
    const JsonCursor member = object.Optional(name);
    if (!member.present()) continue;
    ++count;
    projection = *ProjectionNamed(name);
    JsonObject lens(member);
    if (KindOf(projection).unit != ProjectionUnit::kNone) {
      projection = ProjectionOf(lens.Optional(KindOf(projection).parameter), projection);
    }
    lens.Finish();
  }
  object.Finish();
  if (count != 1) value.Fail("one projection has to stand here");
  return projection;
}

void WriteProjection(const Projection& projection, Json* json) {
  const ProjectionKind& kind = KindOf(projection);
  const double number = ParameterOf(projection);
  if (std::holds_alternative<Perspective>(projection)) {
    (*json)["fov_y"] = number;
  } else if (std::holds_alternative<Orthographic>(projection)) {
    (*json)["orthographic"] = {{"height", number}};
  } else if (kind.unit == ProjectionUnit::kNone) {
    (*json)["projection"] = kind.name;
  } else {
    (*json)["projection"] = {{kind.name, {{kind.parameter, number}}}};
  }
}

constexpr NumberRange kFrame{-kMaxFrame, kMaxFrame, "a number in [-1e6, 1e6]"};

// What a key leaves out is the camera's own.
CameraKey ReadKey(const JsonCursor& value, const Camera& camera) {
  CameraKey key{0, camera.eye, camera.look_at, ParameterOf(camera.projection)};
  JsonObject object(value);
  object.Required("frame").Read(kFrame, &key.frame);
  ReadVector(object.Optional("eye"), &key.eye);
  ReadVector(object.Optional("look_at"), &key.look_at);
  for (const ProjectionKind& kind : kProjectionKinds) {
    if (kind.unit == ProjectionUnit::kNone) continue;
    const JsonCursor lens = object.Optional(kind.parameter);
    if (!lens.Read({kSmallestPositive, kind.largest, kind.range}, &key.lens)) continue;
    if (&kind == &KindOf(camera.projection)) continue;
    lens.Fail(fmt::format("is not of the camera's projection, {}", KindOf(camera.projection).name));
  }
  object.Finish();
  return key;
}

void ReadPath(const JsonCursor& value, Camera* camera) {
  if (value.Is(JsonKind::kArray) && value.IsEmpty()) value.Fail("a path needs at least one key");
  value.ForEachElement([&](const JsonCursor& element) {
    const CameraKey key = ReadKey(element, *camera);
    if (!camera->path.empty() && !(camera->path.back().frame < key.frame)) {
      element.Fail("its frame does not come after that of the key before");
    }
    camera->path.push_back(key);
  });
}

Json PathJson(const Camera& camera) {
  const ProjectionKind& kind = KindOf(camera.projection);
  Json path = Json::array();
  for (const CameraKey& key : camera.path) {
    path.push_back(
        {{"frame", key.frame}, {"eye", VectorJson(key.eye)}, {"look_at", VectorJson(key.look_at)}});
    if (kind.unit != ProjectionUnit::kNone) path.back()[kind.parameter] = key.lens;
  }
  return path;
}

constexpr NumberRange kLensLength{1e-30, kMaxCoordinate, "a number in [1e-30, 1e30]"};
constexpr NumberRange kStop{1e-3, 1e6, "a number in [0.001, 1e6]"};
constexpr NumberRange kBlades{0, 64, "0 or an integer in [3, 64]"};
constexpr NumberRange kBladeTurn{-1e6, 1e6, "a number in [-1e6, 1e6]"};

// Of a full-frame camera, in metres.
constexpr double kUsualSensor = 0.024;

// The aperture's diameter: the focal length, by which a sensor of that height sees the camera's
// angle, over the f-number.
double ApertureOf(const Perspective& perspective, double sensor, double f_stop) {
  return sensor / (2 * StrictTanDegrees(perspective.fov_y / 2)) / f_stop;
}

Lens ReadLens(const JsonCursor& value, const Camera& camera) {
  Lens lens;
  JsonObject object(value);
  const JsonCursor opening = object.OneOf({"aperture", "f_stop"});
  const JsonCursor sensor = object.Optional("sensor");
  double sensor_height = kUsualSensor, f_stop = 0;
  sensor.Read(kLensLength, &sensor_height);
  if (opening.present() && opening.key() == "f_stop") {
    const auto* perspective = std::get_if<Perspective>(&camera.projection);
    if (perspective == nullptr) {
      opening.Fail("only perspective cameras have an f-number; say \"aperture\"");
    } else if (opening.Read(kStop, &f_stop)) {
      lens.aperture = ApertureOf(*perspective, sensor_height, f_stop);
      if (!(lens.aperture >= kLensLength.low && lens.aperture <= kLensLength.high)) {
        opening.Fail(fmt::format("the aperture would be {:.6g}", lens.aperture));
      }
    }
  } else {
    opening.Read(kLensLength, &lens.aperture);
    sensor.Fail("only \"f_stop\" needs a sensor");
  }
  double focus = 0;
  if (object.Optional("focus").Read(kLensLength, &focus)) lens.focus = focus;
  const JsonCursor blades = object.Optional("blades");
  if (blades.ReadInteger(kBlades, &lens.blades) && lens.blades > 0 && lens.blades < 3) {
    blades.Fail("0 or an integer in [3, 64] is wanted");
  }
  object.Optional("rotation").Read(kBladeTurn, &lens.rotation);
  object.Finish();
  if (KindOf(camera.projection).surface != ProjectionSurface::kPlane) {
    value.Fail(fmt::format("{} cameras have no lens", KindOf(camera.projection).name));
  }
  return lens;
}

Json LensJson(const Lens& lens) {
  Json json = {{"aperture", lens.aperture}};
  if (lens.focus) json["focus"] = *lens.focus;
  if (lens.blades > 0) json["blades"] = lens.blades;
  if (lens.rotation != 0) json["rotation"] = lens.rotation;
  return json;
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
  const JsonCursor lens = object.AtMostOneOf(KeysOf(kProjections));
  if (lens.present()) camera.projection = ReadByKey(lens, kProjections);
  const JsonCursor projection = object.Optional("projection");
  if (projection.present()) {
    camera.projection = ReadProjection(projection);
    if (lens.present()) projection.Fail(fmt::format("conflicts with \"{}\"", lens.key()));
  }
  if (const JsonCursor thin = object.Optional("lens"); thin.present()) {
    camera.lens = ReadLens(thin, camera);
  }
  ReadPath(object.Optional("path"), &camera);
  object.Finish();

  if (!has_eye || !has_target || !has_up) return camera;
  const ViewFault fault = FindViewFault(camera);
  if (fault != ViewFault::kNone) {
    const bool is_up = fault == ViewFault::kParallelToUp && up.present();
    (is_up ? up : look_at).Fail(TextOf(fault));
  }
  return camera;
}

Json CameraJson(const Camera& camera) {
  Json json = {{"name", camera.name},
               {"eye", VectorJson(camera.eye)},
               {"look_at", VectorJson(camera.look_at)},
               {"up", VectorJson(camera.up)}};
  WriteProjection(camera.projection, &json);
  if (camera.lens) json["lens"] = LensJson(*camera.lens);
  if (!camera.path.empty()) json["path"] = PathJson(camera);
  return json;
}

}  // namespace sheaf
