#include "src/formats/scene_lights.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string_view>
#include <variant>

#include "src/core/match.h"
#include "src/formats/suggest_name.h"
#include "src/scene/direction.h"

namespace sheaf {
namespace {

using Source = decltype(Light::source);

// Times a colour and an exposure, both up to 1e6, this still fits a float.
constexpr NumberRange kIntensity{0.0, 1e24, "a number in [0, 1e24]"};
constexpr NumberRange kFalloffTerm{0.0, 1e30, "a number in [0, 1e30]"};

struct NamedFalloff {
  std::string_view name;
  Falloff falloff;
};
constexpr NamedFalloff kFalloffs[] = {
    {"inverse-square", {0.0, 0.0, 1.0}},
    {"linear", {0.0, 1.0, 0.0}},
    {"constant", {1.0, 0.0, 0.0}},
};
constexpr std::string_view kFalloffText =
    "\"inverse-square\", \"linear\", \"constant\" or [kc, kl, kq]";

void ReadFalloff(const JsonCursor& value, Falloff* out) {
  if (value.Is(JsonKind::kString)) {
    std::vector<std::string_view> known;
    for (const NamedFalloff& entry : kFalloffs) {
      if (value.text() == entry.name) {
        *out = entry.falloff;
        return;
      }
      known.push_back(entry.name);
    }
    return value.Fail(fmt::format("expected {}{}", kFalloffText, DidYouMean(value.text(), known)));
  }
  const auto terms = value.ReadTuple<3>(kFalloffText);
  if (!terms) return;
  Falloff falloff{0.0, 0.0, 0.0};
  const bool constant = (*terms)[0].Read(kFalloffTerm, &falloff.constant);
  const bool linear = (*terms)[1].Read(kFalloffTerm, &falloff.linear);
  const bool quadratic = (*terms)[2].Read(kFalloffTerm, &falloff.quadratic);
  if (!constant || !linear || !quadratic) return;
  // Smaller terms would be zero in a float, and light would be divided by it.
  if (!HasTerm(falloff, 1e-30)) return value.Fail("one of the terms must be at least 1e-30");
  *out = falloff;
}

Source ReadPointLight(const JsonCursor& value) {
  PointLight light;
  JsonObject object(value);
  ReadVector(object.Required("position"), &light.position);
  ReadFalloff(object.Optional("falloff"), &light.falloff);
  object.Finish();
  return light;
}

constexpr NumberRange kConeAngle{0.0, 90.0, "a number in [0, 90]"};

Source ReadSpotLight(const JsonCursor& value) {
  PointLight light;
  Cone cone;
  JsonObject object(value);
  ReadVector(object.Required("position"), &light.position);
  ReadDirection(object.Required("direction"), &cone.direction);
  object.Optional("inner").Read(kConeAngle, &cone.inner);
  const JsonCursor outer = object.Optional("outer");
  outer.Read(kConeAngle, &cone.outer);
  if (!(cone.inner < cone.outer)) {
    (outer.present() ? outer : object.Optional("inner")).Fail("inner must be below outer");
  }
  ReadFalloff(object.Optional("falloff"), &light.falloff);
  object.Finish();
  light.cone = cone;
  return light;
}

constexpr NumberRange kSunAngle{0.0, 180.0, "a number in [0, 180]"};
constexpr NumberRange kLightRadius{1e-30, kMaxCoordinate, "a number in [1e-30, 1e30]"};
constexpr NumberRange kLightSamples{1, kMaxLightSamples, "an integer in [1, 1024]"};

Source ReadDirectionalLight(const JsonCursor& value) {
  DirectionalLight light;
  JsonObject object(value);
  ReadDirection(object.Required("direction"), &light.direction);
  object.Optional("angle").Read(kSunAngle, &light.angle);
  object.Finish();
  return light;
}

Source ReadRectangleLight(const JsonCursor& value) {
  RectangleLight light;
  JsonObject object(value);
  ReadVector(object.Required("center"), &light.center);
  const bool has_u = ReadVector(object.Required("u"), &light.u);
  const JsonCursor v = object.Required("v");
  if (ReadVector(v, &light.v) && has_u && !SpansPlane(light.u, light.v)) {
    v.Fail("u and v span no rectangle");
  }
  object.Finish();
  return light;
}

Source ReadDiskLight(const JsonCursor& value) {
  DiskLight light;
  JsonObject object(value);
  ReadVector(object.Required("center"), &light.center);
  object.Required("radius").Read(kLightRadius, &light.radius);
  ReadDirection(object.Required("direction"), &light.direction);
  object.Finish();
  return light;
}

Source ReadSphereLight(const JsonCursor& value) {
  SphereLight light;
  JsonObject object(value);
  ReadVector(object.Required("center"), &light.center);
  object.Required("radius").Read(kLightRadius, &light.radius);
  object.Finish();
  return light;
}

constexpr KeyedReader<Source> kSources[] = {{"point", &ReadPointLight},
                                            {"spot", &ReadSpotLight},
                                            {"directional", &ReadDirectionalLight},
                                            {"rectangle", &ReadRectangleLight},
                                            {"disk", &ReadDiskLight},
                                            {"sphere", &ReadSphereLight}};

Json PointJson(const PointLight& point) {
  const Falloff& falloff = point.falloff;
  Json json = {{"position", VectorJson(point.position)},
               {"falloff", {falloff.constant, falloff.linear, falloff.quadratic}}};
  if (!point.cone) return {{"point", json}};
  json["direction"] = VectorJson(point.cone->direction);
  json["inner"] = point.cone->inner;
  json["outer"] = point.cone->outer;
  return {{"spot", json}};
}

// What the illuminance at the reference point has to be multiplied with to give the intensity.
double FalloffAt(const PointLight& light, const Vec3d& reference) {
  const Vec3d d = reference - light.position;
  const double square = d.x * d.x + d.y * d.y + d.z * d.z;
  const Falloff& f = light.falloff;
  return f.constant + f.linear * std::sqrt(square) + f.quadratic * square;
}

}  // namespace

Light ReadLight(JsonObject* object) {
  Light light;
  const JsonCursor source = object->OneOf(KeysOf(kSources));
  if (source.present()) light.source = ReadByKey(source, kSources);
  ReadColour(object->Optional("colour"), kStrength, &light.colour);
  object->Optional("shadows").ReadBoolean(&light.casts_shadows);
  object->Optional("samples").ReadInteger(kLightSamples, &light.samples);

  const JsonCursor strength = object->OneOf({"E0", "intensity"});
  const bool is_read = strength.Read(kIntensity, &light.intensity);
  const JsonCursor reference = object->Optional("reference");
  if (!source.present() || !strength.present()) return light;
  const auto* point = std::get_if<PointLight>(&light.source);
  const bool is_sun = std::holds_alternative<DirectionalLight>(light.source);
  if (strength.key() == "E0" && point == nullptr && !is_sun) {
    strength.Fail("a light with a size has an \"intensity\"");
  }
  if (point == nullptr || strength.key() != "E0") {
    reference.Fail("only \"E0\" of a point light has a reference point");
    return light;
  }
  if (!reference.present()) object->FailMissing("reference", "missing key; \"E0\" needs it");
  Vec3d place{0.0};
  if (!ReadVector(reference, &place) || !is_read) return light;
  const double factor = FalloffAt(*point, place);
  light.intensity *= factor;
  if (!(factor > 0.0)) {
    reference.Fail("the reference point is the light's position, where E0 is not defined");
  } else if (light.intensity > kIntensity.high) {
    strength.Fail(fmt::format("the intensity would be {:.6g}, more than {}", light.intensity,
                              kIntensity.high));
  }
  return light;
}

Json LightJson(const Light& light) {
  Json json = Json::object();
  if (!light.name.empty()) json["name"] = light.name;
  json.update(Match(
      light.source, [](const PointLight& point) { return PointJson(point); },
      [](const DirectionalLight& sun) -> Json {
        Json members = {{"direction", VectorJson(sun.direction)}};
        if (sun.angle > 0) members["angle"] = sun.angle;
        return {{"directional", members}};
      },
      [](const RectangleLight& rectangle) -> Json {
        return {{"rectangle",
                 {{"center", VectorJson(rectangle.center)},
                  {"u", VectorJson(rectangle.u)},
                  {"v", VectorJson(rectangle.v)}}}};
      },
      [](const DiskLight& disk) -> Json {
        return {{"disk",
                 {{"center", VectorJson(disk.center)},
                  {"radius", disk.radius},
                  {"direction", VectorJson(disk.direction)}}}};
      },
      [](const SphereLight& sphere) -> Json {
        return {{"sphere", {{"center", VectorJson(sphere.center)}, {"radius", sphere.radius}}}};
      }));
  json["colour"] = VectorJson(light.colour);
  json["intensity"] = light.intensity;
  json["shadows"] = light.casts_shadows;
  if (light.samples != 1) json["samples"] = light.samples;
  return json;
}

}  // namespace sheaf
