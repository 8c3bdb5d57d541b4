// The objects of a scene as the primitives that rays are traced against.
#ifndef SHEAF_RENDER_COMPILE_GEOMETRY_H_
#define SHEAF_RENDER_COMPILE_GEOMETRY_H_

#include <cstdint>
#include <glm/vec3.hpp>
#include <limits>
#include <vector>

#include "sheaf/scene.h"
#include "simd/primitives.h"
#include "src/bvh/geometry_data.h"
#include "src/render/place_scene.h"
#include "src/stream/frame_view.h"

namespace sheaf {

// Primitive ids follow the order of the scene's objects; a quad is two triangles. What no ray can
// hit is kept, marked by a NaN.
template <typename Real>
struct CompiledGeometry {
  GeometryData<Real> data;
  std::vector<PrimitiveInfo> primitives;           // by primitive id
  std::vector<std::uint32_t> object_of_primitive;  // likewise
};

// Around all that primitives are made of, where they are placed; low > high where there are none.
struct PointBounds {
  glm::dvec3 low{std::numeric_limits<double>::infinity()};
  glm::dvec3 high{-std::numeric_limits<double>::infinity()};
};

// Whether the alphas of the mesh's vertices show on the material.
inline bool ShowsAlphas(const Mesh& mesh, const Material& material) {
  return !mesh.alphas.empty() && material.alpha.mode != AlphaMode::kOpaque;
}

// Fills `to`, all but its tree. The scene has no more primitives of a kind than CheckCounts allows.
template <typename Real>
PointBounds CompileGeometry(const Scene& scene, const ScenePlacement& placement,
                            CompiledGeometry<Real>& to);

}  // namespace sheaf

#endif  // SHEAF_RENDER_COMPILE_GEOMETRY_H_
