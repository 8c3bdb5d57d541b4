// The queries of trace.h through a tree, one ray at a time: the scalar baseline. The same bits as
// over every primitive, because no box excludes a hit and the lowest id wins ties.
#ifndef SHEAF_SCALAR_TRACE_TREE_H_
#define SHEAF_SCALAR_TRACE_TREE_H_

#include <bit>
#include <optional>

#include "simd/query.h"
#include "simd/tree.h"
#include "src/scalar/ray_slabs.h"
#include "src/scalar/trace.h"

namespace sheaf::scalar {

// A ray on its way through a tree. What becomes of its hits is up to `Keeper`:
//   void Test(ray, terms, arrays): takes the primitives of a leaf, and shortens the ray as it
//   likes; bool is_done(): nothing more is wanted.
template <class Keeper, typename Real>
class TreeTracer {
 public:
  TreeTracer(const TreeView<Real>& tree, const Ray<Real>& ray, Keeper& keeper)
      : tree_(tree), ray_(ray), keeper_(keeper) {}

  void Trace() {
    if (tree_.node_count == 0 || !IsTraceable(ray_)) return;
    terms_.emplace(ray_);
    if (FitsBoxes(ray_)) {
      Walk<BoxTest::kPlain>(SlabsOf(tree_, ray_));
    } else if (FitsWideBoxes(ray_)) {
      Walk<BoxTest::kWide>(WideSlabsOf(tree_, ray_));
    } else {
      TestEveryLeaf();
    }
  }

 private:
  // In Real for t >= 0, or in double for any t.
  enum class BoxTest { kPlain, kWide };

  template <typename BoxReal>
  struct Entry {
    BoxReal enter;
    std::uint32_t child;
  };

  void TestEveryLeaf() {
    for (std::uint32_t i = 0; i < tree_.node_count; ++i) {
      for (const std::uint32_t child : tree_.nodes[i].child) {
        if (IsLeaf(child) && child != kNoChild) TestLeaf(child);
        if (keeper_.is_done()) return;
      }
    }
  }

  // Depth first, the nearest child first.
  template <BoxTest kTest, typename BoxReal>
  void Walk(const RaySlabs<BoxReal>& box) {
    Entry<BoxReal> stack[kTreeStackSize];
    std::uint32_t size = 0;
    stack[size++] = {FirstT<kTest, BoxReal>(), 0};
    while (size > 0) {
      const Entry<BoxReal> entry = stack[--size];
      if (entry.enter > LastT<kTest, BoxReal>()) continue;
      if (IsLeaf(entry.child)) {
        TestLeaf(entry.child);
        if (keeper_.is_done()) return;
        continue;
      }
      const std::uint32_t first = size;
      const TreeNode& node = tree_.nodes[entry.child];
      BoxReal enter[kTreeWidth];
      const std::uint32_t met = TestBoxes<kTest>(box, node, enter);
      for (std::uint32_t rest = met; rest != 0; rest &= rest - 1) {
        const int i = std::countr_zero(rest);
        // Insertion keeps the nearest on top.
        std::uint32_t at = size++;
        for (; at > first && stack[at - 1].enter < enter[i]; --at) stack[at] = stack[at - 1];
        stack[at] = {enter[i], node.child[i]};
      }
    }
  }

  // No box that is left earlier, or entered later, can hold what counts.
  template <BoxTest kTest, typename BoxReal>
  BoxReal FirstT() const {
    if constexpr (kTest == BoxTest::kPlain) return ray_.t_min;
    return static_cast<BoxReal>(OutwardBy(static_cast<double>(ray_.t_min), -1));
  }
  template <BoxTest kTest, typename BoxReal>
  BoxReal LastT() const {
    if constexpr (kTest == BoxTest::kPlain) return ray_.t_max * Real(kBoxFarFactor);
    return static_cast<BoxReal>(OutwardBy(static_cast<double>(ray_.t_max), 1));
  }

  // The children whose boxes the ray meets, as bits, and where it enters them.
  template <BoxTest kTest, typename BoxReal>
  std::uint32_t TestBoxes(const RaySlabs<BoxReal>& box, const TreeNode& node,
                          BoxReal (&enter)[kTreeWidth]) const {
    BoxReal leave[kTreeWidth];
    const BoxReal first = FirstT<kTest, BoxReal>(), last = LastT<kTest, BoxReal>();
    for (std::uint32_t i = 0; i < kTreeWidth; ++i) {
      const auto at = [&](const int(&row)[3], const BoxReal(&offset)[3], int axis) {
        return node.bounds[row[axis]][i] * box.scale[axis] + offset[axis];
      };
      const BoxReal in_x = at(box.enter_row, box.enter, 0), in_y = at(box.enter_row, box.enter, 1),
                    in_z = at(box.enter_row, box.enter, 2);
      const BoxReal out_x = at(box.leave_row, box.leave, 0),
                    out_y = at(box.leave_row, box.leave, 1),
                    out_z = at(box.leave_row, box.leave, 2);
      leave[i] = std::min(std::min(out_x, out_y), out_z);
      if constexpr (kTest == BoxTest::kPlain) {
        enter[i] = std::max(std::max(in_x, in_y), std::max(in_z, first));
        leave[i] *= BoxReal(kBoxFarFactor);
      } else {
        enter[i] = std::max(OutwardBy(std::max(std::max(in_x, in_y), in_z), -1), first);
        leave[i] = OutwardBy(leave[i], 1);
      }
    }
    std::uint32_t met = 0;
    for (std::uint32_t i = 0; i < kTreeWidth; ++i) {
      met |= static_cast<std::uint32_t>(enter[i] <= std::min(leave[i], last)) << i;
    }
    return met;
  }

  void TestLeaf(std::uint32_t leaf) {
    WithKind<Real>(LeafKind(leaf), [&](auto arrays) {
      ShowLeaf(tree_, leaf, arrays);
      keeper_.Test(ray_, *terms_, arrays);
    });
  }

  const TreeView<Real>& tree_;
  Ray<Real> ray_;
  Keeper& keeper_;
  std::optional<RayTerms<Real>> terms_;
};

// Keeps the nearest hit, or any.
template <Query kQuery, typename Real>
struct HitKeeper {
  Hit<Real> closest;

  bool is_done() const { return kQuery == Query::kOccluded && closest.primitive != kNoPrimitive; }

  template <typename Arrays>
  void Test(Ray<Real>& ray, const RayTerms<Real>& terms, const Arrays& arrays) {
    ForEachHit(ray, terms, arrays, [&](const Hit<Real>& hit) {
      if (hit.t < closest.t || hit.primitive < closest.primitive) closest = hit;
      ray.t_max = closest.t;
      return !is_done();
    });
  }
};

template <Query kQuery, typename Real>
Hit<Real> TraceTree(const TreeView<Real>& tree, Ray<Real> ray) {
  MakeFinite(ray);
  HitKeeper<kQuery, Real> keeper{{ray.t_max}};
  TreeTracer(tree, ray, keeper).Trace();
  return keeper.closest;
}

template <typename Real>
Hit<Real> TraceClosest(const TreeView<Real>& tree, const Ray<Real>& ray) {
  return TraceTree<Query::kClosest>(tree, ray);
}

template <typename Real>
bool TraceOccluded(const TreeView<Real>& tree, const Ray<Real>& ray) {
  return TraceTree<Query::kOccluded>(tree, ray).primitive != kNoPrimitive;
}

}  // namespace sheaf::scalar

#endif  // SHEAF_SCALAR_TRACE_TREE_H_
