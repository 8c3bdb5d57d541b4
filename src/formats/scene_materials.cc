#include "src/formats/scene_materials.h"

#include <nlohmann/json.hpp>
#include <optional>
#include <utility>
#include <variant>

#include "src/core/match.h"

namespace sheaf {
namespace {

constexpr NumberRange kDistance{1e-30, kMaxCoordinate, "a number in [1e-30, 1e30]"};
constexpr NumberRange kUnit{0.0, 1.0, "a number in [0, 1]"};
constexpr NumberRange kPlacing{-1e6, 1e6, "a number in [-1e6, 1e6]"};
constexpr NumberRange kCells{kSmallestPositive, 65536.0, "a number in (0, 65536]"};

enum class Written { kAlways, kUnlessDefault };

// A material's parameters but its base colour, in the order of the file: the only list of them.
struct Parameter {
  std::string_view key;
  std::variant<double Material::*, Colour Material::*> member;
  NumberRange range;
  Written written = Written::kAlways;
};
constexpr Parameter kParameters[] = {
    {"emission", &Material::emission, kStrength, Written::kUnlessDefault},
    {"ambient", &Material::ambient, kStrength},
    {"kd", &Material::kd, kStrength},
    {"ks", &Material::ks, kStrength},
    {"shininess", &Material::shininess, kShininess},
    {"reflect", &Material::reflect, kFraction},
    {"transmit", &Material::transmit, kFraction},
    {"ior", &Material::ior, kIor},
    {"roughness", &Material::roughness, kUnit, Written::kUnlessDefault},
    {"attenuation", &Material::attenuation, kFraction, Written::kUnlessDefault},
    {"attenuation_distance", &Material::attenuation_distance, kDistance, Written::kUnlessDefault},
};

void ReadParameter(const JsonCursor& value, const Parameter& parameter, Material* material) {
  Match(
      parameter.member,
      [&](double Material::*member) { value.Read(parameter.range, &(material->*member)); },
      [&](Colour Material::*member) { ReadColour(value, parameter.range, &(material->*member)); });
}

void WriteParameter(const Material& material, const Parameter& parameter, Json* json) {
  const auto write = [&](auto member, const auto& to_json) {
    if (parameter.written == Written::kUnlessDefault && material.*member == Material().*member) {
      return;
    }
    (*json)[std::string(parameter.key)] = to_json(material.*member);
  };
  Match(
      parameter.member,
      [&](double Material::*member) { write(member, [](double number) { return Json(number); }); },
      [&](Colour Material::*member) { write(member, &VectorJson); });
}

Checker ReadChecker(const JsonCursor& value, Transfer transfer) {
  Checker checker;
  JsonObject object(value);
  ReadPictureColour(object.Optional("even"), transfer, &checker.even);
  ReadPictureColour(object.Optional("odd"), transfer, &checker.odd);
  ReadPair(object.Optional("cells"), kCells, "[cells along u, cells along v]", &checker.cells);
  object.Optional("filter").ReadBoolean(&checker.is_filtered);
  object.Finish();
  return checker;
}

constexpr NamedChoice<Wrap> kWraps[] = {
    {"repeat", Wrap::kRepeat}, {"mirror", Wrap::kMirror}, {"clamp", Wrap::kClamp}};
constexpr NamedChoice<AlphaMode> kAlphaModes[] = {
    {"opaque", AlphaMode::kOpaque}, {"mask", AlphaMode::kMask}, {"blend", AlphaMode::kBlend}};
constexpr NamedChoice<Filter> kFilters[] = {
    {"mip", Filter::kMip}, {"linear", Filter::kLinear}, {"nearest", Filter::kNearest}};

TextureTransform ReadTextureTransform(const JsonCursor& value) {
  TextureTransform transform;
  JsonObject object(value);
  ReadPair(object.Optional("offset"), kPlacing, "[along u, along v]", &transform.offset);
  ReadPair(object.Optional("scale"), kPlacing, "[along u, along v]", &transform.scale);
  object.Optional("rotation").Read(kPlacing, &transform.rotation);
  object.Finish();
  return transform;
}

// Nothing where the image cannot be had, which is an error. `usual` is how images are encoded that
// do not say.
std::optional<Texture> ReadTexture(const JsonCursor& value, ColourSource* source,
                                   Transfer usual = Transfer::kSrgb) {
  Texture texture;
  JsonObject object(value);
  const JsonCursor image = object.Required("image");
  std::string reference;
  if (image.ReadString(&reference)) {
    auto loaded = source->images.Load(source->path, reference, source->files);
    if (loaded) {
      texture.image = loaded.value();
    } else {
      image.Fail(loaded.error().message);
    }
  }
  const JsonCursor wrap = object.Optional("wrap");
  if (wrap.Is(JsonKind::kArray)) {
    if (const auto both = wrap.ReadTuple<2>("[along u, along v]")) {
      ReadChoice((*both)[0], kWraps, &texture.wrap_u);
      ReadChoice((*both)[1], kWraps, &texture.wrap_v);
    }
  } else {
    ReadChoice(wrap, kWraps, &texture.wrap_u);
    texture.wrap_v = texture.wrap_u;
  }
  ReadChoice(object.Optional("filter"), kFilters, &texture.filter);
  bool is_srgb = usual == Transfer::kSrgb;
  object.Optional("srgb").ReadBoolean(&is_srgb);
  texture.transfer = is_srgb ? Transfer::kSrgb : Transfer::kLinear;
  ReadPictureColour(object.Optional("factor"), source->decode, &texture.factor);
  if (const JsonCursor transform = object.Optional("transform"); transform.present()) {
    texture.transform = ReadTextureTransform(transform);
  }
  object.Optional("set").ReadInteger({0, 1, "0 or 1"}, &texture.set);
  object.Finish();
  return texture.image ? std::optional(texture) : std::nullopt;
}

void ReadBaseColour(const JsonCursor& value, ColourSource* source, Material* material) {
  const Transfer transfer = source->decode;
  if (value.Is(JsonKind::kObject)) {
    JsonObject object(value);
    const JsonCursor texture = object.Optional("texture");
    const JsonCursor checker =
        texture.present() ? object.AtMostOneOf({"checker"}) : object.Required("checker");
    if (texture.present() && checker.present()) {
      checker.Fail("a base colour is a checker or a texture, not both");
    } else if (checker.present()) {
      material->base_colour = ReadChecker(checker, transfer);
    } else if (texture.present()) {
      if (const auto read = ReadTexture(texture, source)) material->base_colour = *read;
    }
    object.Finish();
    return;
  }
  Colour colour;
  if (ReadPictureColour(value, transfer, &colour,
                        "a colour ([r, g, b] or one number) or {\"checker\": ...}")) {
    material->base_colour = colour;
  }
}

// {"texture": ..., and what `read_rest` reads}: of data that textures hold, which are linear.
template <typename Map, typename F>
void ReadMap(const JsonCursor& value, ColourSource* source, std::optional<Map>* out, F read_rest) {
  if (!value.present()) return;
  Map map;
  JsonObject object(value);
  const auto texture = ReadTexture(object.Required("texture"), source, Transfer::kLinear);
  read_rest(object, map);
  object.Finish();
  if (!texture) return;
  map.texture = *texture;
  *out = std::move(map);
}

// The only one that may do without a texture.
void ReadGloss(const JsonCursor& value, ColourSource* source,
               std::optional<MetallicRoughness>* out) {
  if (!value.present()) return;
  MetallicRoughness gloss;
  JsonObject object(value);
  if (const JsonCursor texture = object.Optional("texture"); texture.present()) {
    gloss.texture = ReadTexture(texture, source, Transfer::kLinear).value_or(Texture());
  }
  object.Optional("metallic").Read(kUnit, &gloss.metallic);
  object.Optional("roughness").Read(kUnit, &gloss.roughness);
  object.Optional("specular").Read(kStrength, &gloss.specular);
  object.Finish();
  *out = std::move(gloss);
}

void ReadMaps(JsonObject& object, ColourSource* source, Material* material) {
  if (const JsonCursor emission = object.Optional("emission_texture"); emission.present()) {
    material->emission_texture = ReadTexture(emission, source);
  }
  ReadGloss(object.Optional("metallic_roughness"), source, &material->metallic_roughness);
  ReadMap(
      object.Optional("transmission"), source, &material->transmission,
      [](JsonObject& rest, Transmission& map) { rest.Optional("share").Read(kUnit, &map.share); });
  ReadMap(object.Optional("occlusion"), source, &material->occlusion,
          [](JsonObject& rest, Occlusion& map) {
            rest.Optional("strength").Read(kUnit, &map.strength);
          });
  ReadMap(
      object.Optional("normal_map"), source, &material->normal_map,
      [](JsonObject& rest, NormalMap& map) { rest.Optional("scale").Read(kPlacing, &map.scale); });
  const JsonCursor alpha = object.Optional("alpha");
  if (!alpha.present()) return;
  JsonObject members(alpha);
  ReadChoice(members.Required("mode"), kAlphaModes, &material->alpha.mode);
  members.Optional("factor").Read(kUnit, &material->alpha.factor);
  members.Optional("cutoff").Read(kUnit, &material->alpha.cutoff);
  members.Finish();
}

Json TextureJson(const Texture& texture) {
  Json json = {{"image", texture.image->name},
               {"wrap", {NameOf(texture.wrap_u, kWraps), NameOf(texture.wrap_v, kWraps)}},
               {"filter", NameOf(texture.filter, kFilters)},
               {"srgb", texture.transfer == Transfer::kSrgb},
               {"factor", VectorJson(texture.factor)}};
  if (const TextureTransform& transform = texture.transform; transform != TextureTransform()) {
    json["transform"] = {{"offset", {transform.offset.x, transform.offset.y}},
                         {"scale", {transform.scale.x, transform.scale.y}},
                         {"rotation", transform.rotation}};
  }
  if (texture.set != 0) json["set"] = texture.set;
  return json;
}

void WriteMaps(const Material& material, Json* json) {
  if (material.emission_texture) {
    (*json)["emission_texture"] = TextureJson(*material.emission_texture);
  }
  if (const auto& map = material.metallic_roughness) {
    Json& gloss = (*json)["metallic_roughness"];
    if (map->texture.image) gloss["texture"] = TextureJson(map->texture);
    gloss["metallic"] = map->metallic;
    gloss["roughness"] = map->roughness;
    gloss["specular"] = map->specular;
  }
  if (const auto& map = material.transmission) {
    (*json)["transmission"] = {{"texture", TextureJson(map->texture)}, {"share", map->share}};
  }
  if (const auto& map = material.occlusion) {
    (*json)["occlusion"] = {{"texture", TextureJson(map->texture)}, {"strength", map->strength}};
  }
  if (const auto& map = material.normal_map) {
    (*json)["normal_map"] = {{"texture", TextureJson(map->texture)}, {"scale", map->scale}};
  }
  if (material.alpha.mode == AlphaMode::kOpaque) return;
  (*json)["alpha"] = {{"mode", NameOf(material.alpha.mode, kAlphaModes)},
                      {"factor", material.alpha.factor},
                      {"cutoff", material.alpha.cutoff}};
}

Json BaseColourJson(const Material& material) {
  return Match(
      material.base_colour, [](const Colour& colour) { return VectorJson(colour); },
      [](const Checker& checker) -> Json {
        Json members = {{"even", VectorJson(checker.even)},
                        {"odd", VectorJson(checker.odd)},
                        {"cells", {checker.cells.x, checker.cells.y}}};
        if (checker.is_filtered) members["filter"] = true;
        return {{"checker", members}};
      },
      [](const Texture& texture) -> Json {
        return {{"texture", TextureJson(texture)}};
      });
}

}  // namespace

Material ReadMaterial(const JsonCursor& value, ColourSource* source, NameTable* names) {
  Material material;
  JsonObject object(value);
  const JsonCursor name = object.Required("name");
  if (ReadNonEmptyName(name, &material.name)) names->Add(material.name, name);
  ReadBaseColour(object.Optional("base_colour"), source, &material);
  for (const Parameter& parameter : kParameters) {
    ReadParameter(object.Optional(parameter.key), parameter, &material);
  }
  ReadMaps(object, source, &material);
  object.Finish();
  return material;
}

Json MaterialJson(const Material& material) {
  Json json = {{"name", material.name}};
  json["base_colour"] = BaseColourJson(material);
  for (const Parameter& parameter : kParameters) WriteParameter(material, parameter, &json);
  WriteMaps(material, &json);
  return json;
}

}  // namespace sheaf
