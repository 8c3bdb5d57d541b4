// Rays with what the specification makes of them, and the check that every kernel agrees.
#ifndef SHEAF_TESTS_EXPECTED_TRACES_H_
#define SHEAF_TESTS_EXPECTED_TRACES_H_

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "bits.h"
#include "random_scene.h"
#include "simd/kernels.h"
#include "simd/query.h"
#include "simd/streams.h"
#include "simd/tree.h"
#include "src/bvh/build_tree.h"
#include "src/scalar/trace_tree.h"
#include "targets.h"

namespace sheaf {

inline constexpr Coherence kHints[] = {Coherence::kUnknown, Coherence::kCommonOrigin,
                                       Coherence::kCoherent, Coherence::kIncoherent};

template <typename Real>
Vec3<Real> As(const Vec3d& v) {
  return Vec3<double>{v.x, v.y, v.z}.To<Real>();
}

// Rays in the arrays that a caller would hand in, `offset` elements into them.
template <typename Real>
struct RayBatch {
  std::uint32_t offset, count;
  RayStream<Real> rays;
  AlignedArray<Real> t_min, t_max;

  RayBatch(const std::vector<scalar::Ray<Real>>& from, std::uint32_t at)
      : offset(at), count(static_cast<std::uint32_t>(from.size())) {
    rays.Allocate(count + offset);
    t_min.Allocate(StreamCapacity(count + offset));
    t_max.Allocate(StreamCapacity(count + offset));
    const auto out = rays.output(offset);
    for (std::uint32_t i = 0; i < count; ++i) {
      out.origin_x[i] = from[i].origin.x;
      out.origin_y[i] = from[i].origin.y;
      out.origin_z[i] = from[i].origin.z;
      out.direction_x[i] = from[i].direction.x;
      out.direction_y[i] = from[i].direction.y;
      out.direction_z[i] = from[i].direction.z;
      out.source[i] = from[i].source;
      t_min[offset + i] = from[i].t_min;
      t_max[offset + i] = from[i].t_max;
    }
  }

  RayView<Real> view() {
    RayView<Real> view;
    auto out = rays.output(offset);
    ForEachField(view, out, [](auto& to, auto from) { to = from; });
    return view;
  }
  RayIntervals<Real> intervals() const { return {t_min.data() + offset, t_max.data() + offset}; }
};

// A scene, its tree, and rays with what the specification makes of them, over every primitive and
// without a tree.
template <typename Real>
struct Expected {
  CompiledScene<Real> scene;
  Tree<Real> tree;
  std::vector<scalar::Ray<Real>> rays;
  std::vector<scalar::Hit<Real>> hits;
  std::vector<bool> occluded;

  Expected(const Scene& from, std::vector<scalar::Ray<Real>> of)
      : scene(CompileScene<Real>(from)), rays(std::move(of)) {
    Result<Tree<Real>> built = BuildTree<Real>(scene.geometry());
    REQUIRE(built);
    tree = std::move(built).value();
    for (const scalar::Ray<Real>& ray : rays) {
      hits.push_back(scalar::TraceClosest(scene.geometry(), ray));
      occluded.push_back(scalar::TraceOccluded(scene.geometry(), ray));
    }
  }
  std::uint32_t hit_count() const {
    return static_cast<std::uint32_t>(std::count(occluded.begin(), occluded.end(), true));
  }
};

// The interval of a missing ray may be NaN, whose bits are nobody's promise.
template <typename Real>
bool SameHit(const scalar::Hit<Real>& a, const scalar::Hit<Real>& b) {
  const bool same_t = SameBits(a.t, b.t) || (a.t != a.t && b.t != b.t);
  return same_t && SameBits(a.u, b.u) && SameBits(a.v, b.v) && a.primitive == b.primitive;
}

template <typename Real>
void CheckTraces(Target target, const Expected<Real>& want, std::uint32_t offset,
                 Coherence coherence) {
  const Kernels<Real> kernels = StrictKernels<Real>(target.id());
  RayBatch<Real> batch(want.rays, offset);
  HitStream<Real> hits;
  hits.Allocate(batch.count);
  AlignedArray<std::uint32_t> occluded;
  occluded.Allocate(StreamCapacity(batch.count));
  const TreeView<Real> tree = want.tree.view();
  kernels.trace_closest(tree, batch.view(), batch.intervals(), batch.count, coherence,
                        hits.output());
  kernels.trace_occluded(tree, batch.view(), batch.intervals(), batch.count, coherence,
                         occluded.data());
  const auto got = hits.view();
  std::uint32_t wrong_hits = 0, wrong_shadows = 0;
  for (std::uint32_t i = 0; i < batch.count; ++i) {
    const scalar::Hit<Real> hit = {got.t[i], got.primitive[i], got.u[i], got.v[i]};
    wrong_hits += !SameHit(hit, want.hits[i]);
    wrong_shadows += occluded[i] != (want.occluded[i] ? 1u : 0u);
  }
  CHECK(wrong_hits == 0);
  CHECK(wrong_shadows == 0);
}

// The baseline through the tree, and the kernels on every target with every hint.
template <typename Real>
void CheckEverywhere(const Expected<Real>& want) {
  std::uint32_t wrong = 0;
  for (std::size_t i = 0; i < want.rays.size(); ++i) {
    wrong += !SameHit(scalar::TraceClosest(want.tree.view(), want.rays[i]), want.hits[i]);
    wrong += scalar::TraceOccluded(want.tree.view(), want.rays[i]) != want.occluded[i];
  }
  CHECK(wrong == 0);
  ForEachTarget([&](Target target) {
    for (const Coherence coherence : kHints) CheckTraces(target, want, 0, coherence);
  });
}

// Rays of one origin through a grid in blocks of eight by eight, as of a camera or a light: tiles.
// `towards` is the middle direction, `spread` the grid's size.
template <typename Real>
std::vector<scalar::Ray<Real>> GridRays(Random& random, Vec3d origin, Vec3d towards,
                                        double spread) {
  std::vector<scalar::Ray<Real>> rays;
  const Vec3d right = Vec3d(towards.y, towards.z, towards.x), up = Vec3d(towards.z, 0, -towards.x);
  for (std::uint32_t i = 0; i < 1024; ++i) {
    const std::uint32_t x = (i & 7) + (i >> 6 & 3) * 8, y = (i >> 3 & 7) + (i >> 8) * 8;
    const double a = (x / 32.0 - 0.5) * spread, b = (y / 32.0 - 0.5) * spread;
    // Lengths differ, as those of shadow rays do.
    const Vec3d direction = (towards + a * right + b * up) * Uniform(random, 0.2, 5);
    scalar::Ray<Real> ray;
    ray.origin = As<Real>(origin);
    ray.direction = As<Real>(direction);
    if (random() % 16 == 0) ray.t_max = static_cast<Real>(Uniform(random, 0, 3));
    if (random() % 64 == 0) ray.direction.x = std::numeric_limits<Real>::quiet_NaN();
    rays.push_back(ray);
  }
  return rays;
}

}  // namespace sheaf

#endif  // SHEAF_TESTS_EXPECTED_TRACES_H_
