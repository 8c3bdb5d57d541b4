#include "src/render/sample_pattern.h"

#include <bit>
#include <cstdint>

#include "src/render/pixel_filter.h"
#include "src/scalar/draw_sample.h"

namespace sheaf {

std::vector<glm::dvec2> SamplePattern(int count, PixelFilter filter) {
  const double cells = static_cast<double>(std::bit_ceil(static_cast<std::uint32_t>(count)));
  std::vector<glm::dvec2> points;
  for (int i = 0; i < count; ++i) {
    double inverse = 0, digit = 0.5;
    for (int rest = i; rest > 0; rest >>= 1, digit /= 2) inverse += (rest & 1) * digit;
    points.push_back(
        {FilterPlace(filter, (i + 0.5) / count), FilterPlace(filter, inverse + 0.5 / cells)});
  }
  return points;
}

std::vector<glm::dvec2> SobolPattern(int count, PixelFilter filter) {
  // Turned over at the highest bit, 0 is 1/2. A half of the last place keeps all inside.
  const auto place = [&](std::uint32_t reversed) {
    const std::uint32_t bits = scalar::ReverseBits(reversed ^ 1u);
    return FilterPlace(filter, (static_cast<double>(bits) + 0.5) * 0x1p-32);
  };
  std::vector<glm::dvec2> points;
  for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(count); ++i) {
    points.push_back({place(i), place(scalar::PascalProduct(i))});
  }
  return points;
}

}  // namespace sheaf
