#include "src/bvh/geometry_data.h"

#include <utility>

#include "simd/streams.h"
#include "src/bvh/build_tree.h"

namespace sheaf {
namespace {

template <typename T>
void Reserve(AlignedArray<T>& array, std::uint32_t count) {
  array.AllocateForOverwrite(StreamCapacity(count), StreamCapacity(count) - count);
}

template <typename Real, std::size_t N>
void ReserveVertices(AlignedArray<Real> (&values)[3][N], std::uint32_t count) {
  for (auto& vertex : values) {
    for (auto& axis : vertex) Reserve(axis, count);
  }
}

template <typename Real, std::size_t N>
void ShowVertices(const AlignedArray<Real> (&values)[3][N], const Real* (&view)[3][N]) {
  for (int vertex = 0; vertex < 3; ++vertex) {
    for (std::size_t axis = 0; axis < N; ++axis) view[vertex][axis] = values[vertex][axis].data();
  }
}

}  // namespace

template <typename Real>
GeometryArrays<Real>::GeometryArrays(const PrimitiveCounts& counts,
                                     const VertexAttributes& attributes)
    : counts_(counts) {
  for (std::uint32_t k = 0; k < kKindCount; ++k) {
    const std::uint32_t fields = FieldCountOf(static_cast<PrimitiveKind>(k));
    for (std::uint32_t i = 0; i < fields; ++i) Reserve(kinds_[k].fields[i], counts.of[k]);
    Reserve(kinds_[k].id, counts.of[k]);
  }
  const std::uint32_t triangles = counts[PrimitiveKind::kTriangle];
  if (attributes.has_coordinates) ReserveVertices(uv, triangles);
  if (attributes.has_second_set) ReserveVertices(uv2, triangles);
  if (attributes.has_normals) ReserveVertices(normal, triangles);
  if (attributes.has_colours) ReserveVertices(colour, triangles);
  if (attributes.has_alphas) ReserveVertices(alpha, triangles);
}

template <typename Real>
GeometryView<Real> GeometryArrays<Real>::view() const {
  GeometryView<Real> view{};
  ForEachKind(view, [&](auto& arrays) {
    const Kind& kind = kinds_[IndexOf(arrays.kKind)];
    std::size_t k = 0;
    arrays.ForEachField(arrays, [&](const Real*& field) { field = kind.fields[k++].data(); });
    arrays.id = kind.id.data();
    arrays.count = counts_[arrays.kKind];
  });
  ShowVertices(uv, view.triangles.uv);
  ShowVertices(uv2, view.triangles.uv2);
  ShowVertices(normal, view.triangles.normal);
  ShowVertices(colour, view.triangles.colour);
  ShowVertices(alpha, view.triangles.alpha);
  return view;
}

template <typename Real>
GeometryView<Real> GeometryArrays<Real>::view(const PrimitiveCounts& first,
                                              const PrimitiveCounts& end) const {
  GeometryView<Real> view = this->view();
  ForEachKind(view, [&](auto& arrays) {
    const std::uint32_t begin = first[arrays.kKind];
    arrays.ForEachField(arrays, [&](const Real*& field) { field += begin; });
    arrays.id += begin;
    arrays.count = end[arrays.kKind] - begin;
  });
  return view;
}

template <typename Real>
Status GeometryData<Real>::BuildTree(int threads) {
  Result<Tree<Real>> built = sheaf::BuildTree(arrays.view({}, own), threads);
  if (!built) return built.error();
  tree = std::move(built).value();
  return Done{};
}

template class GeometryArrays<float>;
template class GeometryArrays<double>;
template struct GeometryData<float>;
template struct GeometryData<double>;

}  // namespace sheaf
