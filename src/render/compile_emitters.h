// The triangles of a scene that shine, as a light to draw from.
#ifndef SHEAF_RENDER_COMPILE_EMITTERS_H_
#define SHEAF_RENDER_COMPILE_EMITTERS_H_

#include <span>
#include <vector>

#include "simd/shading.h"
#include "src/render/compile_geometry.h"

namespace sheaf {

// Owns what its view shows.
template <typename Real>
struct EmitterTable {
  EmitterTable() = default;
  EmitterTable(const EmitterTable&) = delete;
  EmitterTable& operator=(const EmitterTable&) = delete;

  std::vector<Real> corner[3], edge1[3], edge2[3], normal[3];
  std::vector<Real> offset, density, rgb[3], threshold, alias;
  EmitterView<Real> view{};
};

// Fills the table with the triangles of materials that shine alike all over and from both sides,
// and tells these materials how densely they are drawn; leaves both alone where there are none.
template <typename Real>
void CompileEmitters(const CompiledGeometry<Real>& geometry,
                     std::span<MaterialData<Real>> materials, EmitterTable<Real>& table);

}  // namespace sheaf

#endif  // SHEAF_RENDER_COMPILE_EMITTERS_H_
