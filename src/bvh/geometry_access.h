// The inside of a public Geometry, for those that need it: its tree and its arrays.
#ifndef SHEAF_BVH_GEOMETRY_ACCESS_H_
#define SHEAF_BVH_GEOMETRY_ACCESS_H_

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "sheaf/error.h"
#include "sheaf/geometry.h"
#include "simd/query.h"
#include "simd/streams.h"
#include "simd/tree.h"
#include "src/bvh/geometry_data.h"
#include "src/bvh/geometry_scale.h"
#include "src/bvh/primitive_index.h"

namespace sheaf {

// The objects of a GeometryInput as flat arrays, in the user's numbers.
template <typename Real>
struct FlatInputOf {
  GeometryArrays<Real> arrays;
  std::vector<std::uint32_t> first;           // primitive of each object; the last: number of all
  std::vector<std::uint32_t> first_triangle;  // of each object, among triangles
  std::vector<PrimitiveKind> kind;            // of each object
  std::uint32_t never_hit = 0, skipped = 0;
  TriangleSizes sizes;
};
using FlatInput = FlatInputOf<float>;

// What a Geometry owns. The arrays are dropped, but for normals: the tree holds all that rays need.
// Where the geometry is mapped, view and normals show the file, and the arrays are empty.
template <typename Real>
struct GeometryOf<Real>::Data {
  Tree<Real> tree;  // of coordinates times scale
  TreeView<Real> view{};
  Real scale = 1;                                // a power of two
  std::vector<std::uint32_t> first{0};           // see FlatInputOf
  std::vector<std::uint32_t> first_triangle{0};  // likewise
  std::vector<PrimitiveKind> kind;               // likewise
  std::uint32_t never_hit = 0, skipped = 0;
  AlignedArray<Real> normal[3][3];   // by triangle; empty where no mesh has any
  const Real* normals[9] = {};       // the same by vertex and axis; null where no mesh has any
  PrimitiveIndex<Real> index;        // made at its first use
  double built_cost = -1;            // CostOfTree right after the build; below 0: not known yet
  std::shared_ptr<const void> file;  // the mapping that is shown
  std::size_t file_bytes = 0;        // of it

  // Takes all that is in `flat` but what the tree was built from, which it must be of.
  void Take(FlatInputOf<Real>& flat);
};

// Multiplies all lengths by the power of two that triangles are hit at, which it returns; marks and
// counts what no ray can hit there.
template <typename Real>
Real Rescale(FlatInputOf<Real>& flat);

struct GeometryAccess {
  // The data of a geometry of this input, which Rescale has scaled; consumes it. Fails as BuildTree
  // does.
  template <typename Real>
  static Result<std::unique_ptr<typename GeometryOf<Real>::Data>> BuildData(FlatInputOf<Real>& flat,
                                                                            Real scale,
                                                                            int threads);

  // Primitives of any kind but triangles, whose numbers are vertices and indices.
  static void Add(GeometryInput& input, PrimitiveKind kind, std::span<const float> fields);

  // Fails as Geometry::Build does.
  template <typename Real>
  static Result<FlatInputOf<Real>> FlattenTo(const GeometryInput& input,
                                             const BuildOptions& options);
  static Result<FlatInput> Flatten(const GeometryInput& input, int threads) {
    return FlattenTo<float>(input, {.threads = threads});
  }

  // A class of its own: clang 14 looks at an alias's access from where it is used.
  template <typename Real>
  struct DataType {
    using Type = typename GeometryOf<Real>::Data;
  };
  template <typename Real>
  using Data = typename DataType<Real>::Type;
  template <typename Real>
  static const Data<Real>& DataOf(const GeometryOf<Real>& geometry) {
    return geometry.data();
  }
  // In the numbers that rays are traced in: the user's times ScaleOf.
  template <typename Real>
  static const TreeView<Real>& TreeOf(const GeometryOf<Real>& geometry) {
    return geometry.data().view;
  }
  template <typename Real>
  static Real ScaleOf(const GeometryOf<Real>& geometry) {
    return geometry.data().scale;
  }
};

// The same pointers in the kernels' terms, and back.
RayArrays ArraysOf(const RayView<float>& rays);
TraceInterval IntervalOf(const RayIntervals<float>& intervals);

static_assert(static_cast<std::uint32_t>(PrimitiveKind::kSphere) == 1);  // as in GeometryInput
static_assert(Geometry::kNoPrimitive == kNoPrimitive && Geometry::kInsideBit == kInsideBit);

}  // namespace sheaf

#endif  // SHEAF_BVH_GEOMETRY_ACCESS_H_
