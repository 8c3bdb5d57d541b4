#include "src/formats/triangulate.h"

#include <glm/geometric.hpp>

namespace sheaf {
namespace {

using Point = glm::dvec3;

// Newell's method (Sutherland, Sproull, Schumacker 1974): right for concave outlines too.
Point NormalOf(std::span<const glm::vec3> positions, std::span<const std::uint32_t> polygon) {
  Point normal(0);
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point a(positions[polygon[i]]), b(positions[polygon[(i + 1) % polygon.size()]]);
    normal +=
        Point((a.y - b.y) * (a.z + b.z), (a.z - b.z) * (a.x + b.x), (a.x - b.x) * (a.y + b.y));
  }
  return normal;
}

// Whether no triangle of the fan from the first corner is turned over.
bool IsFan(std::span<const glm::vec3> positions, std::span<const std::uint32_t> polygon,
           const Point& normal) {
  const Point first(positions[polygon[0]]);
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
    const Point a = Point(positions[polygon[i]]) - first;
    const Point b = Point(positions[polygon[i + 1]]) - first;
    if (glm::dot(glm::cross(a, b), normal) < 0) return false;
  }
  return true;
}

// Meisters' ears, one after another: a corner that turns the way of the outline and holds no other
// in its triangle is cut off. Where rounding leaves no ear the sharpest corner goes, so that every
// polygon ends.
void ClipEars(std::span<const glm::vec3> positions, std::span<const std::uint32_t> polygon,
              const Point& normal, std::vector<std::array<std::uint32_t, 3>>& triangles) {
  std::vector<std::uint32_t> left(polygon.begin(), polygon.end());
  const auto at = [&](std::size_t i) { return Point(positions[left[i % left.size()]]); };
  const auto turn = [&](const Point& a, const Point& b, const Point& c) {
    return glm::dot(glm::cross(b - a, c - a), normal);
  };
  const auto is_ear = [&](std::size_t i) {
    const Point a = at(i + left.size() - 1), b = at(i), c = at(i + 1);
    if (!(turn(a, b, c) > 0)) return false;
    for (std::size_t k = i + 2; k < i + left.size() - 1; ++k) {
      const Point p = at(k);
      if (p == a || p == b || p == c) continue;
      if (turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0) return false;
    }
    return true;
  };
  std::size_t i = 0, tried = 0;
  while (left.size() > 3) {
    if (tried < left.size() && !is_ear(i % left.size())) {
      ++i, ++tried;
      continue;
    }
    i %= left.size();
    triangles.push_back(
        {left[(i + left.size() - 1) % left.size()], left[i], left[(i + 1) % left.size()]});
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(i));
    tried = 0;
  }
  triangles.push_back({left[0], left[1], left[2]});
}

}  // namespace

void Triangulate(std::span<const glm::vec3> positions, std::span<const std::uint32_t> polygon,
                 std::vector<std::array<std::uint32_t, 3>>& triangles) {
  if (polygon.size() < 3) return;
  if (polygon.size() == 3) return triangles.push_back({polygon[0], polygon[1], polygon[2]});
  const Point normal = NormalOf(positions, polygon);
  if (IsFan(positions, polygon, normal)) {
    for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
      triangles.push_back({polygon[0], polygon[i], polygon[i + 1]});
    }
    return;
  }
  ClipEars(positions, polygon, normal, triangles);
}

}  // namespace sheaf
