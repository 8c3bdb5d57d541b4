#include "src/formats/other_images.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include "src/core/out_of_memory.h"
#include "src/formats/image_module.h"
#include "src/formats/printable.h"
#include "src/scene/srgb.h"

namespace sheaf {
namespace {

struct Kind {
  const char* name;
  const char* ending;  // by which OpenImageIO knows it
  bool is_light;
};
constexpr Kind kBmp{"a BMP", "bmp", false}, kTga{"a TGA", "tga", false},
    kTiff{"a TIFF", "tif", false}, kWebP{"a WebP", "webp", false},
    kHdr{"a Radiance HDR", "hdr", true}, kExr{"an OpenEXR", "exr", true};

constexpr std::pair<std::string_view, const Kind*> kStarts[] = {
    {"BM", &kBmp},
    {"RIFF", &kWebP},
    {std::string_view("II*\0", 4), &kTiff},
    {std::string_view("MM\0*", 4), &kTiff},
    {"#?RADIANCE", &kHdr},
    {"#?RGBE", &kHdr},
    {"\x76\x2f\x31\x01", &kExr}};

// A TGA has no signature: its header has to make sense.
bool MayBeTga(std::string_view bytes) {
  if (bytes.size() < 18) return false;
  const auto at = [&](std::size_t i) { return static_cast<unsigned char>(bytes[i]); };
  const auto is_one_of = [](int value, std::initializer_list<int> values) {
    return std::find(values.begin(), values.end(), value) != values.end();
  };
  return at(1) <= 1 && is_one_of(at(2), {1, 2, 3, 9, 10, 11}) &&
         is_one_of(at(16), {8, 15, 16, 24, 32}) && (at(12) | at(13)) != 0 && (at(14) | at(15)) != 0;
}

const Kind* KindOf(std::string_view bytes) {
  for (const auto& [start, kind] : kStarts) {
    if (bytes.starts_with(start)) return kind;
  }
  return MayBeTga(bytes) ? &kTga : nullptr;
}

Error Refused(std::string_view what) { return {ErrorKind::kScene, std::string(what)}; }

// Four channels a pixel, as they lie in the file.
struct Pixels {
  int width = 0, height = 0;
  std::vector<float> rgba;
  bool is_light = false;  // else encoded as sRGB
};

// Grey fills three channels, and where there is no alpha it is 1.
std::vector<float> SpreadChannels(const ModuleImage& image) {
  const auto channels = static_cast<std::size_t>(image.channels);
  const bool is_grey = image.channels - (image.alpha >= 0 ? 1 : 0) < 3;
  std::vector<float> rgba(image.numbers.size() / channels * 4);
  const float* from = image.numbers.data();
  for (std::size_t i = 0; i < rgba.size(); i += 4, from += channels) {
    for (std::size_t c = 0; c < 3; ++c) rgba[i + c] = from[is_grey ? 0 : c];
    rgba[i + 3] = image.alpha >= 0 ? from[image.alpha] : 1.0f;
  }
  return rgba;
}

// The module's function; null with the loader's complaint.
DecodeByModule* LoadModule(std::string* complaint) {
#ifdef SHEAF_HAS_OPENIMAGEIO
  // It stays loaded: OpenImageIO has threads of its own.
  void* const module = dlopen("libsheaf_openimageio.so", RTLD_NOW | RTLD_LOCAL);
  if (module != nullptr) {
    if (void* const found = dlsym(module, kDecodeByModule)) {
      return reinterpret_cast<DecodeByModule*>(found);
    }
  }
  *complaint = "libsheaf_openimageio.so cannot be loaded";
#else
  *complaint = "this build has none";
#endif
  return nullptr;
}

Result<Pixels> Decode(std::string_view bytes) {
  const Kind* kind = KindOf(bytes);
  if (kind == nullptr) return Refused("of an unknown format");
  static std::string complaint;
  static DecodeByModule* const decode = LoadModule(&complaint);
  if (decode == nullptr) {
    return Refused(fmt::format("{}, neither a PNG nor a JPEG, which OpenImageIO would read: {}",
                               kind->name, complaint));
  }
  ModuleImage image;
  if (!decode(bytes.data(), bytes.size(), kind->ending, kMaxTextureSide, image)) {
    ThrowIfOutOfMemory(image.error);
    return Refused(fmt::format("{}: {}", kind->name, Printable(image.error)));
  }
  return Pixels{image.width, image.height, SpreadChannels(image), kind->is_light};
}

std::uint32_t ToByte(double share) {
  return static_cast<std::uint32_t>(std::clamp(share, 0.0, 1.0) * 255 + 0.5);
}

}  // namespace

const char* OtherImageKind(std::string_view bytes) {
  const Kind* kind = KindOf(bytes);
  return kind != nullptr ? kind->name : nullptr;
}

Result<Image> DecodeOtherImage(std::string_view bytes) {
  const Result<Pixels> pixels = Decode(bytes);
  if (!pixels) return pixels.error();
  const std::vector<float>& rgba = pixels.value().rgba;
  Image image{{}, pixels.value().width, pixels.value().height, {}};
  image.texels.reserve(rgba.size() / 4);
  for (std::size_t i = 0; i < rgba.size(); i += 4) {
    std::uint32_t texel = 0;
    for (std::size_t c = 0; c < 4; ++c) {
      double share = static_cast<double>(rgba[i + c]);
      if (!(share > 0)) share = 0;  // NaN too
      if (pixels.value().is_light && c < 3) share = SrgbEncode(std::min(share, 1.0));
      texel |= ToByte(share) << 8 * c;
    }
    image.texels.push_back(texel);
  }
  return image;
}

Result<FloatImage> DecodeOtherLight(std::string_view bytes) {
  const Result<Pixels> pixels = Decode(bytes);
  if (!pixels) return pixels.error();
  const std::vector<float>& rgba = pixels.value().rgba;
  FloatImage image{{}, pixels.value().width, pixels.value().height, {}};
  image.rgb.reserve(rgba.size() / 4 * 3);
  for (std::size_t i = 0; i < rgba.size(); ++i) {
    if (i % 4 == 3) continue;
    const float number = rgba[i];
    image.rgb.push_back(pixels.value().is_light
                            ? number
                            : static_cast<float>(SrgbDecode(static_cast<double>(number))));
  }
  return image;
}

}  // namespace sheaf
