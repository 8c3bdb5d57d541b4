#include "src/formats/pfm.h"

#include <fmt/format.h>

#include <bit>
#include <cassert>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <memory>
#include <string_view>
#include <utility>
#include <vector>

#include "sheaf/scene.h"
#include "src/core/atomic_file.h"
#include "src/formats/read_file.h"

namespace sheaf {
namespace {

constexpr std::size_t kBytesPerPixel = 3 * sizeof(float);

std::uint32_t SwapBytes(std::uint32_t bits) {
  return bits >> 24 | (bits >> 8 & 0xff00u) | (bits << 8 & 0xff0000u) | bits << 24;
}

void SwapEachFloat(std::uint8_t* bytes, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    std::uint32_t bits;
    std::memcpy(&bits, bytes + 4 * i, 4);
    bits = SwapBytes(bits);
    std::memcpy(bytes + 4 * i, &bits, 4);
  }
}

bool IsSpace(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

// Takes white space and the word after it off the front of `text`.
std::string_view TakeWord(std::string_view& text) {
  while (!text.empty() && IsSpace(text.front())) text.remove_prefix(1);
  std::size_t length = 0;
  while (length < text.size() && !IsSpace(text[length])) ++length;
  const std::string_view word = text.substr(0, length);
  text.remove_prefix(length);
  return word;
}

template <typename T>
bool ParseWhole(std::string_view word, T& value) {
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return error == std::errc() && end == word.data() + word.size();
}

class PfmEncoder : public PictureEncoder {
 public:
  PfmEncoder(AtomicFile file, std::size_t header_bytes, int width, int height)
      : file_(std::move(file)),
        header_bytes_(header_bytes),
        row_bytes_(kBytesPerPixel * static_cast<std::size_t>(width)),
        rows_left_(static_cast<std::size_t>(height)),
        held_(file_.seekable() ? 0 : row_bytes_ * rows_left_) {}

  Status WriteRows(const Film& rows) override {
    Status status = Done{};
    for (int y = 0; y < rows.height && status; ++y) status = WriteRow(rows.pixel(0, y));
    return status;
  }

  Status Finish() override {
    assert(rows_left_ == 0);
    const Status written = file_.Write(held_.data(), held_.size());
    return written ? file_.Commit() : written;
  }

 private:
  Status WriteRow(const float* rgb) {
    assert(rows_left_ > 0);
    const void* bytes = rgb;
    std::vector<std::uint8_t> swapped;
    if constexpr (std::endian::native == std::endian::big) {
      swapped.resize(row_bytes_);
      std::memcpy(swapped.data(), rgb, row_bytes_);
      SwapEachFloat(swapped.data(), row_bytes_ / sizeof(float));
      bytes = swapped.data();
    }
    const std::size_t offset = row_bytes_ * --rows_left_;
    if (file_.seekable()) return file_.WriteAt(header_bytes_ + offset, bytes, row_bytes_);
    std::memcpy(held_.data() + offset, bytes, row_bytes_);
    return Done{};
  }

  AtomicFile file_;
  std::size_t header_bytes_, row_bytes_;
  std::size_t rows_left_;
  std::vector<std::uint8_t> held_;  // empty where the file is seekable
};

}  // namespace

NewEncoder CreatePfmEncoder(const std::string& path, const PictureSpec& spec) {
  Result<AtomicFile> file = AtomicFile::Create(path);
  if (!file) return file.error();
  const int width = spec.window.width(), height = spec.window.height();
  const std::string header = fmt::format("PF\n{} {}\n-1.0\n", width, height);
  const Status status = file.value().Write(header.data(), header.size());
  if (!status) return status.error();
  return std::unique_ptr<PictureEncoder>(
      std::make_unique<PfmEncoder>(std::move(file).value(), header.size(), width, height));
}

Status WritePfm(const Film& film, const std::string& path) {
  const NewEncoder encoder =
      CreatePfmEncoder(path, WholePicture(film.width, film.height, Transfer::kLinear));
  if (!encoder) return encoder.error();
  const Status written = encoder.value()->WriteRows(film);
  return written ? encoder.value()->Finish() : written;
}

Result<Film> ReadPfm(const std::string& path) {
  const Result<std::string> bytes = ReadWholeFile(path);
  if (!bytes) return bytes.error();
  std::string_view rest = bytes.value();

  const std::string_view magic = TakeWord(rest);
  if (magic == "Pf") return InputError(path, "a grey PFM; a colour one (PF) is needed");
  if (magic != "PF") return InputError(path, "no PFM: it does not begin with PF");
  int width = 0, height = 0;
  double scale = 0.0;
  if (!ParseWhole(TakeWord(rest), width) || !ParseWhole(TakeWord(rest), height) || width < 1 ||
      height < 1 || width > kMaxImageSide || height > kMaxImageSide) {
    return InputError(
        path, fmt::format("the PFM header needs a width and a height of 1 to {}", kMaxImageSide));
  }
  if (!ParseWhole(TakeWord(rest), scale) || !std::isfinite(scale) || scale == 0.0) {
    return InputError(path, "the PFM header needs a scale other than 0");
  }
  // One single byte of white space ends the header; the next may be a float's.
  if (rest.empty() || !IsSpace(rest.front()))
    return InputError(path, "the PFM header is cut short");
  rest.remove_prefix(1);

  const std::size_t row_bytes = kBytesPerPixel * static_cast<std::size_t>(width);
  const std::size_t expected = row_bytes * static_cast<std::size_t>(height);
  if (rest.size() != expected) {
    return InputError(path, fmt::format("{}x{} pixels need {} bytes after the header, not {}",
                                        width, height, expected, rest.size()));
  }
  Film film(width, height);
  for (int y = 0; y < height; ++y) {
    std::memcpy(film.pixel(0, height - 1 - y),
                rest.data() + row_bytes * static_cast<std::size_t>(y), row_bytes);
  }
  const bool little = scale < 0.0;
  if (little != (std::endian::native == std::endian::little)) {
    SwapEachFloat(reinterpret_cast<std::uint8_t*>(film.rgb.data()), film.rgb.size());
  }
  return film;
}

Result<ReadPictureResult> ReadPfmPicture(const std::string& path) {
  Result<Film> film = ReadPfm(path);
  if (!film) return film.error();
  ReadPictureResult result;
  result.film = std::move(film).value();
  return result;
}

}  // namespace sheaf
