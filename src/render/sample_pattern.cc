#include "src/render/sample_pattern.h"

#include <bit>
#include <cstdint>

#include "src/render/pixel_filter.h"

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

}  // namespace sheaf
