#include "src/formats/gltf_materials.h"

#include <fmt/format.h>

#include <algorithm>
#include <glm/common.hpp>
#include <glm/vec4.hpp>
#include <utility>

#include "src/formats/read_scene.h"
#include "src/formats/scene_values.h"
#include "src/scene/gloss.h"
#include "src/scene/srgb.h"

namespace sheaf {

// A surface by whichever of glTF's two descriptions it has.
struct GltfMaterials::Surface {
  Colour base{1.0};
  double alpha = 1;
  double metallic = 1, roughness = 1;
  double specular = 1;      // the highlight of what is no metal, over that of an index of 1.5
  double transmission = 0;  // of what is no metal
  GltfTextureUse base_texture, gloss_texture, transmission_texture;
};

struct GltfMaterials::Uses {
  GltfTextureUse base, emissive, normal, gloss, occlusion, transmission;
};

namespace {

double Share(double number) { return std::clamp(number, 0.0, 1.0); }
double Largest(const Colour& colour) { return std::max({colour.x, colour.y, colour.z}); }

// Seen as it is, whatever lights there are.
void MakeUnlit(const Colour& base, Material* material) {
  material->emission = base;
  if (const auto* texture = std::get_if<Texture>(&material->base_colour)) {
    material->emission_texture = *texture;
    material->emission_texture->factor = Colour(1.0);
  }
}

bool HasAlpha(const Image& image) {
  return std::any_of(image.texels.begin(), image.texels.end(),
                     [](std::uint32_t texel) { return texel >> 24 != 255; });
}

// The mean of the texels as they lie in the file, in [0, 1].
glm::dvec4 MeanOf(const Image& image) {
  glm::dvec4 sum(0.0);
  for (const std::uint32_t texel : image.texels) {
    for (int c = 0; c < 4; ++c) sum[c] += texel >> (8 * c) & 255;
  }
  return sum / (255.0 * static_cast<double>(std::max<std::size_t>(image.texels.size(), 1)));
}

// By the material's mode. Nothing reaches a cutoff above 1.
Alpha AlphaOf(const tinygltf::Material& from, double factor) {
  if (from.alphaMode == "BLEND") return {AlphaMode::kBlend, Share(factor), 0.5};
  if (from.alphaMode != "MASK") return {};
  const bool is_nothing = from.alphaCutoff > 1;
  return {AlphaMode::kMask, is_nothing ? 0 : Share(factor), Share(from.alphaCutoff)};
}

// Whether anything shows of it, where vertices are opaque. What is opaque everywhere stays so: many
// files ask for blending that needs none.
bool IsSeenThrough(const Alpha& alpha, const Material& material) {
  if (alpha.mode == AlphaMode::kOpaque) return false;
  const auto* base = std::get_if<Texture>(&material.base_colour);
  if (base != nullptr && HasAlpha(*base->image)) return true;
  return alpha.factor < (alpha.mode == AlphaMode::kMask ? alpha.cutoff : 1.0);
}

std::string FaultOf(const Material& material, const Colour& base) {
  for (const double number : {material.kd, material.ks, base.x, base.y, base.z, material.emission.x,
                              material.emission.y, material.emission.z, material.ior}) {
    if (!(number <= kStrength.high)) return "a number is not finite, or above 1e6";
  }
  return "";
}

}  // namespace

bool GltfMaterials::Read() {
  for (std::size_t i = 0; i < document_.model().materials.size(); ++i) {
    if (!ReadMaterial(i)) return false;
  }
  return true;
}

std::uint32_t GltfMaterials::MaterialOf(int index) {
  if (index >= 0) return static_cast<std::uint32_t>(index);
  if (!plain_) {
    plain_ = static_cast<std::uint32_t>(scene_.materials.size());
    scene_.materials.push_back(PlainMaterial());
  }
  return *plain_;
}

GltfMaterialUse GltfMaterials::UseOf(int index) const {
  return IsIndexOf(index, uses_) ? uses_[static_cast<std::size_t>(index)] : GltfMaterialUse{};
}

void GltfMaterials::ShowAlpha(int index) {
  scene_.materials[MaterialOf(index)].alpha = UseOf(index).alpha;
}

bool GltfMaterials::ReadMaterial(std::size_t index) {
  const tinygltf::Material& from = document_.model().materials[index];
  const std::string place = fmt::format("/materials/{}", index);
  const Surface surface = ReadSurface(from);
  const auto info = [](const auto& i) { return TextureUse(i.index, i.texCoord, i.extensions); };
  Uses uses{surface.base_texture,  info(from.emissiveTexture),  info(from.normalTexture),
            surface.gloss_texture, info(from.occlusionTexture), surface.transmission_texture};
  const auto& extensions = from.extensions;
  const bool is_unlit = FindExtension(extensions, "KHR_materials_unlit") != nullptr;
  if (is_unlit) uses = {surface.base_texture, {}, {}, {}, {}, {}};
  uses_.push_back({ChooseSets(uses, place), is_unlit, AlphaOf(from, surface.alpha)});

  Material material;
  material.name = from.name;
  material.base_colour = surface.base;
  if (const auto* ior = FindExtension(extensions, "KHR_materials_ior")) {
    material.ior = std::clamp(NumberIn(*ior, "ior", 1.5), 1.0, kIor.high);
  } else {
    material.ior = 1.5;
  }
  // Without a thickness it is the thin wall of a bubble.
  const auto* volume = FindExtension(from.extensions, "KHR_materials_volume");
  if (volume != nullptr && NumberIn(*volume, "thicknessFactor", 0) > 0) {
    const double distance = NumberIn(*volume, "attenuationDistance", 0);
    if (distance > 0 && distance <= kMaxCoordinate) {
      NumbersIn(*volume, "attenuationColor", &material.attenuation);
      material.attenuation = glm::clamp(material.attenuation, 0.0, 1.0);
      material.attenuation_distance = distance;
    }
  }
  double glow = 1;
  if (const auto* strength = FindExtension(extensions, "KHR_materials_emissive_strength")) {
    glow = NumberIn(*strength, "emissiveStrength", 1);
  }
  for (int c = 0; c < 3 && static_cast<std::size_t>(c) < from.emissiveFactor.size(); ++c) {
    material.emission[c] = std::max(from.emissiveFactor[static_cast<std::size_t>(c)] * glow, 0.0);
  }
  SetTextures(from, surface, uses, &material);
  if (IsSeenThrough(uses_.back().alpha, material)) material.alpha = uses_.back().alpha;
  if (is_unlit) {
    MakeUnlit(surface.base, &material);
  } else {
    // What a metal lets through is taken from what is no metal of it. The renderer does the rest.
    const bool is_even = !material.metallic_roughness;
    const double through = surface.transmission * (is_even ? 1 - surface.metallic : 1.0);
    const double taken = material.transmission ? 0 : through;
    material.kd = 1 - taken;
    material.ambient = kModelAmbient * (1 - taken);
    material.transmit = surface.transmission * glm::min(surface.base, Colour(1.0));
    if (is_even) {
      material.metallic_roughness = {{}, surface.metallic, surface.roughness, surface.specular};
    }
  }
  const std::string fault = FaultOf(material, surface.base);
  if (!fault.empty()) return document_.Fail(place, fault);
  scene_.materials.push_back(std::move(material));
  return true;
}

GltfMaterials::Surface GltfMaterials::ReadSurface(const tinygltf::Material& from) {
  if (const auto* old = FindExtension(from.extensions, "KHR_materials_pbrSpecularGlossiness")) {
    return ReadSpecularGlossiness(*old);
  }
  Surface surface;
  const auto& pbr = from.pbrMetallicRoughness;
  for (std::size_t c = 0; c < pbr.baseColorFactor.size() && c < 4; ++c) {
    const double factor = std::max(pbr.baseColorFactor[c], 0.0);
    (c == 3 ? surface.alpha : surface.base[static_cast<int>(c)]) = factor;
  }
  surface.metallic = Share(pbr.metallicFactor);
  surface.roughness = Share(pbr.roughnessFactor);
  const auto info = [](const auto& i) { return TextureUse(i.index, i.texCoord, i.extensions); };
  surface.base_texture = info(pbr.baseColorTexture);
  if (surface.metallic > 0 || surface.roughness > 0) {
    surface.gloss_texture = info(pbr.metallicRoughnessTexture);
  }
  if (const auto* specular = FindExtension(from.extensions, "KHR_materials_specular")) {
    Colour colour(1.0);
    NumbersIn(*specular, "specularColorFactor", &colour);
    surface.specular = std::clamp(
        NumberIn(*specular, "specularFactor", 1) * std::max(Largest(colour), 0.0), 0.0, 1e3);
  }
  if (const auto* through = FindExtension(from.extensions, "KHR_materials_transmission")) {
    surface.transmission = Share(NumberIn(*through, "transmissionFactor", 0));
    if (surface.transmission > 0) {
      surface.transmission_texture = TextureUseIn(*through, "transmissionTexture");
    }
  }
  return surface;
}

// The older description, as well as it fits. A texture of it counts by its mean.
GltfMaterials::Surface GltfMaterials::ReadSpecularGlossiness(const tinygltf::Value& from) {
  Surface surface;
  glm::dvec4 diffuse(1.0);
  Colour specular(1.0);
  NumbersIn(from, "diffuseFactor", &diffuse);
  NumbersIn(from, "specularFactor", &specular);
  double glossiness = NumberIn(from, "glossinessFactor", 1);
  surface.base_texture = TextureUseIn(from, "diffuseTexture");
  const GltfTextureUse gloss = TextureUseIn(from, "specularGlossinessTexture");
  if (const auto texture = textures_.Read(gloss, Transfer::kSrgb)) {
    const glm::dvec4 mean = MeanOf(*texture->image);
    for (int c = 0; c < 3; ++c) specular[c] *= SrgbDecode(mean[c]);
    glossiness *= mean.w;
  }
  specular = glm::clamp(specular, 0.0, 1.0);
  surface.base = glm::max(Colour(diffuse), 0.0);
  surface.alpha = diffuse.w;
  surface.roughness = 1 - Share(glossiness);
  surface.metallic = 0;
  // An index of 1.5 mirrors 0.04; nothing shines more than a metal, whose highlight is 4 times it.
  surface.specular = std::min(Largest(specular) / 0.04, 4.0);
  if (surface.base_texture.index < 0 && Largest(surface.base) <= 0.1 * Largest(specular)) {
    surface.metallic = 1;
    surface.base = specular;
  }
  return surface;
}

// Surfaces have two sets of coordinates: those of the first textures. Textures by a third are left
// out, and those that stay get the number of theirs.
std::array<int, 2> GltfMaterials::ChooseSets(Uses& uses, const std::string& place) {
  std::array<int, 2> chosen = {-1, -1};
  for (GltfTextureUse* use : {&uses.base, &uses.emissive, &uses.normal, &uses.gloss,
                              &uses.occlusion, &uses.transmission}) {
    if (use->index < 0) continue;
    const auto known = std::find_if(chosen.begin(), chosen.end(),
                                    [&](int set) { return set < 0 || set == use->set; });
    if (known == chosen.end()) {
      document_.Warn(place, "textures by a third set of coordinates are left out",
                     fmt::format("TEXCOORD_{} beside TEXCOORD_{} and TEXCOORD_{}", use->set,
                                 chosen[0], chosen[1]));
      use->index = -1;
      continue;
    }
    *known = use->set;
    use->set = static_cast<int>(known - chosen.begin());
  }
  return chosen;
}

void GltfMaterials::SetTextures(const tinygltf::Material& from, const Surface& surface,
                                const Uses& uses, Material* material) {
  if (auto base = textures_.Read(uses.base, Transfer::kSrgb)) {
    base->factor = surface.base;
    material->base_colour = *std::move(base);
  }
  if (material->emission != Colour(0.0)) {
    material->emission_texture = textures_.Read(uses.emissive, Transfer::kSrgb);
  }
  if (auto gloss = textures_.Read(uses.gloss, Transfer::kLinear)) {
    material->metallic_roughness =
        MetallicRoughness{*std::move(gloss), surface.metallic, surface.roughness, surface.specular};
  }
  if (auto through = textures_.Read(uses.transmission, Transfer::kLinear)) {
    material->transmission = Transmission{*std::move(through), surface.transmission};
  }
  if (auto occlusion = textures_.Read(uses.occlusion, Transfer::kLinear)) {
    material->occlusion = Occlusion{*std::move(occlusion), Share(from.occlusionTexture.strength)};
  }
  if (auto normal = textures_.Read(uses.normal, Transfer::kLinear)) {
    material->normal_map =
        NormalMap{*std::move(normal), std::clamp(from.normalTexture.scale, -1e6, 1e6)};
  }
}

}  // namespace sheaf
