// Primitives of all kinds as flat arrays, and the tree over them: what a geometry owns.
#ifndef SHEAF_BVH_GEOMETRY_DATA_H_
#define SHEAF_BVH_GEOMETRY_DATA_H_

#include <cstddef>
#include <cstdint>

#include "sheaf/error.h"
#include "simd/primitives.h"
#include "src/bvh/primitive_rules.h"
#include "src/bvh/tree.h"
#include "src/core/aligned_array.h"

namespace sheaf {

// What the vertices of triangles may have besides their positions.
struct VertexAttributes {
  bool has_coordinates = false, has_normals = false, has_colours = false, has_alphas = false,
       has_second_set = false;
};

// The arrays behind a GeometryView. They are filled primitive by primitive, each of them once, in
// any order and on any number of threads.
template <typename Real>
class GeometryArrays {
 public:
  GeometryArrays() = default;
  explicit GeometryArrays(const PrimitiveCounts& counts, const VertexAttributes& attributes = {});

  // Primitive `index` of a kind, with the fields of its arrays in the order of ForEachField.
  // Returns whether a ray can hit it: what none can is marked by a NaN.
  template <PrimitiveKind kKind>
  bool Put(std::uint32_t index, std::uint32_t id, Real* fields) {
    const bool is_hittable = bvh::MarkUnlessHittable<kKind>(fields);
    Kind& kind = kinds_[IndexOf(kKind)];
    for (std::size_t k = 0; k < FieldCountOf(kKind); ++k) kind.fields[k][index] = fields[k];
    kind.id[index] = id;
    return is_hittable;
  }

  std::uint32_t count(PrimitiveKind kind) const { return counts_[kind]; }
  // The field of all primitives of a kind, by its place in ForEachField.
  Real* field(PrimitiveKind kind, std::size_t k) { return kinds_[IndexOf(kind)].fields[k].data(); }
  std::uint32_t* ids(PrimitiveKind kind) { return kinds_[IndexOf(kind)].id.data(); }
  GeometryView<Real> view() const;
  // Of primitives [first, end) of each kind alone: what a tree is built over.
  GeometryView<Real> view(const PrimitiveCounts& first, const PrimitiveCounts& end) const;

  // Of triangles; empty where unused.
  AlignedArray<Real> uv[3][2], uv2[3][2], normal[3][3], colour[3][3], alpha[3][1];

 private:
  struct Kind {
    AlignedArray<Real> fields[kMaxFields];
    AlignedArray<std::uint32_t> id;
  };
  PrimitiveCounts counts_;
  Kind kinds_[kKindCount];
};

template <typename Real>
struct GeometryData {
  GeometryArrays<Real> arrays;
  Tree<Real> tree;

  // So many primitives of each kind, the first ones, are the tree's; the others are for instances.
  PrimitiveCounts own;

  // Over what the arrays hold, which the tree does not need any more. See BuildTree.
  Status BuildTree(int threads);
};

}  // namespace sheaf

#endif  // SHEAF_BVH_GEOMETRY_DATA_H_
