#include "src/formats/mtl_materials.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <glm/common.hpp>
#include <iterator>

#include "src/formats/printable.h"
#include "src/formats/read_scene.h"
#include "src/formats/scene_values.h"
#include "src/formats/text_lines.h"

namespace sheaf {
namespace {

// Those that a material here has a place for, those of normals in the order of their worth.
constexpr std::string_view kNormalMaps[] = {"norm", "map_Bump", "map_bump", "bump"};
constexpr std::string_view kShownMaps[] = {"map_Kd",   "map_Ke",   "map_d", "norm",
                                           "map_Bump", "map_bump", "bump"};

Colour NotNegative(const Colour& colour) { return glm::max(colour, Colour(0.0)); }
bool IsBlack(const Colour& colour) { return NotNegative(colour) == Colour(0.0); }

const MtlMap* MapOf(const MtlMaterial& from, std::string_view statement) {
  const auto found = from.maps.find(statement);
  return found == from.maps.end() ? nullptr : &found->second;
}

Texture TextureOf(std::shared_ptr<const Image> image, const MtlMap& map, Transfer transfer) {
  Texture texture;
  texture.image = std::move(image);
  texture.transfer = transfer;
  if (map.is_clamped) texture.wrap_u = texture.wrap_v = Wrap::kClamp;
  // v runs up in the file: 1 - ((1 - v) * scale + offset).
  texture.transform.scale = map.scale;
  texture.transform.offset = {map.offset.x, 1 - map.scale.y - map.offset.y};
  return texture;
}

std::uint32_t ByteOf(std::uint32_t texel, int channel) { return texel >> (8 * channel) & 0xff; }

template <typename Holds>
bool AllTexels(const Image& image, Holds holds) {
  return std::all_of(image.texels.begin(), image.texels.end(), holds);
}

bool IsGrey(const Image& image) {
  return AllTexels(image, [](std::uint32_t texel) {
    return ByteOf(texel, 0) == ByteOf(texel, 1) && ByteOf(texel, 1) == ByteOf(texel, 2);
  });
}

bool HasAlpha(const Image& image) {
  return !AllTexels(image, [](std::uint32_t texel) { return ByteOf(texel, 3) == 255; });
}

std::uint32_t TexelAt(const Image& image, std::size_t x, std::size_t y, const Image& size) {
  const auto scaled = [](std::size_t i, int from, int to) {
    return i * static_cast<std::size_t>(to) / static_cast<std::size_t>(from);
  };
  return image.texels[scaled(y, size.height, image.height) * static_cast<std::size_t>(image.width) +
                      scaled(x, size.width, image.width)];
}

}  // namespace

Material MtlMaterials::Make(const MtlMaterial& from) {
  Material material = PlainMaterial();
  material.name = from.name;
  AddBaseColour(from, &material);
  AddEmission(from, &material);
  AddNormals(from, &material);
  for (const auto& [statement, map] : from.maps) {
    if (std::find(std::begin(kShownMaps), std::end(kShownMaps), statement) != std::end(kShownMaps))
      continue;
    const MtlMap* const base = MapOf(from, "map_Kd");
    if (statement == "map_Ka" && base != nullptr && map.file == base->file) continue;
    files_.Warn(PlaceOf(from.library, map.line), fmt::format("{} is not read", statement));
  }
  const Colour specular = NotNegative(from.ks.value_or(Colour(0.0)));
  const double illum = from.illum.value_or(2), shininess = from.ns.value_or(0);
  if (illum >= 2 && shininess > 0) {
    material.ks = std::max({specular.x, specular.y, specular.z});
    material.shininess = shininess;
  }
  double opacity = OpacityOf(from);
  if (MapOf(from, "map_d") != nullptr) {
    AddAlpha(from, opacity, &material);
    if (material.alpha.mode != AlphaMode::kOpaque) opacity = 1;
  }
  material.transmit = Colour(1 - opacity);
  if (illum >= 3 && illum < 9) material.reflect = glm::min(specular, Colour(opacity));
  if (opacity < 1) {
    material.kd = opacity;
    material.ior = std::clamp(from.ni.value_or(1), kIor.low, kIor.high);
  }
  return material;
}

void MtlMaterials::AddBaseColour(const MtlMaterial& from, Material* material) {
  const MtlMap* const map = MapOf(from, "map_Kd");
  // Many exporters leave Kd black beside a map.
  const bool has_colour = from.kd && !(map != nullptr && IsBlack(*from.kd));
  if (has_colour) material->base_colour = NotNegative(*from.kd);
  if (ImagePointer image = Load(from, "map_Kd")) {
    Texture texture = TextureOf(std::move(image), *map, Transfer::kSrgb);
    texture.factor = has_colour ? NotNegative(*from.kd) : Colour(1.0);
    material->base_colour = texture;
  }
}

void MtlMaterials::AddEmission(const MtlMaterial& from, Material* material) {
  material->emission = NotNegative(from.ke.value_or(Colour(0.0)));
  ImagePointer image = Load(from, "map_Ke");
  if (!image) return;
  material->emission_texture = TextureOf(std::move(image), *MapOf(from, "map_Ke"), Transfer::kSrgb);
  if (IsBlack(material->emission)) material->emission = Colour(1.0);  // as beside map_Kd
}

void MtlMaterials::AddNormals(const MtlMaterial& from, Material* material) {
  for (const std::string_view statement : kNormalMaps) {
    ImagePointer image = Load(from, statement);
    if (!image) continue;
    const MtlMap& map = *MapOf(from, statement);
    // By the specification a bump map has heights; most are normals by now.
    if (statement != "norm" && IsGrey(*image)) {
      files_.Warn(PlaceOf(from.library, map.line), statement, "heights are not read");
      continue;
    }
    material->normal_map = NormalMap{TextureOf(std::move(image), map, Transfer::kLinear), map.bump};
    return;
  }
}

double MtlMaterials::OpacityOf(const MtlMaterial& from) {
  const double opacity = std::clamp(from.d ? *from.d : 1 - from.tr.value_or(0), 0.0, 1.0);
  const int illum = static_cast<int>(from.illum.value_or(2));
  const bool is_glass = illum == 4 || illum == 6 || illum == 7 || illum == 9;
  if (opacity > 0 || is_glass) return opacity;
  // Some programs have written the one for the other, and nobody models what cannot be seen.
  files_.Warn(PlaceOf(from.library, from.line), "material taken for opaque",
              fmt::format("{} hides \"{}\" wholly", from.d ? "d 0" : "Tr 1", Printable(from.name)));
  return 1;
}

// A material's alpha is that of its base colour's texture: both images become one.
void MtlMaterials::AddAlpha(const MtlMaterial& from, double opacity, Material* material) {
  const ImagePointer mask = Load(from, "map_d");
  if (!mask) return;
  const MtlMap& map = *MapOf(from, "map_d");
  auto* base = std::get_if<Texture>(&material->base_colour);
  if (base == nullptr) {
    Image white = *mask;
    std::fill(white.texels.begin(), white.texels.end(), 0xffffffffu);
    Texture texture =
        TextureOf(std::make_shared<const Image>(std::move(white)), map, Transfer::kSrgb);
    texture.factor = std::get<Colour>(material->base_colour);
    material->base_colour = texture;
    base = &std::get<Texture>(material->base_colour);
  } else if (base->transform != TextureOf(mask, map, Transfer::kSrgb).transform) {
    files_.Warn(PlaceOf(from.library, map.line), "map_d", "placed as map_Kd is");
  }
  if (base->image != mask) base->image = WithAlpha(base->image, mask);
  if (!HasAlpha(*base->image) && opacity == 1) return;
  const bool is_cut_out = opacity == 1 && AllTexels(*base->image, [](std::uint32_t texel) {
                            return ByteOf(texel, 3) == 0 || ByteOf(texel, 3) == 255;
                          });
  material->alpha.mode = is_cut_out ? AlphaMode::kMask : AlphaMode::kBlend;
  material->alpha.factor = opacity;
}

MtlMaterials::ImagePointer MtlMaterials::Load(const MtlMaterial& from, std::string_view statement) {
  const MtlMap* const map = MapOf(from, statement);
  if (map == nullptr) return nullptr;
  const std::string_view named = WithoutComment(map->file);
  auto image = images_.Load(from.library, WithSlashes(map->file), files_);
  if (!image && named != map->file) image = images_.Load(from.library, WithSlashes(named), files_);
  if (image) return image.value();
  files_.Warn(PlaceOf(from.library, map->line), statement,
              fmt::format("{}; untextured", image.error().message));
  return nullptr;
}

// The mask's own alpha where it has any, else how bright it is.
MtlMaterials::ImagePointer MtlMaterials::WithAlpha(const ImagePointer& base,
                                                   const ImagePointer& mask) {
  ImagePointer& known = masked_[{base, mask}];
  if (known) return known;
  Image both;
  both.name = base->name;
  both.width = std::max(base->width, mask->width);
  both.height = std::max(base->height, mask->height);
  both.texels.reserve(static_cast<std::size_t>(both.width) * static_cast<std::size_t>(both.height));
  const bool has_alpha = HasAlpha(*mask);
  for (std::size_t y = 0; y < static_cast<std::size_t>(both.height); ++y) {
    for (std::size_t x = 0; x < static_cast<std::size_t>(both.width); ++x) {
      const std::uint32_t texel = TexelAt(*mask, x, y, both);
      const std::uint32_t grey = (ByteOf(texel, 0) + ByteOf(texel, 1) + ByteOf(texel, 2)) / 3;
      const std::uint32_t alpha = has_alpha ? ByteOf(texel, 3) : grey;
      both.texels.push_back((TexelAt(*base, x, y, both) & 0xffffffu) | alpha << 24);
    }
  }
  return known = std::make_shared<const Image>(std::move(both));
}

}  // namespace sheaf
