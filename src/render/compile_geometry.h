// The objects of a scene as the primitives that rays are traced against.
#ifndef SHEAF_RENDER_COMPILE_GEOMETRY_H_
#define SHEAF_RENDER_COMPILE_GEOMETRY_H_

#include <cstdint>
#include <glm/vec3.hpp>
#include <limits>
#include <vector>

#include "sheaf/scene.h"
#include "simd/instances.h"
#include "simd/primitives.h"
#include "src/bvh/build_instances.h"
#include "src/bvh/geometry_data.h"
#include "src/bvh/tree.h"
#include "src/render/place_scene.h"
#include "src/stream/frame_view.h"

namespace sheaf {

// Primitive ids follow the order of the scene's objects, then of its groups'; a quad is two
// triangles. What no ray can hit is kept, marked by a NaN.
template <typename Real>
struct CompiledGeometry {
  GeometryData<Real> data;
  std::vector<PrimitiveInfo> primitives;           // by primitive id
  std::vector<std::uint32_t> object_of_primitive;  // likewise: by ForEachObject's numbers
  // Of groups: where the primitives of each end, kind by kind, and its tree; then where they stand.
  std::vector<PrimitiveCounts> group_ends;
  std::vector<Tree<Real>> group_trees;
  std::vector<PlacedObject> places;  // until the trees are built; an object is a group
  std::vector<AffineMap> to_world;   // by instance
  InstanceForest<Real> forest;
  bool has_rounded_corners = false;  // any that RoundCorners moves

  // The trees over what the arrays hold, after CompileGeometry. Fails as BuildTree does.
  Status BuildTrees(int threads);
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
