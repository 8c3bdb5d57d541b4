#include "sheaf/geometry.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "simd/tree.h"
#include "src/bvh/build_tree.h"
#include "src/bvh/geometry_access.h"
#include "src/bvh/primitive_rules.h"

namespace sheaf {
namespace {

// Multiplies the lengths of a kind; marks and counts what no ray can hit at that scale.
template <typename Real, typename Arrays>
void RescaleKind(const Arrays& arrays, int exponent, FlatInputOf<Real>& flat) {
  using Rules = bvh::Rules<Arrays::kKind>;
  const auto scale = static_cast<Real>(std::ldexp(1.0, exponent));
  for (std::uint32_t i = 0; i < arrays.count; ++i) {
    Real fields[kMaxFields];
    for (int k = 0; k < Rules::kLengths; ++k) fields[k] = flat.arrays.field(arrays.kKind, k)[i];
    if (std::isnan(fields[Rules::kMarkedField])) continue;
    bool is_lost = false;
    if constexpr (Arrays::kKind == PrimitiveKind::kTriangle) {
      double exact[3][3];
      Rules::Widen(fields, exact);
      is_lost = HasNoAreaAt<Real>(LargestArea(exact), exponent);
    } else {
      is_lost = !(fields[Rules::kMarkedField] * scale >= std::numeric_limits<Real>::min());
    }
    for (int k = 0; k < Rules::kLengths; ++k) fields[k] *= scale;
    if (is_lost) bvh::MarkNeverHit<Arrays::kKind>(fields);
    flat.never_hit += is_lost;
    for (int k = 0; k < Rules::kLengths; ++k) flat.arrays.field(arrays.kKind, k)[i] = fields[k];
  }
}

// A bound of the tree in the user's numbers.
template <typename Real>
std::array<float, 3> Unscaled(const float (&bound)[3], const TreeView<Real>& tree, Real scale) {
  std::array<float, 3> result;
  constexpr double kMax = std::numeric_limits<float>::max();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double x = static_cast<double>(bound[axis]) / static_cast<double>(scale);
    result[axis] =
        tree.node_count == 0 ? bound[axis] : static_cast<float>(std::clamp(x, -kMax, kMax));
  }
  return result;
}

}  // namespace

template <typename Real>
Real Rescale(FlatInputOf<Real>& flat) {
  const int exponent = ScaleExponent<Real>(flat.sizes);
  if (exponent == 0 && !HasNoAreaAt<Real>(flat.sizes.least_area, 0)) return 1;
  const GeometryView<Real> view = flat.arrays.view();
  ForEachKind(view, [&](const auto& arrays) { RescaleKind<Real>(arrays, exponent, flat); });
  return static_cast<Real>(std::ldexp(1.0, exponent));
}
template float Rescale(FlatInputOf<float>&);
template double Rescale(FlatInputOf<double>&);

std::uint32_t GeometryInput::Add(std::uint32_t kind, Numbers numbers,
                                 std::span<const std::uint32_t> indices, Numbers normals) {
  objects_.push_back({kind, numbers, indices, normals});
  return static_cast<std::uint32_t>(objects_.size() - 1);
}

template <typename Real>
GeometryOf<Real>::GeometryOf() = default;
template <typename Real>
GeometryOf<Real>::GeometryOf(GeometryOf&&) noexcept = default;
template <typename Real>
GeometryOf<Real>& GeometryOf<Real>::operator=(GeometryOf&&) noexcept = default;
template <typename Real>
GeometryOf<Real>::~GeometryOf() = default;

template <typename Real>
const typename GeometryOf<Real>::Data& GeometryOf<Real>::data() const {
  struct Empty : Data {
    Empty() {
      constexpr float kMax = std::numeric_limits<float>::max();
      std::fill_n(this->tree.all_lower, 3, kMax);
      std::fill_n(this->tree.all_upper, 3, -kMax);
      std::fill_n(this->view.lower, 3, kMax);
      std::fill_n(this->view.upper, 3, -kMax);
      this->view.skips_boxes = true;
    }
  };
  static const Empty kEmpty;
  if (data_) return *data_;
  return kEmpty;
}

template <typename Real>
void GeometryOf<Real>::Data::Take(FlatInputOf<Real>& flat) {
  first = std::move(flat.first);
  first_triangle = std::move(flat.first_triangle);
  kind = std::move(flat.kind);
  never_hit = flat.never_hit;
  skipped = flat.skipped;
  for (std::size_t k = 0; k < 9; ++k) {
    normal[k / 3][k % 3] = std::move(flat.arrays.normal[k / 3][k % 3]);
    normals[k] = normal[k / 3][k % 3].data();
  }
}

template <typename Real>
Result<std::unique_ptr<typename GeometryOf<Real>::Data>> GeometryAccess::BuildData(
    FlatInputOf<Real>& flat, Real scale, int threads) {
  auto data = std::make_unique<typename GeometryOf<Real>::Data>();
  data->scale = scale;
  Result<Tree<Real>> tree = BuildTree(flat.arrays.view(), threads);
  if (!tree) return tree.error();
  data->tree = std::move(tree).value();
  data->view = data->tree.view();
  data->Take(flat);
  return data;
}

template <typename Real>
Result<GeometryOf<Real>> GeometryOf<Real>::Build(const GeometryInput& input,
                                                 const BuildOptions& options) {
  Result<FlatInputOf<Real>> flattened = GeometryAccess::FlattenTo<Real>(input, options);
  if (!flattened) return flattened.error();
  FlatInputOf<Real>& flat = flattened.value();
  auto data = GeometryAccess::BuildData(flat, Rescale(flat), options.threads);
  if (!data) return data.error();
  GeometryOf geometry;
  geometry.data_ = std::move(data).value();
  return geometry;
}

template <typename Real>
std::array<float, 3> GeometryOf<Real>::lower() const {
  return Unscaled(data().tree.all_lower, data().view, data().scale);
}
template <typename Real>
std::array<float, 3> GeometryOf<Real>::upper() const {
  return Unscaled(data().tree.all_upper, data().view, data().scale);
}

template <typename Real>
GeometryStatistics GeometryOf<Real>::statistics() const {
  const TreeView<Real>& tree = data().view;
  GeometryStatistics statistics{};
  statistics.primitives = tree.primitive_count();
  statistics.triangles = tree.of(PrimitiveKind::kTriangle).count;
  statistics.spheres = tree.of(PrimitiveKind::kSphere).count;
  statistics.disks = tree.of(PrimitiveKind::kDisk).count;
  statistics.never_hit = data().never_hit;
  statistics.skipped = data().skipped;
  statistics.nodes = tree.node_count;
  statistics.bytes = sizeof(*this) + sizeof(Data) + data().tree.bytes() +
                     9 * data().normal[0][0].size() * sizeof(Real) +
                     3 * data().first.capacity() * sizeof(data().first[0]) + data().file_bytes;
  statistics.depth = DepthOf(tree.nodes, tree.node_count);
  for (std::uint32_t i = 0; i < tree.node_count; ++i) {
    for (const std::uint32_t child : tree.nodes[i].child) {
      statistics.leaves += IsLeaf(child) && child != kNoChild;
    }
  }
  return statistics;
}

template <typename Real>
std::uint32_t GeometryOf<Real>::object_count() const {
  return static_cast<std::uint32_t>(data().first.size() - 1);
}

template <typename Real>
std::uint32_t GeometryOf<Real>::object_of(std::uint32_t primitive) const {
  // An object without primitives begins where the next one does, and is passed over.
  const std::vector<std::uint32_t>& first = data().first;
  const auto after = std::upper_bound(first.begin(), first.end(), primitive);
  return static_cast<std::uint32_t>(after - first.begin() - 1);
}

template <typename Real>
std::uint32_t GeometryOf<Real>::first_primitive(std::uint32_t object) const {
  return data().first[object];
}

template Result<std::unique_ptr<GeometryOf<float>::Data>> GeometryAccess::BuildData(
    FlatInputOf<float>&, float, int);
template Result<std::unique_ptr<GeometryOf<double>::Data>> GeometryAccess::BuildData(
    FlatInputOf<double>&, double, int);
template class GeometryOf<float>;
template class GeometryOf<double>;

void GeometryAccess::Add(GeometryInput& input, PrimitiveKind kind, std::span<const float> fields) {
  input.Add(static_cast<std::uint32_t>(kind), GeometryInput::Numbers(fields));
}

}  // namespace sheaf
