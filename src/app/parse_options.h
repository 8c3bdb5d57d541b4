// Turns the text of an option into a value. Whole words only: "12x" is no number and "0x10" no 16.
#ifndef SHEAF_APP_PARSE_OPTIONS_H_
#define SHEAF_APP_PARSE_OPTIONS_H_

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sheaf/film.h"

namespace sheaf {

struct PixelSize {
  int width, height;
};

// Decimal, within [min, max].
std::optional<int> ParseInteger(std::string_view text, int min, int max);

// Decimal, with or without an exponent, within [min, max]; not NaN.
std::optional<double> ParseNumber(std::string_view text, double min, double max);

// "640x480", each side in [1, kMaxImageSide].
std::optional<PixelSize> ParseSize(std::string_view text);

// "x0,y0,x1,y1" with 0 <= x0 < x1 <= kMaxImageSide, and so for y.
std::optional<PixelRect> ParseRect(std::string_view text);

// "1,2,4": counts of threads, each in [1, kMaxThreads], none twice.
std::optional<std::vector<int>> ParseThreads(const std::string& text);

// The parts between commas; "a,,b" has an empty one.
std::vector<std::string> SplitAtCommas(std::string_view text);

}  // namespace sheaf

#endif  // SHEAF_APP_PARSE_OPTIONS_H_
