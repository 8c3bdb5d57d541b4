// The inside of a public Geometry, for those that need it: its tree and its arrays.
#ifndef SHEAF_BVH_GEOMETRY_ACCESS_H_
#define SHEAF_BVH_GEOMETRY_ACCESS_H_

#include <cstdint>
#include <span>
#include <vector>

#include "sheaf/error.h"
#include "sheaf/geometry.h"
#include "simd/query.h"
#include "simd/streams.h"
#include "simd/tree.h"
#include "src/bvh/geometry_data.h"

namespace sheaf {

// The objects of a GeometryInput as flat arrays.
struct FlatInput {
  GeometryArrays<float> arrays;
  std::vector<std::uint32_t> first;  // primitive of each object; the last is the number of all
  std::uint32_t never_hit = 0;
};

struct GeometryAccess {
  // Primitives of any kind but triangles, whose numbers are vertices and indices.
  static void Add(GeometryInput& input, PrimitiveKind kind, std::span<const float> fields);

  // Fails as Geometry::Build does.
  static Result<FlatInput> Flatten(const GeometryInput& input, int threads);

  static const TreeView<float>& TreeOf(const Geometry& geometry);
};

// The same pointers in the kernels' terms, and back.
RayView<float> ViewOf(const RayArrays& rays);
RayArrays ArraysOf(const RayView<float>& rays);
RayIntervals<float> IntervalsOf(const TraceInterval& interval);
TraceInterval IntervalOf(const RayIntervals<float>& intervals);

static_assert(static_cast<std::uint32_t>(PrimitiveKind::kSphere) == 1);  // as in GeometryInput
static_assert(Geometry::kNoPrimitive == kNoPrimitive && Geometry::kInsideBit == kInsideBit);

}  // namespace sheaf

#endif  // SHEAF_BVH_GEOMETRY_ACCESS_H_
