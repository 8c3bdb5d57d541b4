#include "src/formats/gltf_materials.h"

#include <fmt/format.h>

#include <algorithm>
#include <glm/common.hpp>
#include <utility>

#include "src/formats/image.h"
#include "src/formats/printable.h"
#include "src/formats/read_scene.h"

namespace sheaf {
namespace {

double Factor(const tinygltf::Material& material, const char* extension, const char* key,
              double otherwise) {
  const auto found = material.extensions.find(extension);
  if (found == material.extensions.end() || !found->second.Has(key)) return otherwise;
  const tinygltf::Value& value = found->second.Get(key);
  return value.IsNumber() ? value.GetNumberAsDouble() : otherwise;
}

// The highlights and mirrors of a metallic-roughness surface.
void SetGloss(double metallic, double roughness, const Colour& base, Material* material) {
  const double sharpness = (1 - roughness) * (1 - roughness);
  material->ks = (0.2 + 0.6 * metallic) * (1 - roughness);
  // Blinn and Phong's exponent for the roughness of a microfacet surface (Walter et al. 2007).
  const double alpha = std::max(roughness * roughness, 0.01);
  material->shininess = std::max(2 / (alpha * alpha) - 2, 1.0);
  if (metallic * sharpness > 0.02) {
    material->reflect = glm::min(base, Colour(1.0)) * (metallic * sharpness);
  }
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

bool GltfMaterials::ReadMaterial(std::size_t index) {
  const tinygltf::Material& from = document_.model().materials[index];
  const std::string place = fmt::format("/materials/{}", index);
  const auto& pbr = from.pbrMetallicRoughness;
  const double metallic = std::clamp(pbr.metallicFactor, 0.0, 1.0);
  const double roughness = std::clamp(pbr.roughnessFactor, 0.0, 1.0);
  const double transmission =
      std::clamp(Factor(from, "KHR_materials_transmission", "transmissionFactor", 0), 0.0, 1.0);
  const double glow = Factor(from, "KHR_materials_emissive_strength", "emissiveStrength", 1);
  Colour base(1.0), emission(0.0);
  for (int c = 0; c < 3; ++c) {
    const auto k = static_cast<std::size_t>(c);
    if (k < pbr.baseColorFactor.size()) base[c] = std::max(pbr.baseColorFactor[k], 0.0);
    if (k < from.emissiveFactor.size()) emission[c] = std::max(from.emissiveFactor[k] * glow, 0.0);
  }
  Material material;
  material.name = from.name;
  material.base_colour = base;
  material.emission = emission;
  material.ambient = kModelAmbient * (1 - transmission);
  const double matt = 1 - metallic * (1 - roughness);
  material.kd = matt * (1 - transmission);
  SetGloss(metallic, roughness, base, &material);
  material.transmit = Colour(transmission * (1 - metallic));
  material.ior = std::clamp(Factor(from, "KHR_materials_ior", "ior", 1.5), 1.0, 1e6);
  for (const double number : {material.kd, material.ks, base.x, base.y, base.z, emission.x,
                              emission.y, emission.z, material.ior}) {
    if (!(number <= 1e6)) return document_.Fail(place, "a number is not finite, or above 1e6");
  }
  if (pbr.baseColorTexture.index >= 0) {
    Texture texture;
    texture.factor = base;
    if (!ReadTexture(pbr.baseColorTexture.index, place, &texture)) return false;
    material.base_colour = texture;
  }
  if (from.alphaMode == "MASK" || from.alphaMode == "BLEND") {
    document_.Warn(place, "alpha is not read: the material is opaque");
  }
  scene_.materials.push_back(std::move(material));
  return true;
}

bool GltfMaterials::ReadTexture(int index, const std::string& place, Texture* out) {
  const tinygltf::Model& model = document_.model();
  if (!IsIndexOf(index, model.textures)) {
    return document_.Fail(place, fmt::format("texture {} of {}", index, model.textures.size()));
  }
  const tinygltf::Texture& texture = model.textures[static_cast<std::size_t>(index)];
  if (!IsIndexOf(texture.source, model.images)) {
    return document_.Fail(fmt::format("/textures/{}", index),
                          fmt::format("image {} of {}", texture.source, model.images.size()));
  }
  if (!LoadImage(static_cast<std::size_t>(texture.source), &out->image)) return false;
  if (texture.sampler < 0) return true;
  if (!IsIndexOf(texture.sampler, model.samplers)) {
    return document_.Fail(fmt::format("/textures/{}", index),
                          fmt::format("sampler {} of {}", texture.sampler, model.samplers.size()));
  }
  const auto& sampler = model.samplers[static_cast<std::size_t>(texture.sampler)];
  const auto wrap = [](int mode) {
    return mode == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE     ? Wrap::kClamp
           : mode == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ? Wrap::kMirror
                                                           : Wrap::kRepeat;
  };
  out->wrap_u = wrap(sampler.wrapS);
  out->wrap_v = wrap(sampler.wrapT);
  if (sampler.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST) out->filter = Filter::kNearest;
  return true;
}

bool GltfMaterials::LoadImage(std::size_t index, std::shared_ptr<const Image>* out) {
  const std::string place = fmt::format("/images/{}", index);
  const auto& images = document_.model().images;
  images_.resize(images.size());
  std::shared_ptr<const Image>& image = images_[index];
  if (!image) {
    const std::string& uri = images[index].uri;
    const std::string bytes = document_.TakeImage(index);
    if (bytes.empty()) return document_.Fail(place, fmt::format("cannot read {}", Printable(uri)));
    Result<Image> decoded = DecodeImage(bytes);
    if (!decoded) return document_.Fail(place, decoded.error().message);
    decoded.value().name = uri.starts_with("data:") ? "" : uri;
    image = std::make_shared<const Image>(std::move(decoded).value());
  }
  *out = image;
  return true;
}

}  // namespace sheaf
