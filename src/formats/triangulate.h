// Polygons into triangles.
#ifndef SHEAF_FORMATS_TRIANGULATE_H_
#define SHEAF_FORMATS_TRIANGULATE_H_

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace sheaf {

// Appends triangles of `polygon`, which names corners in `positions`, each below their number: a
// fan where that is right, else ears. A polygon of n corners gives n - 2 triangles, with the
// polygon's front; corners on a line give some without area, so that neighbours keep their edges.
void Triangulate(std::span<const glm::vec3> positions, std::span<const std::uint32_t> polygon,
                 std::vector<std::array<std::uint32_t, 3>>& triangles);

}  // namespace sheaf

#endif  // SHEAF_FORMATS_TRIANGULATE_H_
