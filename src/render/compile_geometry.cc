#include "src/render/compile_geometry.h"

#include <array>
#include <glm/common.hpp>
#include <glm/ext/vector_float1.hpp>
#include <map>
#include <optional>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "src/bvh/build_tree.h"
#include "src/render/round_corners.h"
#include "src/scene/affine_map.h"
#include "src/scene/placed_groups.h"
#include "src/scene/shapes.h"
#include "src/scene/textures.h"

namespace sheaf {
namespace {

// Which attributes of vertices some material or mesh asks for.
VertexAttributes AttributesOf(const Scene& scene) {
  VertexAttributes attributes;
  bool asks_for_second_set = false;
  for (const Material& material : scene.materials) {
    attributes.has_coordinates |= std::holds_alternative<Checker>(material.base_colour);
    ForEachTexture(material, [&](const char* /*name*/, const Texture& texture) {
      attributes.has_coordinates = true;
      asks_for_second_set |= texture.set == 1;
    });
  }
  ForEachObject(scene, [&](const Object& object) {
    const auto* mesh = std::get_if<Mesh>(&object.shape);
    if (mesh == nullptr) return;
    attributes.has_normals |= !mesh->normals.empty();
    attributes.has_colours |= !mesh->colours.empty();
    attributes.has_second_set |= asks_for_second_set && !mesh->uv2.empty();
    attributes.has_alphas |= ShowsAlphas(*mesh, scene.materials[object.material]);
  });
  return attributes;
}

// Adds the primitives of objects, in their order.
template <typename Real>
class GeometryWriter {
 public:
  GeometryWriter(const Scene& scene, const ScenePlacement& placement, CompiledGeometry<Real>& to)
      : placement_(&placement), attributes_(AttributesOf(scene)), to_(to), arrays_(to.data.arrays) {
    const PrimitiveCounts counts = Narrow(CountPrimitives(scene));
    arrays_ = GeometryArrays<Real>(counts, attributes_);
    to_.primitives.reserve(counts.total());
    to_.object_of_primitive.reserve(counts.total());
    // In doubles corners stay what they are.
    if constexpr (std::is_same_v<Real, float>) rounded_ = RoundCorners(scene, placement);
    to_.has_rounded_corners = !rounded_.empty();
  }

  void Add(std::uint32_t index, const Object& object) {
    object_ = index;
    material_ = object.material;
    if (const auto* mesh = std::get_if<Mesh>(&object.shape)) return AddMesh(*mesh);
    if (const auto rounded = rounded_.find(index); rounded != rounded_.end()) {
      for (const ShapePrimitive& primitive : rounded->second) AddPlain(primitive);
    } else {
      ForEachPrimitive(object.shape,
                       [&](const ShapePrimitive& primitive) { AddPlain(Placed(primitive)); });
    }
    ForEachExtreme(object.shape, [&](const Vec3d& point) { Include(placement_->Point(point)); });
  }

  // What comes next is placed like this.
  void PlaceBy(const ScenePlacement& placement) { placement_ = &placement; }

  void Include(const Vec3d& point) {
    bounds_.low = glm::min(bounds_.low, point);
    bounds_.high = glm::max(bounds_.high, point);
  }

  const PointBounds& bounds() const { return bounds_; }
  // How many primitives there are by now.
  const PrimitiveCounts& counts() const { return next_; }

 private:
  // A primitive that is no mesh's, where it is placed.
  void AddPlain(const ShapePrimitive& primitive) {
    const std::uint32_t i = Put(primitive.kind, primitive.fields);
    if (primitive.kind != PrimitiveKind::kTriangle) return;
    for (int vertex = 0; vertex < 3; ++vertex) {
      if (attributes_.has_coordinates) Store(arrays_.uv, vertex, i, primitive.uv[vertex]);
      if (attributes_.has_second_set) Store(arrays_.uv2, vertex, i, primitive.uv[vertex]);
      if (attributes_.has_normals) Store(arrays_.normal, vertex, i, glm::vec3(0));
      if (attributes_.has_colours) Store(arrays_.colour, vertex, i, glm::vec3(1));
      if (attributes_.has_alphas) Store(arrays_.alpha, vertex, i, glm::vec1(1));
    }
  }

  void AddMesh(const Mesh& mesh) {
    for (const auto& corners : mesh.triangles) {
      std::array<double, kMaxFields> vertices;
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3d vertex = placement_->Point(Vec3d(mesh.positions[corners[k]]));
        Include(vertex);
        for (int axis = 0; axis < 3; ++axis) vertices[3 * k + axis] = vertex[axis];
      }
      const std::uint32_t i = Put(PrimitiveKind::kTriangle, vertices);
      for (int vertex = 0; vertex < 3; ++vertex) {
        const std::uint32_t from = corners[static_cast<std::size_t>(vertex)];
        const glm::dvec2 uv = mesh.uv.empty() ? Triangle{}.uv[static_cast<std::size_t>(vertex)]
                                              : glm::dvec2(mesh.uv[from]);
        if (attributes_.has_coordinates) Store(arrays_.uv, vertex, i, uv);
        if (attributes_.has_second_set) {
          Store(arrays_.uv2, vertex, i, mesh.uv2.empty() ? uv : glm::dvec2(mesh.uv2[from]));
        }
        if (attributes_.has_normals) {
          Store(arrays_.normal, vertex, i,
                mesh.normals.empty() ? glm::vec3(0) : mesh.normals[from]);
        }
        if (attributes_.has_colours) {
          Store(arrays_.colour, vertex, i,
                mesh.colours.empty() ? glm::vec3(1) : mesh.colours[from]);
        }
        if (attributes_.has_alphas) {
          Store(arrays_.alpha, vertex, i, glm::vec1(mesh.alphas.empty() ? 1 : mesh.alphas[from]));
        }
      }
    }
  }

  // The primitive where it is computed: its points, and its radius if it has one.
  ShapePrimitive Placed(ShapePrimitive primitive) const {
    std::array<double, kMaxFields>& fields = primitive.fields;
    const bool is_triangle = primitive.kind == PrimitiveKind::kTriangle;
    for (std::size_t at = 0; at < (is_triangle ? 9 : 3); at += 3) {
      const Vec3d point = placement_->Point({fields[at], fields[at + 1], fields[at + 2]});
      for (int axis = 0; axis < 3; ++axis) fields[at + axis] = point[axis];
    }
    if (!is_triangle) fields[3] = placement_->Length(fields[3]);
    return primitive;
  }

  // Returns the index among its kind.
  std::uint32_t Put(PrimitiveKind kind, const std::array<double, kMaxFields>& exact) {
    std::array<Real, kMaxFields> fields;
    for (std::size_t k = 0; k < kMaxFields; ++k) fields[k] = static_cast<Real>(exact[k]);
    const std::uint32_t index = next_[kind]++;
    const auto id = static_cast<std::uint32_t>(to_.primitives.size());
    WithKind<Real>(kind, [&](auto arrays) {
      arrays_.template Put<decltype(arrays)::kKind>(index, id, fields.data());
    });
    to_.primitives.push_back({MakePlace(kind, index), material_});
    to_.object_of_primitive.push_back(object_);
    return index;
  }

  template <std::size_t N, typename Value>
  static void Store(AlignedArray<Real> (&values)[3][N], int vertex, std::uint32_t i,
                    const Value& value) {
    for (int axis = 0; axis < static_cast<int>(N); ++axis) {
      values[vertex][axis][i] = static_cast<Real>(value[axis]);
    }
  }

  const ScenePlacement* placement_;
  std::map<std::uint32_t, std::vector<ShapePrimitive>> rounded_;
  VertexAttributes attributes_;
  CompiledGeometry<Real>& to_;
  GeometryArrays<Real>& arrays_;
  PointBounds bounds_;
  PrimitiveCounts next_;
  std::uint32_t object_ = 0, material_ = 0;
};

// From where a group is computed to where it stands, as the scene is computed.
AffineMap PlacedMap(const ScenePlacement& scene, const PlacedGroup& placed,
                    const ScenePlacement& group) {
  const Transform& to_world = placed.to_world;
  return MapOf(
      {to_world.linear * (scene.scale / group.scale), scene.Point(to_world.Point(group.origin))});
}

}  // namespace

template <typename Real>
PointBounds CompileGeometry(const Scene& scene, const ScenePlacement& placement,
                            CompiledGeometry<Real>& to) {
  GeometryWriter<Real> writer(scene, placement, to);
  for (std::uint32_t i = 0; i < scene.objects.size(); ++i) writer.Add(i, scene.objects[i]);
  to.data.own = writer.counts();
  PointBounds bounds = writer.bounds();
  if (scene.groups.empty()) return bounds;
  auto number = static_cast<std::uint32_t>(scene.objects.size());
  std::vector<std::optional<Bounds>> boxes;
  std::vector<ScenePlacement> group_placements;
  group_placements.reserve(scene.groups.size());
  for (const Group& group : scene.groups) {
    const auto& box = boxes.emplace_back(BoundsOf(group.objects));
    writer.PlaceBy(group_placements.emplace_back(box ? PlaceGroup(*box) : ScenePlacement()));
    for (const Object& object : group.objects) writer.Add(number++, object);
    to.group_ends.push_back(writer.counts());
  }
  for (const PlacedGroup& placed : PlaceGroups(scene)) {
    to.places.push_back(
        {PlacedMap(placement, placed, group_placements[placed.group]), placed.group});
    to.to_world.push_back(to.places.back().to_world);
    if (!boxes[placed.group]) continue;
    const Bounds box = Mapped(placed.to_world, *boxes[placed.group]);
    bounds.low = glm::min(bounds.low, placement.Point(box.min));
    bounds.high = glm::max(bounds.high, placement.Point(box.max));
  }
  return bounds;
}

template <typename Real>
Status CompiledGeometry<Real>::BuildTrees(int threads) {
  if (Status built = data.BuildTree(threads); !built) return built;
  std::vector<TreeView<Real>> views;
  PrimitiveCounts first = data.own;
  group_trees.reserve(group_ends.size());
  for (const PrimitiveCounts& end : group_ends) {
    Result<Tree<Real>> built = BuildTree(data.arrays.view(first, end), threads);
    if (!built) return built.error();
    views.push_back(group_trees.emplace_back(std::move(built).value()).view());
    first = end;
  }
  if (!places.empty()) forest = BuildInstances<Real>(places, std::move(views), threads);
  places = {};
  return Done{};
}

template struct CompiledGeometry<float>;
template struct CompiledGeometry<double>;

template PointBounds CompileGeometry(const Scene&, const ScenePlacement&, CompiledGeometry<float>&);
template PointBounds CompileGeometry(const Scene&, const ScenePlacement&,
                                     CompiledGeometry<double>&);

}  // namespace sheaf
