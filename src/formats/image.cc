#include "src/formats/image.h"

#include <fmt/format.h>
#include <turbojpeg.h>

#include <bit>
#include <cstring>
#include <filesystem>
#include <memory>
#include <new>
#include <utility>

#include "src/core/out_of_memory.h"
#include "src/formats/other_images.h"
#include "src/formats/png_reader.h"
#include "src/formats/printable.h"
#include "src/formats/read_file.h"

namespace sheaf {
namespace {

Error Refused(std::string_view what) { return {ErrorKind::kScene, std::string(what)}; }

// More pixels a byte than either format can pack: 1032 times by deflate and 8 a byte before that;
// a bit for a block of 64 in JPEG.
constexpr std::uint64_t kMostPixelsPerByte = 8 * 1032;

Status CheckSize(std::uint64_t width, std::uint64_t height, std::size_t bytes) {
  if (width < 1 || height < 1 || width > kMaxTextureSide || height > kMaxTextureSide) {
    return Refused(
        fmt::format("an image of {}x{}; sides may be 1 to {}", width, height, kMaxTextureSide));
  }
  if (width * height / kMostPixelsPerByte > bytes) {
    return Refused(fmt::format("{} bytes cannot hold {}x{} pixels", bytes, width, height));
  }
  return Done{};
}

Image NewImage(std::uint64_t width, std::uint64_t height) {
  return {{},
          static_cast<int>(width),
          static_cast<int>(height),
          std::vector<std::uint32_t>(width * height)};
}

// Decoders write r, g, b, a; texels are numbers.
void ToNumbers(Image& image) {
  if constexpr (std::endian::native == std::endian::big) {
    for (std::uint32_t& texel : image.texels) {
      unsigned char bytes[4];
      std::memcpy(bytes, &texel, 4);
      texel =
          bytes[0] | bytes[1] << 8 | bytes[2] << 16 | static_cast<std::uint32_t>(bytes[3]) << 24;
    }
  }
}

// Texels as they lie in the file: what they mean is for the scene to say.
Result<Image> DecodePng(std::string_view bytes) {
  PngReader png;
  const auto failed = [&] { return Refused(Printable(png.complaint.text)); };
  if (!png.ReadHeader(bytes, PngPixels::kRgba8)) return failed();
  const auto width = static_cast<std::uint64_t>(png.width),
             height = static_cast<std::uint64_t>(png.height);
  if (const Status sized = CheckSize(width, height, bytes.size()); !sized) return sized.error();
  Image image = NewImage(width, height);
  if (!png.ReadRows(reinterpret_cast<std::uint8_t*>(image.texels.data()))) return failed();
  return image;
}

// Whether a JPEG has Adobe's segment: then its inks are stored as what they leave of the light.
bool HasAdobeSegment(std::string_view bytes) {
  const auto at = [&](std::size_t i) { return static_cast<unsigned char>(bytes[i]); };
  for (std::size_t i = 2; i + 9 <= bytes.size() && at(i) == 0xff;) {
    if (at(i + 1) == 0xee && bytes.substr(i + 4, 5) == "Adobe") return true;
    if (at(i + 1) == 0xda) return false;  // the picture begins
    i += 2 + (at(i + 2) << 8 | at(i + 3));
  }
  return false;
}

// Four inks as r, g, b, as browsers show them: each takes its share of the light, black of all.
void InksToColours(bool is_light_left, Image& image) {
  for (std::uint32_t& texel : image.texels) {
    unsigned char inks[4];
    std::memcpy(inks, &texel, 4);
    const auto left = [&](int i) -> unsigned { return is_light_left ? inks[i] : 255u - inks[i]; };
    for (int i = 0; i < 3; ++i) {
      inks[i] = static_cast<unsigned char>((left(i) * left(3) + 127) / 255);
    }
    inks[3] = 255;
    std::memcpy(&texel, inks, 4);
  }
}

Result<Image> DecodeJpeg(std::string_view bytes) {
  const std::unique_ptr<void, int (*)(tjhandle)> decoder(tjInitDecompress(), &tjDestroy);
  if (!decoder) throw std::bad_alloc();  // nothing else can be missing
  const auto* data = reinterpret_cast<const unsigned char*>(bytes.data());
  const auto failed = [&] {
    const char* const text = tjGetErrorStr2(decoder.get());
    ThrowIfOutOfMemory(text);
    return Refused(Printable(text));
  };
  int width = 0, height = 0, subsampling = 0, colours = 0;
  if (tjDecompressHeader3(decoder.get(), data, bytes.size(), &width, &height, &subsampling,
                          &colours) != 0) {
    return failed();
  }
  const auto side = [](int x) { return static_cast<std::uint64_t>(x); };
  if (const Status sized = CheckSize(side(width), side(height), bytes.size()); !sized) {
    return sized.error();
  }
  const bool has_inks = colours == TJCS_CMYK || colours == TJCS_YCCK;
  Image image = NewImage(side(width), side(height));
  if (tjDecompress2(decoder.get(), data, bytes.size(),
                    reinterpret_cast<unsigned char*>(image.texels.data()), width, 0, height,
                    has_inks ? TJPF_CMYK : TJPF_RGBA, 0) != 0) {
    return failed();
  }
  if (has_inks) InksToColours(HasAdobeSegment(bytes), image);
  return image;
}

// Formats that are told by their first bytes, to say what an image is instead.
constexpr std::pair<std::string_view, const char*> kOtherFormats[] = {
    {"\xabKTX 20", "a KTX2"}, {"\xabKTX 11", "a KTX"}, {"DDS ", "a DDS"}, {"GIF8", "a GIF"}};

Error UnknownFormat(std::string_view bytes) {
  for (const auto& [start, name] : kOtherFormats) {
    if (bytes.starts_with(start)) {
      return Refused(fmt::format("{}, neither a PNG nor a JPEG", name));
    }
  }
  return Refused("neither a PNG nor a JPEG");
}

}  // namespace

Result<Image> DecodeImage(std::string_view bytes) {
  const bool is_png = bytes.starts_with("\x89PNG"), is_jpeg = bytes.starts_with("\xff\xd8\xff");
  if (!is_png && !is_jpeg) {
    return OtherImageKind(bytes) ? DecodeOtherImage(bytes) : UnknownFormat(bytes);
  }
  Result<Image> image = is_png ? DecodePng(bytes) : DecodeJpeg(bytes);
  if (image) ToNumbers(image.value());
  return image;
}

Result<std::shared_ptr<const Image>> ImageCache::Load(const std::string& from,
                                                      const std::string& reference,
                                                      SceneFiles& files) {
  const Result<std::string> path = files.Resolve(from, reference);
  if (!path) return Refused(fmt::format("{}: {}", Printable(reference), path.error().message));
  std::shared_ptr<const Image>& image = images_[path.value()];
  if (image) return image;
  const Result<std::string> bytes = files.Read(path.value(), kMaxModelBytes);
  if (!bytes) return bytes.error();
  const std::string name = std::filesystem::path(path.value()).filename().string();
  const auto decoded = files.images().Decode(bytes.value(), name);
  if (!decoded)
    return Refused(fmt::format("{}: {}", Printable(reference), decoded.error().message));
  return image = decoded.value();
}

}  // namespace sheaf
