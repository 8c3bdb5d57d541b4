// How often rays cross surfaces, and what is inside of them.
#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "sheaf/queries.h"
#include "simd/tree.h"
#include "src/bvh/check_arrays.h"
#include "src/bvh/check_points.h"
#include "src/bvh/geometry_access.h"
#include "src/bvh/list_hits.h"
#include "src/bvh/ray_batches.h"
#include "src/scalar/crossing.h"

namespace sheaf {
namespace {

constexpr std::uint32_t kCandidates = 16;  // hits of a ray that are looked at together

// Counts the crossings of a lister's rays.
template <typename Real>
class CrossingCounter {
 public:
  explicit CrossingCounter(const GeometryOf<Real>& geometry)
      : data_(GeometryAccess::DataOf(geometry)) {
    data_.index.Ensure(data_.view, data_.first.back());
  }

  // Takes rays [first, first + n); calls count(i, kind) for each crossing of ray i of them.
  template <typename Count>
  void ForEach(HitLister<Real>& lister, std::size_t first, std::uint32_t n, Count count) const {
    lister.Take(first, n);
    do {
      for (std::uint32_t i = 0; i < n; ++i) {
        for (std::uint32_t k = 0; k < lister.listed[i]; ++k) {
          const ListedHit<Real>& hit = lister.list(i)[k];
          const PrimitiveKind kind = LeafKind(data_.index.leaf(hit.primitive));
          if (kind != PrimitiveKind::kTriangle || Crosses(lister.rays(), i, hit)) count(i, kind);
        }
      }
    } while (lister.Next([](std::uint32_t) { return true; }));
  }

 private:
  bool Crosses(const RayView<Real>& rays, std::uint32_t i, const ListedHit<Real>& hit) const {
    // Well inside the triangle no edge function is 0.
    constexpr Real kWithin = Real(1e-3);
    if (hit.u > kWithin && hit.v > kWithin && hit.u + hit.v < 1 - kWithin) return true;
    TriangleArrays<Real> triangles{};
    ShowLeaf(data_.view, data_.index.leaf(hit.primitive), triangles);
    const auto shear =
        scalar::ShearOf(Vec3<Real>{rays.direction_x[i], rays.direction_y[i], rays.direction_z[i]});
    return scalar::Crosses(Vec3<Real>{rays.origin_x[i], rays.origin_y[i], rays.origin_z[i]}, shear,
                           triangles, data_.index.lane(hit.primitive));
  }

  const GeometryAccess::Data<Real>& data_;
};

}  // namespace

template <typename Real>
Status CountCrossings(const GeometryOf<Real>& geometry, const RayArraysOf<Real>& rays,
                      std::size_t count, std::uint32_t* crossings,
                      const RuledTraceOptionsOf<Real>& options) {
  if (Status checked = CheckRules(rays, count, options); !checked) return checked;
  if (count > 0 && !crossings) return NullArray("crossings");
  const CrossingCounter<Real> counter(geometry);
  HitLister<Real> lister(geometry, rays, options, kCandidates);
  std::fill(crossings, crossings + count, 0u);
  ForEachBatch(count, kListBlock, [&](std::size_t first, std::uint32_t n) {
    counter.ForEach(lister, first, n,
                    [&](std::uint32_t i, PrimitiveKind) { ++crossings[first + i]; });
  });
  return Done{};
}

template <typename Real>
Status FindInside(const GeometryOf<Real>& geometry, const PointArraysOf<Real>& points,
                  std::size_t count, std::uint32_t* inside, const HitRules& rules, Target target) {
  if (Status checked = CheckPoints(points, count); !checked) return checked;
  if (count > 0 && !inside) return NullArray("inside");
  // Along an axis nothing is sheared: all that rounds is the difference of vertex and origin.
  Real x[kListBlock], y[kListBlock], z[kListBlock], one[kListBlock], zero[kListBlock] = {};
  std::fill(one, one + kListBlock, Real(1));
  const RayArraysOf<Real> rays = {x, y, z, one, zero, zero};
  RuledTraceOptionsOf<Real> options = {.rules = rules, .target = target};
  if (Status checked = CheckRules(rays, count, options); !checked) return checked;
  const CrossingCounter<Real> counter(geometry);
  HitLister<Real> lister(geometry, rays, options, kCandidates);
  ForEachBatch(count, kListBlock, [&](std::size_t first, std::uint32_t n) {
    Gather(points.x, points.stride, first, n, x);
    Gather(points.y, points.stride, first, n, y);
    Gather(points.z, points.stride, first, n, z);
    // The lister's rays are those of this block.
    if (rules.ray_mask) options.rules.ray_mask = rules.ray_mask + first;
    if (rules.excluded) options.rules.excluded = rules.excluded + first * rules.excluded_per_ray;
    std::fill(inside + first, inside + first + n, 0u);
    counter.ForEach(lister, 0, n, [&](std::uint32_t i, PrimitiveKind kind) {
      if (kind != PrimitiveKind::kDisk) inside[first + i] ^= 1u;
    });
  });
  return Done{};
}

#define SHEAF_INSTANTIATE(Real)                                                                  \
  template Status CountCrossings(const GeometryOf<Real>&, const RayArraysOf<Real>&, std::size_t, \
                                 std::uint32_t*, const RuledTraceOptionsOf<Real>&);              \
  template Status FindInside(const GeometryOf<Real>&, const PointArraysOf<Real>&, std::size_t,   \
                             std::uint32_t*, const HitRules&, Target)
SHEAF_INSTANTIATE(float);
SHEAF_INSTANTIATE(double);
#undef SHEAF_INSTANTIATE

}  // namespace sheaf
