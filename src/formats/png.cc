#include "src/formats/png.h"

#include <fmt/format.h>
#include <png.h>

#include <cerrno>
#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <memory>
#include <optional>
#include <string_view>

#include "src/core/atomic_file.h"
#include "src/core/version.h"

namespace sheaf {
namespace {

// libpng reports an error by longjmp, which runs no destructor. So every function below that may be
// jumped out of holds only trivial locals; what owns memory lives in its caller.

// Where libpng leaves its last words.
struct Complaint {
  char text[200] = "";
};

[[noreturn]] void OnError(png_structp png, png_const_charp message) {
  auto* complaint = static_cast<Complaint*>(png_get_error_ptr(png));
  std::snprintf(complaint->text, sizeof(complaint->text), "%s", message);
  png_longjmp(png, 1);
}

void OnWarning(png_structp, png_const_charp) {}

Error Failed(const std::string& path, std::string_view what) {
  return {ErrorKind::kInputOutput, fmt::format("{}: {}", path, what)};
}

class PngWriter {
 public:
  PngWriter()
      : png_(png_create_write_struct(PNG_LIBPNG_VER_STRING, &complaint, OnError, OnWarning)) {
    if (png_ != nullptr) info_ = png_create_info_struct(png_);
  }
  PngWriter(const PngWriter&) = delete;
  PngWriter& operator=(const PngWriter&) = delete;
  ~PngWriter() { png_destroy_write_struct(&png_, &info_); }

  // False: see `complaint`.
  bool Encode(const Picture8& picture, Transfer transfer, png_rw_ptr sink, void* sink_state) {
    if (info_ == nullptr) return false;
    if (setjmp(png_jmpbuf(png_))) return false;
    png_set_write_fn(png_, sink_state, sink, nullptr);
    png_set_IHDR(png_, info_, static_cast<png_uint_32>(picture.width),
                 static_cast<png_uint_32>(picture.height), 8, PNG_COLOR_TYPE_RGB,
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    if (transfer == Transfer::kSrgb) png_set_sRGB(png_, info_, PNG_sRGB_INTENT_PERCEPTUAL);
    char key[] = "Software";
    char software[64];
    std::snprintf(software, sizeof(software), "sheaf %s", kVersion);
    png_text text = {};
    text.compression = PNG_TEXT_COMPRESSION_NONE;
    text.key = key;
    text.text = software;
    png_set_text(png_, info_, &text, 1);
    png_write_info(png_, info_);
    const std::size_t stride = 3 * static_cast<std::size_t>(picture.width);
    for (int y = 0; y < picture.height; ++y) {
      png_write_row(png_, picture.rgb.data() + stride * static_cast<std::size_t>(y));
    }
    png_write_end(png_, info_);
    return true;
  }

  Complaint complaint;

 private:
  png_structp png_;
  png_infop info_ = nullptr;
};

// A failed write is kept, and later bytes are dropped, rather than thrown through libpng.
struct FileSink {
  AtomicFile file;
  std::optional<Error> error;
};

void WriteToSink(png_structp png, png_bytep data, png_size_t size) {
  auto* sink = static_cast<FileSink*>(png_get_io_ptr(png));
  if (sink->error) return;
  const Status status = sink->file.Write(data, size);
  if (!status) sink->error = status.error();
}

class PngReader {
 public:
  PngReader()
      : png_(png_create_read_struct(PNG_LIBPNG_VER_STRING, &complaint, OnError, OnWarning)) {
    if (png_ != nullptr) info_ = png_create_info_struct(png_);
  }
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;
  ~PngReader() { png_destroy_read_struct(&png_, &info_, nullptr); }

  // Reads up to the pixels and asks for 8-bit RGB. False: see `complaint`.
  bool ReadHeader(std::FILE* file) {
    if (info_ == nullptr) return false;
    if (setjmp(png_jmpbuf(png_))) return false;
    png_init_io(png_, file);
    png_set_user_limits(png_, kMaxImageSide, kMaxImageSide);
    png_read_info(png_, info_);
    png_set_expand(png_);
    png_set_scale_16(png_);
    png_set_strip_alpha(png_);
    png_set_gray_to_rgb(png_);
    png_set_interlace_handling(png_);
    png_read_update_info(png_, info_);
    width = static_cast<int>(png_get_image_width(png_, info_));
    height = static_cast<int>(png_get_image_height(png_, info_));
    row_bytes = png_get_rowbytes(png_, info_);
    return true;
  }

  bool ReadRows(png_bytepp rows) {
    if (setjmp(png_jmpbuf(png_))) return false;
    png_read_image(png_, rows);
    png_read_end(png_, nullptr);
    return true;
  }

  Complaint complaint;
  int width = 0, height = 0;
  std::size_t row_bytes = 0;

 private:
  png_structp png_;
  png_infop info_ = nullptr;
};

}  // namespace

Status WritePng(const Picture8& picture, Transfer transfer, const std::string& path) {
  Result<AtomicFile> file = AtomicFile::Create(path);
  if (!file) return file.error();
  FileSink sink{std::move(file).value(), std::nullopt};
  PngWriter writer;
  const bool encoded = writer.Encode(picture, transfer, &WriteToSink, &sink);
  if (sink.error) return *sink.error;
  if (!encoded) return Failed(path, fmt::format("cannot be encoded: {}", writer.complaint.text));
  return sink.file.Commit();
}

Result<Picture8> ReadPng(const std::string& path) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"),
                                                             &std::fclose);
  if (!file) return Failed(path, std::strerror(errno));
  PngReader reader;
  if (!reader.ReadHeader(file.get())) return Failed(path, reader.complaint.text);

  Picture8 picture{reader.width, reader.height, {}};
  const auto height = static_cast<std::size_t>(picture.height);
  // Deflate shrinks at most 1032 to 1: a header that promises more pixels than that lies. Packed
  // formats (1 bit a pixel, spread to 24) have that much less behind each byte.
  const long begin = std::ftell(file.get());
  if (std::fseek(file.get(), 0, SEEK_END) != 0) return Failed(path, "is no seekable file");
  const auto size = static_cast<std::size_t>(std::ftell(file.get()));
  std::fseek(file.get(), begin, SEEK_SET);
  if (reader.row_bytes * height / (24 * 1032) > size) {
    return Failed(path, "has more pixels than its bytes can hold");
  }
  picture.rgb.resize(reader.row_bytes * height);
  std::vector<png_bytep> rows(height);
  for (std::size_t y = 0; y < height; ++y) rows[y] = picture.rgb.data() + reader.row_bytes * y;
  if (!reader.ReadRows(rows.data())) return Failed(path, reader.complaint.text);
  return picture;
}

}  // namespace sheaf
