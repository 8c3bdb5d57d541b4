// All hits of a ray, over every primitive and through a tree.
#ifndef SHEAF_SCALAR_TRACE_ALL_H_
#define SHEAF_SCALAR_TRACE_ALL_H_

#include "simd/hit_list.h"
#include "simd/primitives.h"
#include "simd/query.h"
#include "simd/tree.h"
#include "src/scalar/primitives.h"
#include "src/scalar/ray.h"
#include "src/scalar/trace_tree.h"

namespace sheaf::scalar {

// Calls f(hit) for the places where the ray meets primitive `i`: two of a sphere, one of others.
template <typename Real, typename Arrays, typename F>
void ForEachMeeting(const Ray<Real>& ray, const RayTerms<Real>& terms, const Arrays& arrays,
                    std::uint32_t i, F f) {
  const auto hit = HitPrimitive(ray, terms, arrays, i);
  if (!hit) return;
  f(*hit);
  if constexpr (Arrays::kKind == PrimitiveKind::kSphere) {
    const bool leaves = hit->u != 0;
    if (leaves) return;
    // From inside, the far root alone counts.
    Ray<Real> inside = ray;
    inside.source = arrays.id[i] | kInsideBit;
    if (const auto far = HitPrimitive(inside, terms, arrays, i)) f(*far);
  }
}

// Keeps a list of hits: see HitList.
template <typename Real>
struct ListKeeper {
  HitList<Real>& list;

  bool is_done() const { return list.is_done(); }

  template <typename Arrays>
  void Test(Ray<Real>& ray, const RayTerms<Real>& terms, const Arrays& arrays) {
    for (std::uint32_t i = 0; i < arrays.count && !is_done(); ++i) {
      ForEachMeeting(ray, terms, arrays, i, [&](const Hit<Real>& hit) {
        list.Add({hit.t, hit.primitive, hit.u, hit.v});
      });
      ray.t_max = list.last();
    }
  }
};

// Writes the list of ray number `i`: every hit in its interval, or as many of them as `lists` asks
// for.
template <typename Real>
void ListHits(const GeometryView<Real>& geometry, Ray<Real> ray, std::uint32_t i,
              const HitRuleView& rules, const HitListOutput<Real>& lists) {
  MakeFinite(ray);
  HitList<Real> list(lists, rules, i, ray.t_max);
  ListKeeper<Real> keeper{list};
  if (IsTraceable(ray)) {
    const RayTerms<Real> terms(ray);
    ForEachKind(geometry, [&](const auto& arrays) { keeper.Test(ray, terms, arrays); });
  }
  list.Finish();
}

// The same through a tree.
template <typename Real>
void ListHits(const TreeView<Real>& tree, Ray<Real> ray, std::uint32_t i, const HitRuleView& rules,
              const HitListOutput<Real>& lists) {
  MakeFinite(ray);
  HitList<Real> list(lists, rules, i, ray.t_max);
  ListKeeper<Real> keeper{list};
  TreeTracer(tree, ray, keeper).Trace();
  list.Finish();
}

}  // namespace sheaf::scalar

#endif  // SHEAF_SCALAR_TRACE_ALL_H_
