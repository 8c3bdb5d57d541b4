// How many pixels of two pictures differ so that one can see it.
#ifndef SHEAF_TESTS_PIXELS_OVER_H_
#define SHEAF_TESTS_PIXELS_OVER_H_

#include <doctest/doctest.h>

#include <algorithm>
#include <cstdlib>

#include "sheaf/film.h"
#include "src/formats/quantize.h"

namespace sheaf {

// Pixels with a channel more than 1/255 apart, as 8-bit pictures show them.
inline int PixelsOver(const Film& a, const Film& b) {
  const auto x = QuantizeTo8Bit(a, Transfer::kLinear), y = QuantizeTo8Bit(b, Transfer::kLinear);
  REQUIRE(x.size() == y.size());
  int over = 0;
  for (std::size_t i = 0; i < x.size(); i += 3) {
    int largest = 0;
    for (std::size_t k = i; k < i + 3; ++k) largest = std::max(largest, std::abs(x[k] - y[k]));
    over += largest > 1;
  }
  return over;
}

}  // namespace sheaf

#endif  // SHEAF_TESTS_PIXELS_OVER_H_
