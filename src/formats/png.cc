#include "src/formats/png.h"

#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <memory>
#include <new>
#include <optional>
#include <utility>

#include "sheaf/version.h"
#include "src/core/atomic_file.h"
#include "src/core/out_of_memory.h"
#include "src/formats/png_reader.h"
#include "src/formats/printable.h"
#include "src/formats/quantize.h"
#include "src/formats/read_file.h"

namespace sheaf {
namespace {

// Owns libpng's state and the file; libpng keeps pointers into both, so that it never moves.
class PngWriter {
 public:
  PngWriter(AtomicFile file, std::string path, const PictureSpec& spec, int channels)
      : path_(std::move(path)),
        file_(std::move(file)),
        spec_(spec),
        channels_(channels),
        rows_left_(spec.window.height()),
        png_(png_create_write_struct_2(PNG_LIBPNG_VER_STRING, &complaint_, &OnPngError,
                                       &OnPngWarning, &heap_, &PngHeap::Allocate, &PngHeap::Free)) {
    if (png_ != nullptr) info_ = png_create_info_struct(png_);
    if (info_ != nullptr) return;
    png_destroy_write_struct(&png_, nullptr);
    throw std::bad_alloc();  // nothing else can be missing
  }
  PngWriter(const PngWriter&) = delete;
  PngWriter& operator=(const PngWriter&) = delete;
  ~PngWriter() { png_destroy_write_struct(&png_, &info_); }

  Status WriteHeader() {
    texts_ = {{"Software", fmt::format("sheaf {}", kVersion)}};
    texts_.insert(texts_.end(), spec_.metadata.begin(), spec_.metadata.end());
    if (!spec_.is_whole()) {
      texts_.emplace_back(kPngSizeKey, fmt::format("{}x{}", spec_.full_width, spec_.full_height));
    }
    return StatusOf(EncodeHeader());
  }

  // The next row from the top: channels * width bytes, or pairs of them, the higher first.
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
  bool EncodeHeader() {
    if (setjmp(png_jmpbuf(png_))) return false;
    png_set_write_fn(png_, this, &WriteToFile, nullptr);
    // Of the filters, that of the pixel before is best for most pictures, and no row has to be
    // filtered in five ways to choose one. docs/benchmarking.md has other levels.
    png_set_filter(png_, PNG_FILTER_TYPE_BASE, PNG_FILTER_SUB);
    png_set_compression_level(png_, 4);
    png_set_IHDR(png_, info_, static_cast<png_uint_32>(spec_.window.width()),
                 static_cast<png_uint_32>(spec_.window.height()), spec_.bits == 16 ? 16 : 8,
                 channels_ == 4 ? PNG_COLOR_TYPE_RGBA : PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    // Without either, a viewer takes bytes for sRGB.
    if (spec_.values != Values::kNumbers) {
      if (spec_.transfer == Transfer::kSrgb) {
        png_set_sRGB(png_, info_, PNG_sRGB_INTENT_PERCEPTUAL);
      } else {
        png_set_gAMA_fixed(png_, info_, PNG_FP_1);
      }
    }
    if (!spec_.is_whole()) {
      png_set_oFFs(png_, info_, spec_.window.x0, spec_.window.y0, PNG_OFFSET_PIXEL);
    }
    for (std::size_t i = 0; i < texts_.size(); ++i) {
      // Latin-1 for what is ASCII anyway, UTF-8 for what came from a user.
      png_text text = {};
      text.compression = i == 0 ? PNG_TEXT_COMPRESSION_NONE : PNG_ITXT_COMPRESSION_NONE;
      text.key = texts_[i].first.data();
      text.text = texts_[i].second.data();
      png_set_text(png_, info_, &text, 1);
    }
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
    auto* writer = static_cast<PngWriter*>(png_get_io_ptr(png));
    if (writer->error_) return;
    const Status status = writer->file_.Write(data, size);
    if (!status) writer->error_ = status.error();
  }

  Status StatusOf(bool encoded) {
    if (error_) return *error_;
    if (!encoded) heap_.Explain(&complaint_);
    if (!encoded) return InputError(path_, fmt::format("cannot be encoded: {}", complaint_.text));
    return Done{};
  }

  std::string path_;  // for messages
  AtomicFile file_;
  std::optional<Error> error_;  // the first failed write
  PictureSpec spec_;
  PictureMetadata texts_;
  int channels_, rows_left_;
  PngComplaint complaint_;
  PngHeap heap_;
  png_structp png_;
  png_infop info_ = nullptr;
};

Result<std::unique_ptr<PngWriter>> OpenPng(const std::string& path, const PictureSpec& spec,
                                           int channels = 3) {
  Result<AtomicFile> file = AtomicFile::Create(path);
  if (!file) return file.error();
  auto writer = std::make_unique<PngWriter>(std::move(file).value(), path, spec, channels);
  const Status begun = writer->WriteHeader();
  if (!begun) return begun.error();
  return writer;
}

class PngEncoder : public PictureEncoder {
 public:
  PngEncoder(std::unique_ptr<PngWriter> writer, const PictureSpec& spec)
      : writer_(std::move(writer)),
        transfer_(spec.values == Values::kLight ? spec.transfer : Transfer::kLinear),
        quantize_(spec.bits == 16 ? &QuantizeRowTo16Bit : &QuantizeRowTo8Bit),
        row_(3 * static_cast<std::size_t>(spec.window.width()) * (spec.bits == 16 ? 2 : 1)) {}

  Status WriteRows(const Film& rows) override {
    Status status = Done{};
    for (int y = 0; y < rows.height && status; ++y) {
      quantize_(rows.pixel(0, y), 3 * static_cast<std::size_t>(rows.width), transfer_, row_.data());
      status = writer_->WriteRow(row_.data());
    }
    return status;
  }

  Status Finish() override { return writer_->Finish(); }

 private:
  std::unique_ptr<PngWriter> writer_;
  Transfer transfer_;
  void (*quantize_)(const float*, std::size_t, Transfer, std::uint8_t*);
  std::vector<std::uint8_t> row_;
};

// The pixels of a file, rows from the top; `reader` then says what they are.
Result<std::vector<std::uint8_t>> ReadPixels(const std::string& path, PngPixels pixels,
                                             PngReader& reader) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"),
                                                             &std::fclose);
  if (!file) {
    ThrowIfOutOfMemory(errno);
    return InputError(path, std::strerror(errno));
  }
  const auto failed = [&] {
    return InputError(path, std::feof(file.get()) != 0
                                ? "no whole PNG: the file is empty or cut short"
                                : Printable(reader.complaint.text));
  };
  if (std::fseek(file.get(), 0, SEEK_END) != 0) return InputError(path, "is no seekable file");
  const auto size = static_cast<std::size_t>(std::ftell(file.get()));
  std::rewind(file.get());
  if (!reader.ReadHeader(file.get(), size, pixels)) return failed();

  const auto height = static_cast<std::size_t>(reader.height);
  // Deflate shrinks at most 1032 to 1: a header that promises more pixels than that lies. Packed
  // formats (1 bit a pixel, spread to 24) have that much less behind each byte.
  if (reader.row_bytes * height / (std::size_t{24} * 1032) > size) {
    return InputError(path, "has more pixels than its bytes can hold");
  }
  std::vector<std::uint8_t> bytes(reader.row_bytes * height);
  if (!reader.ReadRows(bytes.data())) return failed();
  return bytes;
}

}  // namespace

NewEncoder CreatePngEncoder(const std::string& path, const PictureSpec& spec) {
  Result<std::unique_ptr<PngWriter>> writer = OpenPng(path, spec);
  if (!writer) return writer.error();
  return std::unique_ptr<PictureEncoder>(
      std::make_unique<PngEncoder>(std::move(writer).value(), spec));
}

Status WritePng(const Picture8& picture, Transfer transfer, const std::string& path) {
  const Result<std::unique_ptr<PngWriter>> writer =
      OpenPng(path, WholePicture(picture.width, picture.height, transfer), picture.channels);
  if (!writer) return writer.error();
  const std::size_t stride =
      static_cast<std::size_t>(picture.channels) * static_cast<std::size_t>(picture.width);
  for (int y = 0; y < picture.height; ++y) {
    const Status written =
        writer.value()->WriteRow(picture.rgb.data() + stride * static_cast<std::size_t>(y));
    if (!written) return written;
  }
  return writer.value()->Finish();
}

Result<Picture8> ReadPng(const std::string& path) {
  PngReader reader;
  Result<std::vector<std::uint8_t>> bytes = ReadPixels(path, PngPixels::kRgb8, reader);
  if (!bytes) return bytes.error();
  return Picture8{reader.width, reader.height, std::move(bytes).value()};
}

Result<ReadPictureResult> ReadPngFilm(const std::string& path) {
  PngReader reader;
  const Result<std::vector<std::uint8_t>> read = ReadPixels(path, PngPixels::kRgb8Or16, reader);
  if (!read) return read.error();
  const std::vector<std::uint8_t>& bytes = read.value();
  ReadPictureResult result;
  result.film = Film(reader.width, reader.height);
  for (std::size_t i = 0; i < result.film.rgb.size(); ++i) {
    const double value =
        reader.bits == 16 ? (bytes[2 * i] << 8 | bytes[2 * i + 1]) / 65535.0 : bytes[i] / 255.0;
    result.film.rgb[i] = static_cast<float>(value);
  }
  result.is_display = true;
  result.bits = reader.bits;
  result.is_srgb = reader.is_srgb;
  result.is_linear = reader.is_linear;
  result.metadata = reader.metadata;
  const bool is_part = reader.full_width > 0 && reader.full_height > 0;
  // Whatever a file says, the sums below do not overflow.
  const int x0 = is_part ? std::clamp(reader.offset_x, -1, kMaxImageSide) : 0;
  const int y0 = is_part ? std::clamp(reader.offset_y, -1, kMaxImageSide) : 0;
  result.window = {x0, y0, x0 + reader.width, y0 + reader.height};
  result.full_width = is_part ? reader.full_width : reader.width;
  result.full_height = is_part ? reader.full_height : reader.height;
  return result;
}

}  // namespace sheaf
