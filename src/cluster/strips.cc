#include "src/cluster/strips.h"

#include <algorithm>
#include <utility>

namespace sheaf {
namespace {

void CopyRows(const Film& from, int to_x, Film* to) {
  for (int y = 0; y < from.height; ++y) {
    std::copy_n(from.pixel(0, y), 3 * from.width, to->pixel(to_x, y));
    for (int i = 0; i < kLayerCount; ++i) {
      const Layer layer = static_cast<Layer>(i);
      if (!from.has(layer)) continue;
      std::copy_n(from.at(layer, 0, y), kLayerChannels[i] * from.width, to->at(layer, to_x, y));
    }
  }
}

}  // namespace

void Strips::Add(const PixelRect& area, Film film) {
  const std::int64_t pixels = std::int64_t{area.width()} * area.height();
  Strip& strip = strips_[area.y0];
  if (area.width() == pixels_.width()) {
    strip.film = std::move(film);
    held_pixels_ += pixels;
    return;
  }
  if (strip.film.height == 0) {
    strip.film.Resize(pixels_.width(), area.height(), film.held_layers());
    strip.missing = std::int64_t{pixels_.width()} * area.height();
    held_pixels_ += strip.missing;
  }
  CopyRows(film, area.x0 - pixels_.x0, &strip.film);
  strip.missing -= pixels;
}

std::optional<Film> Strips::Take() {
  const auto first = strips_.begin();
  if (first == strips_.end() || first->first != top_ || first->second.missing > 0) {
    return std::nullopt;
  }
  Film film = std::move(first->second.film);
  strips_.erase(first);
  top_ += film.height;
  held_pixels_ -= static_cast<std::int64_t>(film.pixel_count());
  return film;
}

}  // namespace sheaf
