#include "src/formats/picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

#include "src/formats/file_ending.h"
#include "src/scene/srgb.h"

namespace sheaf {
namespace {

enum class Format { kPng, kPfm, kExr };

std::optional<Format> FormatOf(const std::string& path) {
  const std::string ending = FileEnding(path);
  if (ending == ".png") return Format::kPng;
  if (ending == ".pfm") return Format::kPfm;
  if (ending == ".exr") return Format::kExr;
  return std::nullopt;
}

// A whole number of 0 to `most`.
template <typename Integer>
Integer QuantizeChannel(float value, Transfer transfer, double most) {
  if (!(value > 0.0f)) return 0;  // NaN is not greater than 0 either
  if (value >= 1.0f) return static_cast<Integer>(most);
  const double encoded = transfer == Transfer::kSrgb ? SrgbEncode(value) : value;
  // In double both operations are exact for a float near a tie, so that halves round up, always.
  return static_cast<Integer>(std::floor(std::min(encoded, 1.0) * most + 0.5));
}

void Quantize(const float* values, std::size_t count, Transfer transfer, std::uint8_t* bytes) {
  std::transform(values, values + count, bytes, [transfer](float value) {
    return QuantizeChannel<std::uint8_t>(value, transfer, 255.0);
  });
}

// The higher byte first, as PNG has it.
void QuantizeTo16Bit(const float* values, std::size_t count, Transfer transfer,
                     std::uint8_t* bytes) {
  for (std::size_t i = 0; i < count; ++i) {
    const auto number = QuantizeChannel<std::uint16_t>(values[i], transfer, 65535.0);
    bytes[2 * i] = static_cast<std::uint8_t>(number >> 8);
    bytes[2 * i + 1] = static_cast<std::uint8_t>(number & 255);
  }
}

}  // namespace

std::vector<std::uint8_t> QuantizeTo8Bit(const Film& film, Transfer transfer) {
  std::vector<std::uint8_t> bytes(film.rgb.size());
  Quantize(film.rgb.data(), film.rgb.size(), transfer, bytes.data());
  return bytes;
}

Status CheckPicturePath(const std::string& path) {
  if (FormatOf(path)) return Done{};
  return Error{
      ErrorKind::kUsage,
      fmt::format("{}: unknown picture format; the name must end in .png, .pfm or .exr", path)};
}

bool HoldsFloats(const std::string& path) {
  return FormatOf(path) == Format::kPfm || FormatOf(path) == Format::kExr;
}

bool HoldsLayers(const std::string& path) { return FormatOf(path) == Format::kExr; }

Status CheckPictureBits(const std::string& path, int bits) {
  if (const Status known = CheckPicturePath(path); !known) return known;
  const Format format = *FormatOf(path);
  const bool fits = format == Format::kPng   ? bits == 8 || bits == 16
                    : format == Format::kExr ? bits == 16 || bits == 32
                                             : bits == 32;
  if (fits) return Done{};
  return Error{
      ErrorKind::kUsage,
      fmt::format("{}: {} bits a channel; .png has 8 or 16, .exr 16 or 32, .pfm 32", path, bits)};
}

Result<PictureWriter> PictureWriter::Create(const std::string& path, int width, int height,
                                            Transfer transfer) {
  return Create(path, WholePicture(width, height, transfer));
}

Result<PictureWriter> PictureWriter::Create(const std::string& path, const PictureSpec& spec) {
  const Status known = CheckPicturePath(path);
  if (!known) return known.error();
  if (spec.bits != 0) {
    if (const Status fits = CheckPictureBits(path, spec.bits); !fits) return fits.error();
  }
  const auto wrap = [&](auto writer) -> Result<PictureWriter> {
    if (!writer) return writer.error();
    return PictureWriter(std::move(writer).value(), spec);
  };
  switch (*FormatOf(path)) {
    case Format::kPfm:
      return wrap(PfmWriter::Create(path, spec.window.width(), spec.window.height()));
    case Format::kExr:
      return wrap(ExrWriter::Create(path, spec));
    case Format::kPng:
      break;
  }
  return wrap(PngWriter::Create(path, spec));
}

Status PictureWriter::WriteRows(const Film& rows) {
  if (auto* exr = std::get_if<ExrWriter>(&writer_)) return exr->WriteRows(rows);
  Status status = Done{};
  for (int y = 0; y < rows.height && status; ++y) {
    if (auto* pfm = std::get_if<PfmWriter>(&writer_)) {
      status = pfm->WriteRow(rows.pixel(0, y));
    } else {
      const std::size_t count = 3 * static_cast<std::size_t>(rows.width);
      row_.resize(bits_ == 16 ? 2 * count : count);
      if (bits_ == 16) {
        QuantizeTo16Bit(rows.pixel(0, y), count, transfer_, row_.data());
      } else {
        Quantize(rows.pixel(0, y), count, transfer_, row_.data());
      }
      status = std::get<PngWriter>(writer_).WriteRow(row_.data());
    }
  }
  return status;
}

Status PictureWriter::Finish() {
  return std::visit([](auto& writer) { return writer.Finish(); }, writer_);
}

Status WritePicture(const Film& film, Transfer transfer, const std::string& path) {
  return WritePicture(film, WholePicture(film.width, film.height, transfer), path);
}

Status WritePicture(const Film& film, const PictureSpec& spec, const std::string& path) {
  Result<PictureWriter> writer = PictureWriter::Create(path, spec);
  if (!writer) return writer.error();
  const Status written = writer.value().WriteRows(film);
  return written ? writer.value().Finish() : written;
}

Result<ReadPictureResult> ReadPicture(const std::string& path) {
  const Status known = CheckPicturePath(path);
  if (!known) return known.error();
  if (FormatOf(path) == Format::kExr) return ReadExr(path);
  if (FormatOf(path) == Format::kPng) return ReadPngFilm(path);
  Result<Film> film = ReadPfm(path);
  if (!film) return film.error();
  ReadPictureResult result;
  result.film = std::move(film).value();
  return result;
}

}  // namespace sheaf
