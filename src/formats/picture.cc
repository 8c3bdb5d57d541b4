#include "src/formats/picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

#include "src/scene/srgb.h"

namespace sheaf {
namespace {

enum class Format { kPng, kPfm };

std::optional<Format> FormatOf(const std::string& path) {
  const std::size_t dot = path.rfind('.');
  if (dot == std::string::npos) return std::nullopt;
  std::string ending = path.substr(dot);
  // Not std::tolower: it would follow the locale.
  for (char& c : ending) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  if (ending == ".png") return Format::kPng;
  if (ending == ".pfm") return Format::kPfm;
  return std::nullopt;
}

std::uint8_t QuantizeChannel(float value, Transfer transfer) {
  if (!(value > 0.0f)) return 0;  // NaN is not greater than 0 either
  if (value >= 1.0f) return 255;
  const double encoded = transfer == Transfer::kSrgb ? SrgbEncode(value) : value;
  // In double both operations are exact for a float near a tie, so that halves round up, always.
  return static_cast<std::uint8_t>(std::floor(std::min(encoded, 1.0) * 255.0 + 0.5));
}

void Quantize(const float* values, std::size_t count, Transfer transfer, std::uint8_t* bytes) {
  std::transform(values, values + count, bytes,
                 [transfer](float value) { return QuantizeChannel(value, transfer); });
}

}  // namespace

std::vector<std::uint8_t> QuantizeTo8Bit(const Film& film, Transfer transfer) {
  std::vector<std::uint8_t> bytes(film.rgb.size());
  Quantize(film.rgb.data(), film.rgb.size(), transfer, bytes.data());
  return bytes;
}

Status CheckPicturePath(const std::string& path) {
  if (FormatOf(path)) return Done{};
  return Error{ErrorKind::kUsage,
               fmt::format("{}: unknown picture format; the name must end in .png or .pfm", path)};
}

bool HoldsFloats(const std::string& path) { return FormatOf(path) == Format::kPfm; }

Result<PictureWriter> PictureWriter::Create(const std::string& path, int width, int height,
                                            Transfer transfer) {
  const Status known = CheckPicturePath(path);
  if (!known) return known.error();
  if (FormatOf(path) == Format::kPfm) {
    Result<PfmWriter> writer = PfmWriter::Create(path, width, height);
    if (!writer) return writer.error();
    return PictureWriter(std::move(writer).value(), transfer);
  }
  Result<PngWriter> writer = PngWriter::Create(path, width, height, transfer);
  if (!writer) return writer.error();
  return PictureWriter(std::move(writer).value(), transfer);
}

Status PictureWriter::WriteRows(const Film& rows) {
  Status status = Done{};
  for (int y = 0; y < rows.height && status; ++y) {
    if (auto* pfm = std::get_if<PfmWriter>(&writer_)) {
      status = pfm->WriteRow(rows.pixel(0, y));
    } else {
      row_.resize(3 * static_cast<std::size_t>(rows.width));
      Quantize(rows.pixel(0, y), row_.size(), transfer_, row_.data());
      status = std::get<PngWriter>(writer_).WriteRow(row_.data());
    }
  }
  return status;
}

Status PictureWriter::Finish() {
  return std::visit([](auto& writer) { return writer.Finish(); }, writer_);
}

Status WritePicture(const Film& film, Transfer transfer, const std::string& path) {
  Result<PictureWriter> writer = PictureWriter::Create(path, film.width, film.height, transfer);
  if (!writer) return writer.error();
  const Status written = writer.value().WriteRows(film);
  return written ? writer.value().Finish() : written;
}

Result<ReadPictureResult> ReadPicture(const std::string& path) {
  const Status known = CheckPicturePath(path);
  if (!known) return known.error();
  if (FormatOf(path) == Format::kPfm) {
    Result<Film> film = ReadPfm(path);
    if (!film) return film.error();
    return ReadPictureResult{std::move(film).value(), false};
  }
  const Result<Picture8> picture = ReadPng(path);
  if (!picture) return picture.error();
  Film film(picture.value().width, picture.value().height);
  std::transform(picture.value().rgb.begin(), picture.value().rgb.end(), film.rgb.begin(),
                 [](std::uint8_t byte) { return static_cast<float>(byte / 255.0); });
  return ReadPictureResult{std::move(film), true};
}

}  // namespace sheaf
