#include "src/formats/scene_settings.h"

#include <fmt/format.h>

#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "sheaf/formats.h"
#include "sheaf/render.h"
#include "src/core/match.h"
#include "src/formats/other_images.h"
#include "src/formats/printable.h"
#include "src/formats/read_file.h"
#include "src/scene/srgb.h"

namespace sheaf {
namespace {

constexpr NumberRange kImageSide{1.0, kMaxImageSide, "an integer in [1, 65536]"};
constexpr NumberRange kSampleCount{1.0, kMaxSamples, "an integer in [1, 65536]"};
constexpr NumberRange kDepthLimit{0.0, kMaxDepth, "an integer in [0, 1000000]"};
constexpr NumberRange kContrast{0.0, 1.0, "a number in [0, 1]"};
constexpr NumberRange kError{kSmallestPositive, 1.0, "a number in (0, 1]"};
constexpr NumberRange kRotation{-1e6, 1e6, "a number in [-1e6, 1e6]"};
constexpr NumberRange kStops{-kMaxEv, kMaxEv, "a number in [-64, 64], or \"auto\""};
constexpr NumberRange kExposure{kSmallestPositive, 1e6, "a number in (0, 1e6]"};

// The light of a picture file, of its ending's format or one that its bytes show.
Result<FloatImage> ReadLight(const std::string& path) {
  if (!CheckPicturePath(path)) {
    const Result<std::string> bytes = ReadWholeFile(path);
    if (bytes && OtherImageKind(bytes.value())) return DecodeOtherLight(bytes.value());
  }
  Result<ReadPictureResult> read = ReadPicture(path);
  if (!read) return read.error();
  const ReadPictureResult& picture = read.value();
  const Film& film = picture.film;
  FloatImage image{{}, film.width, film.height, {film.rgb.begin(), film.rgb.end()}};
  // What a display shows is sRGB unless the file says that it is light.
  if (picture.is_display && !picture.is_linear) {
    for (float& light : image.rgb) {
      light = static_cast<float>(SrgbDecode(static_cast<double>(light)));
    }
  }
  return image;
}

// Nothing where the picture cannot be had, which is an error.
std::shared_ptr<const FloatImage> ReadFloatImage(const JsonCursor& value, ColourSource* source) {
  std::string reference;
  if (!value.ReadString(&reference)) return nullptr;
  const auto failed = [&](const std::string& message) {
    value.Fail(fmt::format("{}: {}", Printable(reference), message));
    return nullptr;
  };
  const Result<std::string> path = source->files.Resolve(source->path, reference);
  if (!path) return failed(path.error().message);
  Result<FloatImage> read = ReadLight(path.value());
  if (!read) return failed(read.error().message);
  FloatImage& image = read.value();
  if (image.width > kMaxTextureSide || image.height > kMaxTextureSide) {
    return failed(
        fmt::format("{}x{}; sides may be 1 to {}", image.width, image.height, kMaxTextureSide));
  }
  image.name = std::filesystem::path(reference).filename().string();
  for (const float light : image.rgb) {
    if (!(light >= 0 && light <= std::numeric_limits<float>::max())) {
      return failed("it has a number that is negative or not finite");
    }
  }
  return std::make_shared<const FloatImage>(std::move(image));
}

void ReadEnvironment(const JsonCursor& value, ColourSource* source,
                     std::optional<Environment>* out) {
  JsonObject object(value);
  const JsonCursor kind = object.OneOf({"gradient", "map"});
  if (kind.present() && kind.key() == "gradient") {
    Gradient gradient;
    JsonObject members(kind);
    ReadPictureColour(members.Required("zenith"), source->decode, &gradient.zenith);
    ReadPictureColour(members.Required("horizon"), source->decode, &gradient.horizon);
    ReadPictureColour(members.Required("nadir"), source->decode, &gradient.nadir);
    members.Finish();
    *out = gradient;
  } else if (kind.present()) {
    EnvironmentMap map;
    JsonObject members(kind);
    map.image = ReadFloatImage(members.Required("image"), source);
    members.Optional("strength").Read(kStrength, &map.strength);
    members.Optional("rotation").Read(kRotation, &map.rotation);
    members.Finish();
    if (map.image) *out = map;
  }
  object.Finish();
}

const NamedChoice<Integrator> kNamedIntegrators[] = {
    {IntegratorName(Integrator::kWhitted), Integrator::kWhitted},
    {IntegratorName(Integrator::kDistributed), Integrator::kDistributed},
    {IntegratorName(Integrator::kPath), Integrator::kPath}};
constexpr NamedChoice<PixelFilter> kPixelFilters[] = {
    {"box", PixelFilter::kBox},
    {"gaussian", PixelFilter::kGaussian},
    {"blackman-harris", PixelFilter::kBlackmanHarris}};
constexpr NamedChoice<Tone> kTones[] = {{"linear", Tone::kLinear}, {"filmic", Tone::kFilmic}};
constexpr NamedChoice<Shadows> kShadows[] = {{"through", Shadows::kThrough},
                                             {"opaque", Shadows::kOpaque}};

Json EnvironmentJson(const Environment& environment) {
  return Match(
      environment,
      [](const Gradient& gradient) -> Json {
        return {{"gradient",
                 {{"zenith", VectorJson(gradient.zenith)},
                  {"horizon", VectorJson(gradient.horizon)},
                  {"nadir", VectorJson(gradient.nadir)}}}};
      },
      [](const EnvironmentMap& map) -> Json {
        return {
            {"map",
             {{"image", map.image->name}, {"strength", map.strength}, {"rotation", map.rotation}}}};
      });
}

}  // namespace

Settings ReadSettings(const JsonCursor& value, ColourSource* source) {
  Settings settings;
  if (!value.present()) return settings;
  JsonObject object(value);
  if (const auto size = object.Optional("size").ReadTuple<2>("[width, height]")) {
    (*size)[0].ReadInteger(kImageSide, &settings.width);
    (*size)[1].ReadInteger(kImageSide, &settings.height);
  }
  object.Optional("samples").ReadInteger(kSampleCount, &settings.samples);
  if (const JsonCursor adaptive = object.Optional("adaptive"); adaptive.present()) {
    double contrast = 0;
    if (adaptive.Read(kContrast, &contrast)) settings.contrast = contrast;
  }
  if (const JsonCursor error = object.Optional("error"); error.present()) {
    double most = 0;
    if (error.Read(kError, &most)) settings.error = most;
    if (settings.contrast) error.Fail("conflicts with \"adaptive\"");
    if (settings.samples < kLeastErrorSamples) {
      error.Fail(fmt::format("needs samples of {} or more", kLeastErrorSamples));
    }
  }
  object.Optional("max_depth").ReadInteger(kDepthLimit, &settings.max_depth);
  const JsonCursor srgb = object.Optional("srgb");
  bool is_srgb = false;  // absent: as "pictures"
  if (srgb.Is(JsonKind::kString)) {
    if (srgb.text() != "pictures") srgb.Fail("expected true, false or \"pictures\"");
    settings.transfer = Transfer::kSrgb;
  } else if (srgb.ReadBoolean(&is_srgb)) {
    settings.transfer = source->decode = is_srgb ? Transfer::kSrgb : Transfer::kLinear;
  }
  ReadPictureColour(object.Optional("background"), source->decode, &settings.background);
  if (const JsonCursor environment = object.Optional("environment"); environment.present()) {
    ReadEnvironment(environment, source, &settings.environment);
  }
  // The ambient colour is light, and the colours of lights are always linear.
  Colour ambient;
  if (ReadColour(object.Optional("ambient"), kStrength, &ambient)) settings.ambient = ambient;
  object.Optional("exposure").Read(kExposure, &settings.exposure);
  const JsonCursor ev = object.Optional("ev");
  if (ev.Is(JsonKind::kString)) {
    if (ev.text() != "auto") ev.Fail("expected a number or \"auto\"");
    settings.ev.reset();
  } else {
    ev.Read(kStops, &*settings.ev);
  }
  ReadChoice(object.Optional("tone"), kTones, &settings.tone);
  ReadChoice(object.Optional("shadows"), kShadows, &settings.shadows);
  ReadChoice(object.Optional("integrator"), kNamedIntegrators, &settings.integrator);
  ReadChoice(object.Optional("pixel_filter"), kPixelFilters, &settings.filter);
  object.Finish();
  return settings;
}

Json SettingsJson(const Settings& settings) {
  Json json = {{"size", {settings.width, settings.height}},
               {"samples", settings.samples},
               {"max_depth", settings.max_depth},
               {"background", VectorJson(settings.background)},
               {"exposure", settings.exposure}};
  if (settings.contrast) json["adaptive"] = *settings.contrast;
  if (settings.error) json["error"] = *settings.error;
  if (settings.environment) json["environment"] = EnvironmentJson(*settings.environment);
  if (settings.ambient) json["ambient"] = VectorJson(*settings.ambient);
  if (settings.ev != 0.0) json["ev"] = settings.ev ? Json(*settings.ev) : Json("auto");
  if (settings.tone != Settings().tone) json["tone"] = NameOf(settings.tone, kTones);
  if (settings.shadows != Settings().shadows) json["shadows"] = NameOf(settings.shadows, kShadows);
  if (settings.integrator != Integrator::kDistributed) {
    json["integrator"] = IntegratorName(settings.integrator);
  }
  if (settings.filter != PixelFilter::kBox) {
    json["pixel_filter"] = NameOf(settings.filter, kPixelFilters);
  }
  json["srgb"] = settings.transfer == Transfer::kSrgb ? Json("pictures") : Json(false);
  return json;
}

}  // namespace sheaf
