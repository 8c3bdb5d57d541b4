#include "sheaf/geometry.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "simd/tree.h"
#include "src/bvh/build_tree.h"
#include "src/bvh/geometry_access.h"
#include "src/core/parallel.h"

namespace sheaf {

struct Geometry::Data {
  // The arrays are dropped: the tree holds all that rays need.
  Tree<float> tree;
  TreeView<float> view{};
  std::vector<std::uint32_t> first{0};  // see FlatInput
  std::uint32_t never_hit = 0;
};

std::uint32_t GeometryInput::AddTriangles(std::span<const float> vertices,
                                          std::span<const std::uint32_t> indices) {
  objects_.push_back({static_cast<std::uint32_t>(PrimitiveKind::kTriangle), vertices, indices});
  return static_cast<std::uint32_t>(objects_.size() - 1);
}

std::uint32_t GeometryInput::Add(std::uint32_t kind, std::span<const float> fields) {
  objects_.push_back({kind, fields, {}});
  return static_cast<std::uint32_t>(objects_.size() - 1);
}

Geometry::Geometry() = default;
Geometry::Geometry(Geometry&&) noexcept = default;
Geometry& Geometry::operator=(Geometry&&) noexcept = default;
Geometry::~Geometry() = default;

const Geometry::Data& Geometry::data() const {
  static const Data kEmpty = [] {
    Data empty;
    constexpr float kMax = std::numeric_limits<float>::max();
    std::fill_n(empty.tree.all_lower, 3, kMax);
    std::fill_n(empty.tree.all_upper, 3, -kMax);
    std::fill_n(empty.view.lower, 3, kMax);
    std::fill_n(empty.view.upper, 3, -kMax);
    empty.view.skips_boxes = true;
    return empty;
  }();
  return data_ ? *data_ : kEmpty;
}

Result<Geometry> Geometry::Build(const GeometryInput& input, int threads) {
  Result<FlatInput> flattened = GeometryAccess::Flatten(input, ThreadCount(threads));
  if (!flattened) return flattened.error();
  FlatInput& flat = flattened.value();
  Result<Tree<float>> tree = BuildTree(flat.arrays.view(), threads);
  if (!tree) return tree.error();
  auto data = std::make_unique<Data>();
  data->tree = std::move(tree).value();
  data->view = data->tree.view();
  data->first = std::move(flat.first);
  data->never_hit = flat.never_hit;
  Geometry geometry;
  geometry.data_ = std::move(data);
  return geometry;
}

std::array<float, 3> Geometry::lower() const { return std::to_array(data().tree.all_lower); }
std::array<float, 3> Geometry::upper() const { return std::to_array(data().tree.all_upper); }

GeometryStatistics Geometry::statistics() const {
  const TreeView<float>& tree = data().view;
  GeometryStatistics statistics{};
  statistics.primitives = tree.primitive_count();
  statistics.triangles = tree.of(PrimitiveKind::kTriangle).count;
  statistics.spheres = tree.of(PrimitiveKind::kSphere).count;
  statistics.never_hit = data().never_hit;
  statistics.nodes = tree.node_count;
  statistics.bytes = sizeof(*this) + sizeof(Data) + data().tree.bytes() +
                     data().first.capacity() * sizeof(data().first[0]);
  // Every node comes before its children.
  std::vector<std::uint8_t> level(tree.node_count, 1);
  for (std::uint32_t i = 0; i < tree.node_count; ++i) {
    statistics.depth = std::max<std::uint32_t>(statistics.depth, level[i]);
    for (const std::uint32_t child : tree.nodes[i].child) {
      if (!IsLeaf(child)) level[child] = static_cast<std::uint8_t>(level[i] + 1);
      statistics.leaves += IsLeaf(child) && child != kNoChild;
    }
  }
  return statistics;
}

std::uint32_t Geometry::object_count() const {
  return static_cast<std::uint32_t>(data().first.size() - 1);
}

std::uint32_t Geometry::object_of(std::uint32_t primitive) const {
  // An object without primitives begins where the next one does, and is passed over.
  const std::vector<std::uint32_t>& first = data().first;
  const auto after = std::upper_bound(first.begin(), first.end(), primitive);
  return static_cast<std::uint32_t>(after - first.begin() - 1);
}

std::uint32_t Geometry::first_primitive(std::uint32_t object) const { return data().first[object]; }

void GeometryAccess::Add(GeometryInput& input, PrimitiveKind kind, std::span<const float> fields) {
  input.Add(static_cast<std::uint32_t>(kind), fields);
}

const TreeView<float>& GeometryAccess::TreeOf(const Geometry& geometry) {
  return geometry.data().view;
}

}  // namespace sheaf
