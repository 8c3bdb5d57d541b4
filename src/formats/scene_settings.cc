#include "src/formats/scene_settings.h"

#include <nlohmann/json.hpp>

namespace sheaf {
namespace {

constexpr NumberRange kImageSide{1.0, kMaxImageSide, "an integer in [1, 65536]"};
constexpr NumberRange kSampleCount{1.0, kMaxSamples, "an integer in [1, 65536]"};
constexpr NumberRange kDepthLimit{0.0, kMaxDepth, "an integer in [0, 1000000]"};
constexpr NumberRange kExposure{kSmallestPositive, 1e6, "a number in (0, 1e6]"};

}  // namespace

Settings ReadSettings(const JsonCursor& value, Transfer* decode) {
  Settings settings;
  if (!value.present()) return settings;
  JsonObject object(value);
  if (const auto size = object.Optional("size").ReadTuple<2>("[width, height]")) {
    (*size)[0].ReadInteger(kImageSide, &settings.width);
    (*size)[1].ReadInteger(kImageSide, &settings.height);
  }
  object.Optional("samples").ReadInteger(kSampleCount, &settings.samples);
  object.Optional("max_depth").ReadInteger(kDepthLimit, &settings.max_depth);
  const JsonCursor srgb = object.Optional("srgb");
  bool is_srgb = false;  // absent: as "pictures"
  if (srgb.Is(JsonKind::kString)) {
    if (srgb.text() != "pictures") srgb.Fail("expected true, false or \"pictures\"");
    settings.transfer = Transfer::kSrgb;
  } else if (srgb.ReadBoolean(&is_srgb)) {
    settings.transfer = *decode = is_srgb ? Transfer::kSrgb : Transfer::kLinear;
  }
  ReadPictureColour(object.Optional("background"), *decode, &settings.background);
  // The ambient colour is light, and the colours of lights are always linear.
  Colour ambient;
  if (ReadColour(object.Optional("ambient"), kStrength, &ambient)) settings.ambient = ambient;
  object.Optional("exposure").Read(kExposure, &settings.exposure);
  object.Finish();
  return settings;
}

Json SettingsJson(const Settings& settings) {
  Json json = {{"size", {settings.width, settings.height}},
               {"samples", settings.samples},
               {"max_depth", settings.max_depth},
               {"background", VectorJson(settings.background)},
               {"exposure", settings.exposure}};
  if (settings.ambient) json["ambient"] = VectorJson(*settings.ambient);
  json["srgb"] = settings.transfer == Transfer::kSrgb ? Json("pictures") : Json(false);
  return json;
}

}  // namespace sheaf
