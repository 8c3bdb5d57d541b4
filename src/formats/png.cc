#include "src/formats/png.h"

#include <fmt/format.h>
#include <png.h>

#include <cassert>
#include <cerrno>
#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>

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

// Owns libpng's state and the file; libpng keeps pointers into both, so that it never moves.
class PngWriter::Encoder {
 public:
  Encoder(AtomicFile file, std::string path, int width, int height)
      : path_(std::move(path)),
        file_(std::move(file)),
        width_(static_cast<png_uint_32>(width)),
        height_(static_cast<png_uint_32>(height)),
        rows_left_(height),
        png_(png_create_write_struct(PNG_LIBPNG_VER_STRING, &complaint_, OnError, OnWarning)) {
    if (png_ != nullptr) info_ = png_create_info_struct(png_);
  }
  Encoder(const Encoder&) = delete;
  Encoder& operator=(const Encoder&) = delete;
  ~Encoder() { png_destroy_write_struct(&png_, &info_); }

  Status WriteHeader(Transfer transfer) { return StatusOf(EncodeHeader(transfer)); }

  Status WriteRow(const std::uint8_t* rgb) {
    assert(rows_left_ > 0);
    --rows_left_;
    return StatusOf(EncodeRow(rgb));
  }

  Status Finish() {
    assert(rows_left_ == 0);
    const Status ended = StatusOf(EncodeEnd());
    return ended ? file_.Commit() : ended;
  }

 private:
  // False: see `complaint_`, and so for the two below.
  bool EncodeHeader(Transfer transfer) {
    if (info_ == nullptr) return false;
    if (setjmp(png_jmpbuf(png_))) return false;
    png_set_write_fn(png_, this, &WriteToFile, nullptr);
    png_set_IHDR(png_, info_, width_, height_, 8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
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
    return true;
  }

  bool EncodeRow(const std::uint8_t* rgb) {
    if (setjmp(png_jmpbuf(png_))) return false;
    png_write_row(png_, rgb);
    return true;
  }

  bool EncodeEnd() {
    if (setjmp(png_jmpbuf(png_))) return false;
    png_write_end(png_, info_);
    return true;
  }

  // A failed write is kept, and later bytes are dropped, rather than thrown through libpng.
  static void WriteToFile(png_structp png, png_bytep data, png_size_t size) {
    auto* encoder = static_cast<Encoder*>(png_get_io_ptr(png));
    if (encoder->error_) return;
    const Status status = encoder->file_.Write(data, size);
    if (!status) encoder->error_ = status.error();
  }

  Status StatusOf(bool encoded) const {
    if (error_) return *error_;
    if (!encoded) return Failed(path_, fmt::format("cannot be encoded: {}", complaint_.text));
    return Done{};
  }

  std::string path_;  // for messages
  AtomicFile file_;
  std::optional<Error> error_;  // the first failed write
  png_uint_32 width_, height_;
  int rows_left_;
  Complaint complaint_;
  png_structp png_;
  png_infop info_ = nullptr;
};

PngWriter::PngWriter(std::unique_ptr<Encoder> encoder) : encoder_(std::move(encoder)) {}
PngWriter::PngWriter(PngWriter&&) noexcept = default;
PngWriter::~PngWriter() = default;

Result<PngWriter> PngWriter::Create(const std::string& path, int width, int height,
                                    Transfer transfer) {
  Result<AtomicFile> file = AtomicFile::Create(path);
  if (!file) return file.error();
  auto encoder = std::make_unique<Encoder>(std::move(file).value(), path, width, height);
  const Status begun = encoder->WriteHeader(transfer);
  if (!begun) return begun.error();
  return PngWriter(std::move(encoder));
}

Status PngWriter::WriteRow(const std::uint8_t* rgb) { return encoder_->WriteRow(rgb); }

Status PngWriter::Finish() { return encoder_->Finish(); }

Status WritePng(const Picture8& picture, Transfer transfer, const std::string& path) {
  Result<PngWriter> writer = PngWriter::Create(path, picture.width, picture.height, transfer);
  if (!writer) return writer.error();
  const std::size_t stride = 3 * static_cast<std::size_t>(picture.width);
  for (int y = 0; y < picture.height; ++y) {
    const Status written =
        writer.value().WriteRow(picture.rgb.data() + stride * static_cast<std::size_t>(y));
    if (!written) return written;
  }
  return writer.value().Finish();
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
