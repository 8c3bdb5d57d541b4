// Spheres and triangles to trace rays against: the library without the renderer.
//
//   GeometryInput input;
//   input.AddTriangles(vertices, indices);
//   Result<Geometry> geometry = Geometry::Build(input);
//   TraceClosest(geometry.value(), rays.view(), count, hits);
#ifndef SHEAF_BVH_GEOMETRY_H_
#define SHEAF_BVH_GEOMETRY_H_

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "sheaf/error.h"
#include "sheaf/target.h"
#include "simd/query.h"
#include "simd/streams.h"
#include "simd/tree.h"
#include "src/bvh/tree.h"

namespace sheaf {

// The objects of a geometry, by reference: what the spans show must live until Build has returned.
// Objects are numbered from 0 in the order of the calls, primitives from 0 through all objects.
class GeometryInput {
 public:
  // `vertices`: x, y, z each; `indices`: three vertices a triangle. Returns the object's id.
  std::uint32_t AddTriangles(std::span<const float> vertices,
                             std::span<const std::uint32_t> indices);
  // `spheres`: center x, y, z and radius each. Returns the object's id.
  std::uint32_t AddSpheres(std::span<const float> spheres);

 private:
  friend class Geometry;
  struct Object {
    bool is_mesh;
    std::span<const float> numbers;          // vertices or spheres
    std::span<const std::uint32_t> indices;  // of a mesh
  };
  std::vector<Object> objects_;
};

struct GeometryStatistics {
  std::uint32_t triangles, spheres;  // in the tree
  std::uint32_t never_hit;           // left out: triangles without area, spheres of radius 0
  std::uint32_t nodes, leaves, depth;
  std::size_t bytes;  // of everything the geometry holds
};

class Geometry {
 public:
  // Fails with kUsage and the object's and the primitive's number where an index is out of range, a
  // coordinate is not finite, a radius is negative, a count does not divide or there are more than
  // kMaxTreePrimitives of a kind. The geometry does not depend on `threads` (0: one a core).
  static Result<Geometry> Build(const GeometryInput& input, int threads = 0);

  const TreeView<float>& tree() const { return view_; }
  // The smallest box around the primitives, up to kBoxGrowth; lower > upper where there are none.
  std::span<const float, 3> lower() const { return std::span<const float, 3>(view_.lower); }
  std::span<const float, 3> upper() const { return std::span<const float, 3>(view_.upper); }
  GeometryStatistics statistics() const;

  std::uint32_t object_count() const { return static_cast<std::uint32_t>(first_.size() - 1); }
  // The object that a primitive belongs to, and its first primitive. `primitive` < the number of
  // all primitives given.
  std::uint32_t object_of(std::uint32_t primitive) const;
  std::uint32_t first_primitive(std::uint32_t object) const { return first_[object]; }

 private:
  Geometry() = default;

  Tree<float> tree_;
  TreeView<float> view_;
  std::vector<std::uint32_t> first_;  // primitive of each object; the last is the number of all
  std::uint32_t never_hit_ = 0;
};

// How to trace: by default every hit in front of the origin counts, and coherence is measured.
struct TraceOptions {
  RayIntervals<float> intervals;
  Coherence coherence = Coherence::kUnknown;
  Target target{};  // what computes it; the bits are the same on all
};

// What TraceClosest fills, `count` elements each; fields that are null are left out.
struct HitArrays {
  float* t = nullptr;                  // t_max where the ray misses
  std::uint32_t* primitive = nullptr;  // kNoPrimitive where the ray misses
  std::uint32_t* object = nullptr;     // likewise
  float* u = nullptr;                  // see HitFields of simd/streams.h
  float* v = nullptr;
};

// The nearest hit of each of `count` rays, in any order and of any coherence; rays.source may be
// null. No array needs padding or alignment. Equal t: the lowest primitive. Rays with a component
// that is not finite, with no direction or with t_min > t_max miss. Safe to call from any number of
// threads.
void TraceClosest(const Geometry& geometry, const RayView<float>& rays, std::uint32_t count,
                  const HitArrays& hits, const TraceOptions& options = {});

// Writes 1 where a ray hits anything within its interval, else 0.
void TraceOccluded(const Geometry& geometry, const RayView<float>& rays, std::uint32_t count,
                   std::uint32_t* occluded, const TraceOptions& options = {});

}  // namespace sheaf

#endif  // SHEAF_BVH_GEOMETRY_H_
