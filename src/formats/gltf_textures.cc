#include "src/formats/gltf_textures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <utility>

#include "src/formats/printable.h"

namespace sheaf {
namespace {

constexpr double kDegrees = 57.295779513082320877;  // of a radian

// Extensions that give a texture another image, for whoever reads its format.
constexpr const char* kOtherImages[] = {"EXT_texture_webp", "EXT_texture_avif",
                                        "KHR_texture_basisu", "MSFT_texture_dds"};

// The image that core glTF names, or else the first that an extension does.
int SourceOf(const tinygltf::Texture& texture) {
  if (texture.source >= 0) return texture.source;
  for (const char* name : kOtherImages) {
    const tinygltf::Value* extension = FindExtension(texture.extensions, name);
    if (extension != nullptr) {
      return static_cast<int>(std::clamp(NumberIn(*extension, "source", -1), -1.0, 1e9));
    }
  }
  return -1;
}

void SetTransform(const tinygltf::Value& extension, TextureTransform* out) {
  NumbersIn(extension, "offset", &out->offset);
  NumbersIn(extension, "scale", &out->scale);
  constexpr double kFar = 1e6;  // beyond that a float knows no place within an image
  out->offset = glm::clamp(out->offset, -kFar, kFar);
  out->scale = glm::clamp(out->scale, -kFar, kFar);
  out->rotation = std::fmod(NumberIn(extension, "rotation", 0) * kDegrees, 360);
  if (!std::isfinite(out->rotation)) out->rotation = 0;
}

}  // namespace

double NumberIn(const tinygltf::Value& object, const char* key, double otherwise) {
  if (!object.IsObject() || !object.Has(key)) return otherwise;
  const tinygltf::Value& value = object.Get(key);
  return value.IsNumber() ? value.GetNumberAsDouble() : otherwise;
}

const tinygltf::Value* FindExtension(const tinygltf::ExtensionMap& extensions, const char* name) {
  const auto found = extensions.find(name);
  return found == extensions.end() ? nullptr : &found->second;
}

GltfTextureUse TextureUse(int index, int set, const tinygltf::ExtensionMap& extensions) {
  GltfTextureUse use{index, set, {}};
  const tinygltf::Value* transform = FindExtension(extensions, "KHR_texture_transform");
  if (transform == nullptr) return use;
  SetTransform(*transform, &use.transform);
  use.set = static_cast<int>(std::clamp(NumberIn(*transform, "texCoord", set), 0.0, 1e6));
  return use;
}

GltfTextureUse TextureUseIn(const tinygltf::Value& object, const char* key) {
  if (!object.IsObject() || !object.Has(key)) return {};
  const tinygltf::Value& info = object.Get(key);
  tinygltf::ExtensionMap extensions;
  if (info.IsObject() && info.Has("extensions")) {
    const tinygltf::Value& given = info.Get("extensions");
    for (const std::string& name : given.Keys()) extensions.emplace(name, given.Get(name));
  }
  const auto whole = [&](const char* name, double otherwise) {
    return static_cast<int>(std::clamp(NumberIn(info, name, otherwise), -1.0, 1e9));
  };
  return TextureUse(whole("index", -1), whole("texCoord", 0), extensions);
}

std::optional<Texture> GltfTextures::Read(const GltfTextureUse& use, Transfer transfer) {
  if (use.index < 0) return std::nullopt;
  const auto& textures = document_.model().textures;
  if (!IsIndexOf(use.index, textures)) {
    document_.Warn("/textures", "a texture is not there",
                   fmt::format("{} of {}", use.index, textures.size()));
    return std::nullopt;
  }
  Texture texture;
  texture.image = ImageOf(use.index);
  if (!texture.image) return std::nullopt;
  texture.transfer = transfer;
  texture.transform = use.transform;
  texture.set = use.set;
  SetSampler(textures[static_cast<std::size_t>(use.index)].sampler, &texture);
  return texture;
}

// Images are decoded when a material asks for them, and complain once.
std::shared_ptr<const Image> GltfTextures::ImageOf(int texture) {
  constexpr std::string_view kLost = "an image cannot be read, so its texture is left out";
  images_.resize(document_.image_count());
  const int source = SourceOf(document_.model().textures[static_cast<std::size_t>(texture)]);
  if (!IsIndexOf(source, images_)) {
    document_.Warn(
        fmt::format("/textures/{}", texture), kLost,
        source < 0 ? "none is named" : fmt::format("image {} of {}", source, images_.size()));
    return nullptr;
  }
  const auto i = static_cast<std::size_t>(source);
  Slot& slot = images_[i];
  if (std::exchange(slot.is_read, true)) return slot.image;
  const std::string& uri = document_.image(i).uri;
  const std::string place = fmt::format("/images/{}", source);
  const Result<std::string> bytes = document_.ImageBytes(i);
  if (!bytes) {
    document_.Warn(place, kLost, bytes.error().message);
    return nullptr;
  }
  const auto decoded = document_.Decode(bytes.value(), IsDataUri(uri) ? "" : DecodeUriPath(uri));
  if (!decoded) {
    document_.Warn(place, kLost,
                   uri.empty() ? decoded.error().message
                               : fmt::format("{}: {}", ShowUri(uri), decoded.error().message));
    return nullptr;
  }
  return slot.image = decoded.value();
}

void GltfTextures::SetSampler(int index, Texture* out) const {
  const auto& samplers = document_.model().samplers;
  if (!IsIndexOf(index, samplers)) return;
  const tinygltf::Sampler& sampler = samplers[static_cast<std::size_t>(index)];
  const auto wrap = [](int mode) {
    return mode == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE     ? Wrap::kClamp
           : mode == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ? Wrap::kMirror
                                                           : Wrap::kRepeat;
  };
  out->wrap_u = wrap(sampler.wrapS);
  out->wrap_v = wrap(sampler.wrapT);
  const int minified = sampler.minFilter;
  if (sampler.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST) {
    out->filter = Filter::kNearest;
  } else if (minified == TINYGLTF_TEXTURE_FILTER_NEAREST ||
             minified == TINYGLTF_TEXTURE_FILTER_LINEAR) {
    out->filter = Filter::kLinear;
  }
}

}  // namespace sheaf
