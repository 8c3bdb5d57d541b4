#include "src/formats/image.h"

#include <fmt/format.h>
#include <png.h>
#include <turbojpeg.h>

#include <bit>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

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

// Texels as they lie in the file. libpng's simple interface would re-encode those that a gAMA chunk
// calls linear, and what texels mean is for the scene to say.
class PngDecoder {
 public:
  explicit PngDecoder(std::string_view bytes)
      : bytes_(bytes),
        png_(png_create_read_struct(PNG_LIBPNG_VER_STRING, &message_, &OnError, &OnWarning)) {
    if (png_ != nullptr) info_ = png_create_info_struct(png_);
  }
  PngDecoder(const PngDecoder&) = delete;
  PngDecoder& operator=(const PngDecoder&) = delete;
  ~PngDecoder() { png_destroy_read_struct(&png_, &info_, nullptr); }

  // Reads up to the pixels and asks for RGBA of 8 bits. False: see message().
  bool ReadHeader() {
    if (info_ == nullptr) return false;
    if (setjmp(png_jmpbuf(png_))) return false;
    png_set_read_fn(png_, this, &Read);
    png_set_user_limits(png_, kMaxTextureSide, kMaxTextureSide);
    png_read_info(png_, info_);
    png_set_expand(png_);
    png_set_scale_16(png_);
    png_set_gray_to_rgb(png_);
    png_set_add_alpha(png_, 255, PNG_FILLER_AFTER);
    png_set_interlace_handling(png_);
    png_read_update_info(png_, info_);
    return true;
  }
  std::uint64_t width() const { return png_get_image_width(png_, info_); }
  std::uint64_t height() const { return png_get_image_height(png_, info_); }
  const std::string& message() const { return message_; }

  bool ReadRows(png_bytepp rows) {
    if (setjmp(png_jmpbuf(png_))) return false;
    png_read_image(png_, rows);
    png_read_end(png_, nullptr);
    return true;
  }

 private:
  static void OnError(png_structp png, png_const_charp what) {
    *static_cast<std::string*>(png_get_error_ptr(png)) = what;
    png_longjmp(png, 1);
  }
  static void OnWarning(png_structp, png_const_charp) {}
  static void Read(png_structp png, png_bytep to, std::size_t count) {
    auto* decoder = static_cast<PngDecoder*>(png_get_io_ptr(png));
    if (decoder->bytes_.size() < count) png_error(png, "read beyond end of data");
    std::memcpy(to, decoder->bytes_.data(), count);
    decoder->bytes_.remove_prefix(count);
  }

  std::string_view bytes_;
  std::string message_ = "libpng does not start";
  png_structp png_;
  png_infop info_ = nullptr;
};

Result<Image> DecodePng(std::string_view bytes) {
  PngDecoder png(bytes);
  if (!png.ReadHeader()) return Refused(Printable(png.message()));
  if (const Status sized = CheckSize(png.width(), png.height(), bytes.size()); !sized) {
    return sized.error();
  }
  Image image = NewImage(png.width(), png.height());
  std::vector<png_bytep> rows(png.height());
  for (std::size_t y = 0; y < rows.size(); ++y) {
    rows[y] = reinterpret_cast<png_bytep>(image.texels.data() + y * png.width());
  }
  if (!png.ReadRows(rows.data())) return Refused(Printable(png.message()));
  return image;
}

Result<Image> DecodeJpeg(std::string_view bytes) {
  const std::unique_ptr<void, int (*)(tjhandle)> decoder(tjInitDecompress(), &tjDestroy);
  if (!decoder) return Refused("libjpeg-turbo does not start");
  const auto* data = reinterpret_cast<const unsigned char*>(bytes.data());
  const auto failed = [&] { return Refused(Printable(tjGetErrorStr2(decoder.get()))); };
  int width = 0, height = 0, subsampling = 0, colours = 0;
  if (tjDecompressHeader3(decoder.get(), data, bytes.size(), &width, &height, &subsampling,
                          &colours) != 0) {
    return failed();
  }
  const auto side = [](int x) { return static_cast<std::uint64_t>(x); };
  if (const Status sized = CheckSize(side(width), side(height), bytes.size()); !sized) {
    return sized.error();
  }
  Image image = NewImage(side(width), side(height));
  if (tjDecompress2(decoder.get(), data, bytes.size(),
                    reinterpret_cast<unsigned char*>(image.texels.data()), width, 0, height,
                    TJPF_RGBA, 0) != 0) {
    return failed();
  }
  return image;
}

}  // namespace

Result<Image> DecodeImage(std::string_view bytes) {
  Result<Image> image = bytes.starts_with("\x89PNG")        ? DecodePng(bytes)
                        : bytes.starts_with("\xff\xd8\xff") ? DecodeJpeg(bytes)
                                                            : Refused("neither a PNG nor a JPEG");
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
  const Result<std::string> bytes = ReadWholeFile(path.value());
  if (!bytes) return bytes.error();
  Result<Image> decoded = DecodeImage(bytes.value());
  if (!decoded)
    return Refused(fmt::format("{}: {}", Printable(reference), decoded.error().message));
  decoded.value().name = std::filesystem::path(path.value()).filename().string();
  image = std::make_shared<const Image>(std::move(decoded).value());
  return image;
}

}  // namespace sheaf
