// Nearest points, and what meets balls and boxes, for the library's users.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "sheaf/queries.h"
#include "simd/tree.h"
#include "src/bvh/check_arrays.h"
#include "src/bvh/check_points.h"
#include "src/bvh/geometry_access.h"
#include "src/bvh/list_hits.h"
#include "src/bvh/ray_batches.h"
#include "src/bvh/ray_block.h"
#include "src/bvh/walk_boxes.h"
#include "src/scalar/nearest.h"
#include "src/scalar/overlap.h"

namespace sheaf {
namespace {

using scalar::Wide3;

// Element `i` of an array with a stride.
template <typename Real>
Real At(const Real* array, std::size_t stride, std::size_t i) {
  Real value;
  Gather(array, stride, i, 1, &value);
  return value;
}

// The point at the geometry's scale.
template <typename Real>
Wide3 PlaceAt(const PointArraysOf<Real>& points, std::size_t i, Real scale) {
  return Vec3<Real>{At(points.x, points.stride, i), At(points.y, points.stride, i),
                    At(points.z, points.stride, i)}
             .template To<double>() *
         static_cast<double>(scale);
}

bool IsFinite(Wide3 place) {
  return std::isfinite(place.x) && std::isfinite(place.y) && std::isfinite(place.z);
}

// Calls f(arrays, k) for the primitives of a leaf.
template <typename Real, typename F>
void ForEachInLeaf(const TreeView<Real>& tree, std::uint32_t leaf, F f) {
  WithKind<Real>(LeafKind(leaf), [&](auto arrays) {
    ShowLeaf(tree, leaf, arrays);
    for (std::uint32_t k = 0; k < arrays.count; ++k) f(arrays, k);
  });
}

template <typename Real>
scalar::NearestPrimitive Nearest(const TreeView<Real>& tree, Wide3 place, double max_square,
                                 const HitRuleView& rules, std::uint32_t i) {
  scalar::NearestPrimitive nearest{max_square};
  WalkNearest(
      tree.nodes, tree.node_count, place, [&] { return nearest.square; },
      [&](std::uint32_t leaf) {
        ForEachInLeaf(tree, leaf, [&](const auto& arrays, std::uint32_t k) {
          if (!rules.Admits(i, arrays.id[k])) return;
          nearest.Take(scalar::NearestOf(place, arrays, k), arrays.id[k]);
        });
      });
  return nearest;
}

template <typename T>
void PutAt(T* array, std::size_t i, T value) {
  if (array) array[i] = value;
}

// The primitives that one region meets.
class RegionList {
 public:
  explicit RegionList(const OverlapLists& lists) : lists_(lists) {}

  void Add(std::uint32_t id) { ids_.push_back(id); }
  void Write(std::size_t i) {
    std::sort(ids_.begin(), ids_.end());
    const std::size_t listed = std::min<std::size_t>(ids_.size(), lists_.capacity);
    if (lists_.primitive) std::copy_n(ids_.begin(), listed, lists_.primitive + i * lists_.capacity);
    PutAt(lists_.listed, i, static_cast<std::uint32_t>(listed));
    PutAt(lists_.total, i, static_cast<std::uint32_t>(ids_.size()));
    ids_.clear();
  }

 private:
  const OverlapLists& lists_;
  std::vector<std::uint32_t> ids_;
};

}  // namespace

template <typename Real>
Status FindNearest(const GeometryOf<Real>& geometry, const PointArraysOf<Real>& points,
                   std::size_t count, const NearestArraysOf<Real>& nearest,
                   const NearestOptionsOf<Real>& options) {
  if (Status checked = CheckPoints(points, count); !checked) return checked;
  if (Status checked = CheckRules(options.rules, count); !checked) return checked;
  const TreeView<Real>& tree = GeometryAccess::TreeOf(geometry);
  const Real scale = GeometryAccess::ScaleOf(geometry);
  const auto wide_scale = static_cast<double>(scale);
  std::uint32_t inside[kListBlock] = {};
  ForEachBatch(count, kListBlock, [&](std::size_t first, std::uint32_t n) {
    const HitRuleView rules = RuleViewOf(geometry, options.rules, first);
    if (options.sign == DistanceSign::kInside) {
      HitRules of_block = options.rules;
      if (of_block.ray_mask) of_block.ray_mask += first;
      if (of_block.excluded) of_block.excluded += first * of_block.excluded_per_ray;
      FindInside(geometry, SkipPoints(points, first), n, inside, of_block).value();
    }
    for (std::uint32_t k = 0; k < n; ++k) {
      const std::size_t i = first + k;
      const Wide3 place = PlaceAt(points, i, scale);
      const Real most = options.max_distance ? options.max_distance[i] : options.all_max_distance;
      const double reach = static_cast<double>(most) * wide_scale;
      scalar::NearestPrimitive found{0};
      if (IsFinite(place) && reach >= 0) found = Nearest(tree, place, reach * reach, rules, k);
      const bool is_found = found.primitive != kNoPrimitive;
      const Wide3 position = (place + found.offset) / wide_scale;
      const Real distance =
          is_found ? static_cast<Real>(std::sqrt(found.square) / wide_scale) : most;
      PutAt(nearest.distance, i, inside[k] != 0 && is_found ? -distance : distance);
      PutAt(nearest.primitive, i, found.primitive);
      if (nearest.object) {
        nearest.object[i] = is_found ? geometry.object_of(found.primitive) : kNoPrimitive;
      }
      for (int axis = 0; axis < 3; ++axis) {
        PutAt(nearest.position[static_cast<std::size_t>(axis)], i,
              is_found ? static_cast<Real>(position[axis]) : Real(0));
      }
    }
  });
  return Done{};
}

template <typename Real>
Status FindInBoxes(const GeometryOf<Real>& geometry, const BoxArraysOf<Real>& boxes,
                   std::size_t count, const OverlapLists& lists) {
  for (std::size_t axis = 0; axis < 3 && count > 0; ++axis) {
    if (!boxes.lower[axis]) return NullArray("lower");
    if (!boxes.upper[axis]) return NullArray("upper");
  }
  const TreeView<Real>& tree = GeometryAccess::TreeOf(geometry);
  const Real scale = GeometryAccess::ScaleOf(geometry);
  RegionList list(lists);
  for (std::size_t i = 0; i < count; ++i) {
    const auto corner = [&](const std::array<const Real*, 3>& of) {
      return PlaceAt(PointArraysOf<Real>{of[0], of[1], of[2], boxes.stride}, i, scale);
    };
    const scalar::Box box = {corner(boxes.lower), corner(boxes.upper)};
    if (!box.is_empty()) {
      WalkOverlapping(tree.nodes, tree.node_count, box.lower, box.upper, [&](std::uint32_t leaf) {
        ForEachInLeaf(tree, leaf, [&](const auto& arrays, std::uint32_t k) {
          if (scalar::MeetsBox(box, arrays, k)) list.Add(arrays.id[k]);
        });
      });
    }
    list.Write(i);
  }
  return Done{};
}

template <typename Real>
Status FindInBalls(const GeometryOf<Real>& geometry, const PointArraysOf<Real>& points,
                   const Real* radius, std::size_t count, const OverlapLists& lists) {
  if (Status checked = CheckPoints(points, count); !checked) return checked;
  if (count > 0 && !radius) return NullArray("radius");
  const TreeView<Real>& tree = GeometryAccess::TreeOf(geometry);
  const Real scale = GeometryAccess::ScaleOf(geometry);
  RegionList list(lists);
  for (std::size_t i = 0; i < count; ++i) {
    const Wide3 place = PlaceAt(points, i, scale);
    const double reach = static_cast<double>(At(radius, points.stride, i) * scale);
    if (IsFinite(place) && reach >= 0) {
      const double square = reach * reach;
      WalkNearest(
          tree.nodes, tree.node_count, place, [&] { return square; },
          [&](std::uint32_t leaf) {
            ForEachInLeaf(tree, leaf, [&](const auto& arrays, std::uint32_t k) {
              if (scalar::NearestOf(place, arrays, k).square <= square) list.Add(arrays.id[k]);
            });
          });
    }
    list.Write(i);
  }
  return Done{};
}

#define SHEAF_INSTANTIATE(Real)                                                                 \
  template Status FindNearest(const GeometryOf<Real>&, const PointArraysOf<Real>&, std::size_t, \
                              const NearestArraysOf<Real>&, const NearestOptionsOf<Real>&);     \
  template Status FindInBoxes(const GeometryOf<Real>&, const BoxArraysOf<Real>&, std::size_t,   \
                              const OverlapLists&);                                             \
  template Status FindInBalls(const GeometryOf<Real>&, const PointArraysOf<Real>&, const Real*, \
                              std::size_t, const OverlapLists&)
SHEAF_INSTANTIATE(float);
SHEAF_INSTANTIATE(double);
#undef SHEAF_INSTANTIATE

}  // namespace sheaf
