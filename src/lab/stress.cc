#include "src/lab/stress.h"

#include <fmt/format.h>

#include <cstdlib>
#include <limits>

namespace sheaf::stress {

std::string RayText(const Ray& ray) {
  return fmt::format("{:a},{:a},{:a},{:a},{:a},{:a},{:a},{:a},{}", ray.origin.x, ray.origin.y,
                     ray.origin.z, ray.direction.x, ray.direction.y, ray.direction.z, ray.t_min,
                     ray.t_max, ray.source);
}

std::optional<Ray> ParseRay(const std::string& text) {
  Ray ray;
  float* const numbers[] = {&ray.origin.x,    &ray.origin.y,    &ray.origin.z, &ray.direction.x,
                            &ray.direction.y, &ray.direction.z, &ray.t_min,    &ray.t_max};
  const char* at = text.c_str();
  char* end = nullptr;
  for (float* number : numbers) {
    *number = std::strtof(at, &end);
    if (end == at || *end != ',') return std::nullopt;
    at = end + 1;
  }
  const unsigned long source = std::strtoul(at, &end, 10);
  if (end == at || *end != '\0' || source > std::numeric_limits<std::uint32_t>::max()) {
    return std::nullopt;
  }
  ray.source = static_cast<std::uint32_t>(source);
  return ray;
}

void Report::Expect(bool holds, const std::string& what, const Ray* ray) {
  ++checks_;
  if (holds) return;
  ++failures_;
  if (lines_.size() >= kMaxLines) return;
  lines_.push_back(ray ? fmt::format("{}; ray {}", what, RayText(*ray)) : what);
}

}  // namespace sheaf::stress
