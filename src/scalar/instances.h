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

// A ray, and the instance that its source is of.
template <typename Real>
struct InstanceRay {
  Ray<Real> ray;
  std::uint32_t source_instance = kNoInstance;
};

template <typename Real>
struct InstanceHit {
  Hit<Real> hit;
  std::uint32_t instance = kNoInstance;
};

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
Ray<Real> MapRay(const InstanceTree<Real>& tree, std::uint32_t instance,
                 const InstanceRay<Real>& ray) {
  const AffineMap& map = tree.to_object[instance];
  Ray<Real> mapped = ray.ray;
  mapped.origin = MapPoint(map, ray.ray.origin);
  mapped.direction = MapDirection(map, ray.ray.direction);
  if (LargestComponent(mapped.direction) < kMinMappedDirection<Real>) mapped.direction = {0, 0, 0};
  if (ray.source_instance != instance) mapped.source = kNoPrimitive;
  return mapped;
}

// A ray on its way through instances. The nearest hit among all of them, whatever the order: of
// equal t that of the lowest instance.
template <Query kQuery, typename Real>
class InstanceTracer {
 public:
  // `nearest`: what the ray hits first besides instances; its end, if that is nothing.
  InstanceTracer(const InstanceTree<Real>& tree, const InstanceRay<Real>& ray,
                 const InstanceHit<Real>& nearest)
      : tree_(tree), ray_(ray), nearest_(nearest) {
    ray_.ray.t_max = nearest.hit.t;
    MakeFinite(ray_.ray);
  }

  InstanceHit<Real> Trace() {
    if (tree_.node_count == 0 || !IsTraceable(ray_.ray)) return nearest_;
    if (FitsWideBoxes(ray_.ray)) {
      const double give = static_cast<double>(tree_.condition) * kInstanceSlack;
      Visit(0, WideSlabsOf(tree_, ray_.ray, give));
    } else {
      TestEvery();
    }
    return nearest_;
  }

  void TestEvery() {
    for (std::uint32_t i = 0; i < tree_.count && !is_done(); ++i) Test(i);
  }

 private:
  bool is_done() const {
    return kQuery == Query::kOccluded && nearest_.hit.primitive != kNoPrimitive;
  }

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
    double enter = OutwardBy(static_cast<double>(ray_.ray.t_min), -1);
    double leave = OutwardBy(static_cast<double>(ray_.ray.t_max), 1);
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
    const Hit<Real> hit = TreeTracer<kQuery, Real>(object, mapped).Trace();
    if (hit.primitive == kNoPrimitive ||
        !TakesOver(hit.t, instance, nearest_.hit.t, nearest_.hit.primitive, nearest_.instance)) {
      return;
    }
    nearest_ = {hit, instance};
    ray_.ray.t_max = hit.t;
  }

  const InstanceTree<Real>& tree_;
  InstanceRay<Real> ray_;
  InstanceHit<Real> nearest_;
};

// The nearest of `nearest` and all that the ray hits in instances.
template <typename Real>
InstanceHit<Real> TraceClosest(const InstanceTree<Real>& tree, const InstanceRay<Real>& ray,
                               const InstanceHit<Real>& nearest) {
  return InstanceTracer<Query::kClosest, Real>(tree, ray, nearest).Trace();
}

template <typename Real>
bool TraceOccluded(const InstanceTree<Real>& tree, const InstanceRay<Real>& ray) {
  const InstanceHit<Real> end = {Hit<Real>{ray.ray.t_max}};
  return InstanceTracer<Query::kOccluded, Real>(tree, ray, end).Trace().hit.primitive !=
         kNoPrimitive;
}

}  // namespace sheaf::scalar

#endif  // SHEAF_SCALAR_INSTANCES_H_
