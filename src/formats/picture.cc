#include "src/formats/picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>

#include "src/formats/pfm.h"
#include "src/formats/png.h"
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

}  // namespace

std::vector<std::uint8_t> QuantizeTo8Bit(const Film& film, Transfer transfer) {
  std::vector<std::uint8_t> bytes(film.rgb.size());
  std::transform(film.rgb.begin(), film.rgb.end(), bytes.begin(),
                 [transfer](float value) { return QuantizeChannel(value, transfer); });
  return bytes;
}

Status CheckPicturePath(const std::string& path) {
  if (FormatOf(path)) return Done{};
  return Error{ErrorKind::kUsage,
               fmt::format("{}: unknown picture format; the name must end in .png or .pfm", path)};
}

Status WritePicture(const Film& film, Transfer transfer, const std::string& path) {
  const Status known = CheckPicturePath(path);
  if (!known) return known;
  if (FormatOf(path) == Format::kPfm) return WritePfm(film, path);
  return WritePng({film.width, film.height, QuantizeTo8Bit(film, transfer)}, transfer, path);
}

}  // namespace sheaf
