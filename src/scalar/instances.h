// Rays against geometries that stand in many places.
//
// A ray is mapped into an object, not the object to where it stands: its direction keeps its
// length, so that t is the same on both sides. The map is computed wide and rounded once.
#ifndef SHEAF_SCALAR_INSTANCES_H_
#define SHEAF_SCALAR_INSTANCES_H_

#include <algorithm>
#include <bit>

#include "simd/instances.h"
#include "src/scalar/trace_tree.h"

namespace sheaf::scalar {

// The direction is turned alone. In the wide type, of which maps have the doubles.
template <typename Real>
Vec3<Real> MapDirection(const AffineMap& map, Vec3<Real> direction) {
  const Vec3<double> d = direction.template To<double>();
  const auto turned = [&](int k) {
    const auto& row = map.row[k];
    return static_cast<Real>((row[0] * d.x + row[1] * d.y) + row[2] * d.z);
  };
  return {turned(0), turned(1), turned(2)};
}

template <typename Real>
Vec3<Real> MapPoint(const AffineMap& map, Vec3<Real> point) {
  const Vec3<double> p = point.template To<double>();
  const auto moved = [&](int k) {
    const auto& row = map.row[k];
    return static_cast<Real>(((row[0] * p.x + row[1] * p.y) + row[2] * p.z) + row[3]);
  };
  return {moved(0), moved(1), moved(2)};
}

// The ray as the object of an instance sees it.
template <typename Real>
Ray<Real> MapRay(const InstanceTree<Real>& tree, std::uint32_t instance, const Ray<Real>& ray) {
  const AffineMap& map = tree.to_object[instance];
  Ray<Real> mapped = ray;
  mapped.origin = MapPoint(map, ray.origin);
  mapped.direction = MapDirection(map, ray.direction);
  if (LargestComponent(mapped.direction) < kMinMappedDirection<Real>) mapped.direction = {0, 0, 0};
  if (ray.instance != instance) mapped.source = kNoPrimitive;
  return mapped;
}

// A ray on its way through instances. The nearest hit among all of them, whatever the order: of
// equal t that of the lowest instance.
template <Query kQuery, typename Real>
class InstanceTracer {
 public:
  // `nearest`: what the ray hits first besides instances; its end, if that is nothing.
  InstanceTracer(const InstanceTree<Real>& tree, const Ray<Real>& ray, const Hit<Real>& nearest)
      : tree_(tree), ray_(ray), nearest_(nearest) {
    ray_.t_max = nearest.t;
    MakeFinite(ray_);
  }

  Hit<Real> Trace() {
    if (tree_.node_count == 0 || !IsTraceable(ray_)) return nearest_;
    if (FitsWideBoxes(ray_)) {
      const double give = static_cast<double>(tree_.condition) * kInstanceSlack;
      Visit(0, WideSlabsOf(tree_, ray_, give));
    } else {
      TestEvery();
    }
    return nearest_;
  }

  void TestEvery() {
    for (std::uint32_t i = 0; i < tree_.count && !is_done(); ++i) Test(i);
  }

 private:
  bool is_done() const { return kQuery == Query::kOccluded && nearest_.primitive != kNoPrimitive; }

  // Children in the order in which rays of the octant meet them. Recurses as deep as the tree.
  void Visit(std::uint32_t index, const RaySlabs<double>& box) {
    const TreeNode& node = tree_.nodes[index];
    std::uint32_t order = node.order[box.octant];
    for (std::uint32_t i = 0; i < kTreeWidth && !is_done(); ++i, order >>= 4) {
      const std::uint32_t k = order & 7, child = node.child[k];
      if (!Meets(node, k, box)) continue;
      if (IsLeaf(child)) {
        Test(LeafFirst(child));
      } else {
        Visit(child, box);
      }
    }
  }

  bool Meets(const TreeNode& node, std::uint32_t child, const RaySlabs<double>& box) const {
    double enter = OutwardBy(static_cast<double>(ray_.t_min), -1);
    double leave = OutwardBy(static_cast<double>(ray_.t_max), 1);
    for (int axis = 0; axis < 3; ++axis) {
      const auto at = [&](int row, double offset) {
        return static_cast<double>(node.bounds[row][child]) * box.scale[axis] + offset;
      };
      enter = std::max(enter, OutwardBy(at(box.enter_row[axis], box.enter[axis]), -1));
      leave = std::min(leave, OutwardBy(at(box.leave_row[axis], box.leave[axis]), 1));
    }
    return enter <= leave;
  }

  void Test(std::uint32_t instance) {
    const TreeView<Real>& object = tree_.trees[tree_.object[instance]];
    const Ray<Real> mapped = MapRay(tree_, instance, ray_);
    if constexpr (kQuery == Query::kOccluded) {
      if (TraceOccluded(object, mapped)) nearest_.primitive = 0;  // whichever
      return;
    }
    Hit<Real> hit = TraceClosest(object, mapped);
    if (hit.primitive == kNoPrimitive ||
        !TakesOver(hit.t, instance, nearest_.t, nearest_.primitive, nearest_.instance)) {
      return;
    }
    hit.instance = instance;
    nearest_ = hit;
    ray_.t_max = hit.t;
  }

  const InstanceTree<Real>& tree_;
  Ray<Real> ray_;
  Hit<Real> nearest_;
};

// The nearest of `nearest` and all that the ray hits in instances.
template <typename Real>
Hit<Real> TraceClosest(const InstanceTree<Real>& tree, const Ray<Real>& ray,
                       const Hit<Real>& nearest) {
  return InstanceTracer<Query::kClosest, Real>(tree, ray, nearest).Trace();
}

template <typename Real>
bool TraceOccluded(const InstanceTree<Real>& tree, const Ray<Real>& ray) {
  const Hit<Real> end = {ray.t_max};
  return InstanceTracer<Query::kOccluded, Real>(tree, ray, end).Trace().primitive != kNoPrimitive;
}

}  // namespace sheaf::scalar

#endif  // SHEAF_SCALAR_INSTANCES_H_
