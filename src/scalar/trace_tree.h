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

// A ray on its way through a tree, and what it has hit so far.
template <Query kQuery, typename Real>
class TreeTracer {
 public:
  TreeTracer(const TreeView<Real>& tree, const Ray<Real>& ray) : tree_(tree), ray_(ray) {
    MakeFinite(ray_);
    closest_.t = ray_.t_max;
  }

  Hit<Real> Trace() {
    if (tree_.node_count == 0 || !IsTraceable(ray_)) return closest_;
    terms_.emplace(ray_);
    if (!FitsBoxes(tree_, ray_)) {
      TestEveryLeaf();
    } else {
      box_ = SlabsOf(tree_, ray_);
      Walk();
    }
    return closest_;
  }

 private:
  struct Entry {
    Real enter;
    std::uint32_t child;
  };

  bool is_done() const { return kQuery == Query::kOccluded && closest_.primitive != kNoPrimitive; }

  void TestEveryLeaf() {
    for (std::uint32_t i = 0; i < tree_.node_count; ++i) {
      for (const std::uint32_t child : tree_.nodes[i].child) {
        if (IsLeaf(child) && child != kNoChild) TestLeaf(child);
        if (is_done()) return;
      }
    }
  }

  // Depth first, the nearest child first.
  void Walk() {
    Entry stack[kTreeStackSize];
    std::uint32_t size = 0;
    stack[size++] = {0, 0};
    while (size > 0) {
      const Entry entry = stack[--size];
      if (entry.enter > LastT()) continue;
      if (IsLeaf(entry.child)) {
        TestLeaf(entry.child);
        if (is_done()) return;
        continue;
      }
      const std::uint32_t first = size;
      const TreeNode& node = tree_.nodes[entry.child];
      Real enter[kTreeWidth];
      const std::uint32_t met = TestBoxes(node, enter);
      for (std::uint32_t rest = met; rest != 0; rest &= rest - 1) {
        const int i = std::countr_zero(rest);
        // Insertion keeps the nearest on top.
        std::uint32_t at = size++;
        for (; at > first && stack[at - 1].enter < enter[i]; --at) stack[at] = stack[at - 1];
        stack[at] = {enter[i], node.child[i]};
      }
    }
  }

  // No box that is entered later can hold what counts.
  Real LastT() const { return ray_.t_max * Real(kBoxFarFactor); }

  // The children whose boxes the ray meets, as bits, and where it enters them.
  std::uint32_t TestBoxes(const TreeNode& node, Real (&enter)[kTreeWidth]) const {
    Real leave[kTreeWidth];
    for (std::uint32_t i = 0; i < kTreeWidth; ++i) {
      const auto at = [&](const int(&row)[3], const Real(&offset)[3], int axis) {
        return node.bounds[row[axis]][i] * box_.scale[axis] + offset[axis];
      };
      const Real in_x = at(box_.enter_row, box_.enter, 0), in_y = at(box_.enter_row, box_.enter, 1),
                 in_z = at(box_.enter_row, box_.enter, 2);
      const Real out_x = at(box_.leave_row, box_.leave, 0),
                 out_y = at(box_.leave_row, box_.leave, 1),
                 out_z = at(box_.leave_row, box_.leave, 2);
      enter[i] = std::max(std::max(in_x, in_y), std::max(in_z, ray_.t_min));
      leave[i] = std::min(std::min(out_x, out_y), out_z) * Real(kBoxFarFactor);
    }
    std::uint32_t met = 0;
    const Real last = LastT();
    for (std::uint32_t i = 0; i < kTreeWidth; ++i) {
      met |= static_cast<std::uint32_t>(enter[i] <= std::min(leave[i], last)) << i;
    }
    return met;
  }

  void TestLeaf(std::uint32_t leaf) {
    WithKind<Real>(LeafKind(leaf), [&](auto arrays) {
      ShowLeaf(tree_, leaf, arrays);
      ForEachHit(ray_, *terms_, arrays, [&](const Hit<Real>& hit) {
        if (hit.t < closest_.t || hit.primitive < closest_.primitive) closest_ = hit;
        ray_.t_max = closest_.t;
        return !is_done();
      });
    });
  }

  const TreeView<Real>& tree_;
  Ray<Real> ray_;
  Hit<Real> closest_;
  std::optional<RayTerms<Real>> terms_;
  RaySlabs<Real> box_;
};

template <typename Real>
Hit<Real> TraceClosest(const TreeView<Real>& tree, const Ray<Real>& ray) {
  return TreeTracer<Query::kClosest, Real>(tree, ray).Trace();
}

template <typename Real>
bool TraceOccluded(const TreeView<Real>& tree, const Ray<Real>& ray) {
  return TreeTracer<Query::kOccluded, Real>(tree, ray).Trace().primitive != kNoPrimitive;
}

}  // namespace sheaf::scalar

#endif  // SHEAF_SCALAR_TRACE_TREE_H_
