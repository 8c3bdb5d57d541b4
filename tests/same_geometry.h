// Two geometries that have to be the same to all who ask, and how to move what one is made of.
#ifndef SHEAF_TESTS_SAME_GEOMETRY_H_
#define SHEAF_TESTS_SAME_GEOMETRY_H_

#include <doctest/doctest.h>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "bits.h"
#include "random_rays.h"
#include "sheaf/geometry.h"
#include "targets.h"

namespace sheaf {

template <typename Real>
RayLists<Real> SomeRays(Random& random, std::size_t count) {
  RayLists<Real> rays;
  for (std::size_t i = 0; i < count; ++i) {
    scalar::Ray<Real> ray;
    ray.origin = ToVec3(UniformPoint(random, -6, 6)).To<Real>();
    ray.direction = RandomUnit(random).To<Real>();
    ray.t_min = std::numeric_limits<Real>::min();
    ray.t_max = std::numeric_limits<Real>::max();
    ray.source = kNoPrimitive;
    rays.Add(ray);
  }
  return rays;
}

template <typename Real>
bool SameHits(const HitLists<Real>& a, const HitLists<Real>& b) {
  for (std::size_t i = 0; i < a.t.size(); ++i) {
    if (a.primitive[i] != b.primitive[i] || a.object[i] != b.object[i]) return false;
    if (!SameBits(a.t[i], b.t[i]) || !SameBits(a.u[i], b.u[i]) || !SameBits(a.v[i], b.v[i])) {
      return false;
    }
  }
  return true;
}

// Hits, points and what is counted of `updated` are those of `fresh`, on all targets.
template <typename Real>
void CheckSame(const GeometryOf<Real>& updated, const GeometryOf<Real>& fresh, Random& random) {
  const std::size_t count = 700;
  const RayLists<Real> rays = SomeRays<Real>(random, count);
  ForEachTarget([&](Target target) {
    TraceOptionsOf<Real> options{.target = target};
    HitLists<Real> expected(count), got(count);
    TraceClosest(fresh, rays.view(), count, expected.view(), options).value();
    TraceClosest(updated, rays.view(), count, got.view(), options).value();
    CHECK(SameHits(expected, got));
    std::vector<std::uint32_t> shadow(count), shadow_got(count);
    TraceOccluded(fresh, rays.view(), count, shadow.data(), options).value();
    TraceOccluded(updated, rays.view(), count, shadow_got.data(), options).value();
    CHECK(shadow == shadow_got);
    for (std::size_t i = 0; i < count; i += 50) {
      const auto a = FindHitPoint(fresh, rays.view(), expected.view(), i).value();
      const auto b = FindHitPoint(updated, rays.view(), expected.view(), i).value();
      CHECK(a.normal == b.normal);
      CHECK(a.front == b.front);
    }
  });
  CHECK(updated.lower() == fresh.lower());
  CHECK(updated.upper() == fresh.upper());
  const GeometryStatistics a = updated.statistics(), b = fresh.statistics();
  CHECK(a.primitives == b.primitives);
  CHECK(a.never_hit == b.never_hit);
  CHECK(a.skipped == b.skipped);
}

template <typename Real>
void MoveObjects(Random& random, double by, RandomObjects<Real>& objects) {
  const auto move = [&](std::vector<Real>& numbers, std::size_t stride, std::size_t moved) {
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      if (i % stride >= moved) continue;
      numbers[i] = static_cast<Real>(static_cast<float>(numbers[i] + Uniform(random, -by, by)));
    }
  };
  move(objects.vertices, 3, 3);
  move(objects.bare, 3, 3);
  move(objects.spheres, 4, 3);
  move(objects.disks, 7, 3);
  move(objects.normals, 3, 3);
}

}  // namespace sheaf

#endif  // SHEAF_TESTS_SAME_GEOMETRY_H_
