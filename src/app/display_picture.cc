#include "src/app/display_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "src/app/choose.h"
#include "src/formats/picture.h"
#include "src/formats/printable.h"
#include "src/scene/srgb.h"

namespace sheaf {

Result<Film> ReadDisplayValues(const std::string& path, Transfer transfer) {
  Result<ReadPictureResult> read = ReadPicture(path);
  if (!read) return read.error();
  Film film = std::move(read.value().film);
  if (transfer == Transfer::kSrgb && !read.value().is_display) {
    for (float& value : film.rgb) {
      value = static_cast<float>(SrgbEncode(static_cast<double>(value)));
    }
  }
  return film;
}

void ClampToDisplay(Film& film) {
  for (float& value : film.rgb) value = value > 0 ? std::min(value, 1.0f) : 0.0f;
}

Status CheckSameSize(const std::string& path, const Film& film, const std::string& reference_path,
                     const Film& reference) {
  if (film.width == reference.width && film.height == reference.height) return Done{};
  return Usage(fmt::format("{}: {}x{} pixels, and {} has {}x{}", PrintablePath(path), film.width,
                           film.height, PrintablePath(reference_path), reference.width,
                           reference.height));
}

}  // namespace sheaf
