#include "src/app/parse_options.h"

#include <algorithm>
#include <charconv>

#include "sheaf/render.h"
#include "sheaf/scene.h"

namespace sheaf {

namespace {

// All of `text`, within [min, max], which NaN is not.
template <typename T>
std::optional<T> ParseWithin(std::string_view text, T min, T max) {
  T value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  if (!(value >= min && value <= max)) return std::nullopt;
  return value;
}

}  // namespace

std::optional<int> ParseInteger(std::string_view text, int min, int max) {
  return ParseWithin(text, min, max);
}

std::optional<double> ParseNumber(std::string_view text, double min, double max) {
  return ParseWithin(text, min, max);
}

std::optional<PixelSize> ParseSize(std::string_view text) {
  const std::size_t cross = text.find('x');
  if (cross == std::string_view::npos) return std::nullopt;
  const std::optional<int> width = ParseInteger(text.substr(0, cross), 1, kMaxImageSide);
  const std::optional<int> height = ParseInteger(text.substr(cross + 1), 1, kMaxImageSide);
  if (!width || !height) return std::nullopt;
  return PixelSize{*width, *height};
}

std::optional<PixelRect> ParseRect(std::string_view text) {
  const std::vector<std::string> words = SplitAtCommas(text);
  if (words.size() != 4) return std::nullopt;
  int sides[4];
  for (std::size_t i = 0; i < 4; ++i) {
    const std::optional<int> side = ParseInteger(words[i], 0, kMaxImageSide);
    if (!side) return std::nullopt;
    sides[i] = *side;
  }
  const PixelRect rect{sides[0], sides[1], sides[2], sides[3]};
  if (rect.width() <= 0 || rect.height() <= 0) return std::nullopt;
  return rect;
}

std::optional<std::vector<int>> ParseThreads(const std::string& text) {
  std::vector<int> counts;
  for (const std::string& word : SplitAtCommas(text)) {
    const std::optional<int> count = ParseInteger(word, 1, kMaxThreads);
    if (!count || std::find(counts.begin(), counts.end(), *count) != counts.end()) return {};
    counts.push_back(*count);
  }
  return counts;
}

std::vector<std::string> SplitAtCommas(std::string_view text) {
  std::vector<std::string> parts;
  for (;;) {
    const std::size_t comma = text.find(',');
    parts.emplace_back(text.substr(0, comma));
    if (comma == std::string_view::npos) return parts;
    text.remove_prefix(comma + 1);
  }
}

}  // namespace sheaf
