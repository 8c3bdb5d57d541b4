// All hits of rays: every kernel and the scalar baseline against every primitive in turn.
#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "bits.h"
#include "expected_traces.h"
#include "random_scene.h"
#include "simd/kernels.h"
#include "simd/trace_all.h"
#include "src/bvh/build_tree.h"
#include "src/scalar/trace_all.h"
#include "targets.h"

namespace sheaf {
namespace {

// What is asked of a batch, and where it is written.
template <typename Real>
struct Lists {
  std::vector<ListedHit<Real>> hits, after;
  std::vector<std::uint32_t> listed, total;
  HitListOutput<Real> output;

  Lists(std::size_t rays, std::uint32_t capacity)
      : hits(rays * capacity + 1), listed(rays), total(rays) {
    output = {hits.data(), capacity, listed.data(), total.data()};
  }
};

template <typename Real>
bool Same(const ListedHit<Real>& a, const ListedHit<Real>& b) {
  return SameBits(a.t, b.t) && SameBits(a.u, b.u) && SameBits(a.v, b.v) &&
         a.primitive == b.primitive;
}

template <typename Real>
std::size_t Differences(const Lists<Real>& a, const Lists<Real>& b) {
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < a.listed.size(); ++i) {
    bool same = a.listed[i] == b.listed[i] && (!a.output.total || a.total[i] == b.total[i]);
    for (std::size_t k = 0; same && k < a.listed[i]; ++k) {
      const std::size_t at = i * a.output.capacity + k;
      same = Same(a.hits[at], b.hits[at]);
    }
    wrong += !same;
  }
  return wrong;
}

// Of every list alike.
template <typename Real>
struct Asked {
  std::uint32_t capacity;
  HitRuleView rules;
  std::vector<ListedHit<Real>> after;
  bool counts;

  Lists<Real> Room(std::size_t rays) const {
    Lists<Real> room(rays, capacity);
    if (!counts) room.output.total = nullptr;
    if (!after.empty()) room.output.after = after.data();
    return room;
  }
};

template <typename Real>
void CheckLists(const Scene& from, const std::vector<scalar::Ray<Real>>& rays,
                const Asked<Real>& asked) {
  const CompiledScene<Real> scene = CompileScene<Real>(from);
  Result<Tree<Real>> built = BuildTree<Real>(scene.geometry());
  REQUIRE(built);
  const Tree<Real> tree = std::move(built).value();
  const TreeView<Real> view = tree.view();
  Lists<Real> want = asked.Room(rays.size()), walked = asked.Room(rays.size());
  for (std::uint32_t i = 0; i < rays.size(); ++i) {
    scalar::ListHits(scene.geometry(), rays[i], i, asked.rules, want.output);
    scalar::ListHits(view, rays[i], i, asked.rules, walked.output);
  }
  CHECK(Differences(want, walked) == 0);
  ForEachTarget([&](Target target) {
    const Kernels<Real> kernels = StrictKernels<Real>(target.id());
    RayBatch<Real> batch(rays, 3);
    Lists<Real> got = asked.Room(rays.size());
    kernels.trace_all(view, batch.view(), batch.intervals(), batch.count, asked.rules, got.output);
    CHECK(Differences(want, got) == 0);
  });
}

template <typename Real>
std::vector<scalar::Ray<Real>> RandomRays(Random& random, std::size_t count,
                                          std::uint32_t primitives) {
  std::vector<scalar::Ray<Real>> rays;
  for (std::size_t i = 0; i < count; ++i) {
    rays.push_back(RandomRay<Real>(random, primitives));
    if (i % 8 == 0) rays.back().t_min = -1;         // boxes in double
    if (i % 64 == 0) rays.back().origin.x = 1e13f;  // no boxes at all
  }
  return rays;
}

// Disks among spheres and triangles, which RandomScene has none of.
void AddDisks(Random& random, Scene& scene) {
  for (int i = 0; i < 40; ++i) {
    Object object;
    object.shape =
        Disk{UniformPoint(random, -4, 4), Uniform(random, 0.1, 2), UniformPoint(random, -1, 1)};
    scene.objects.push_back(object);
  }
}

TEST_CASE_TEMPLATE("lists are those of every primitive in turn", Real, float, double) {
  for (const int objects : {1, 3, 60, 500}) {
    CAPTURE(objects);
    Random random(static_cast<std::uint64_t>(objects));
    Scene scene = RandomScene(random, objects);
    if (objects >= 60) AddDisks(random, scene);
    const auto primitives = static_cast<std::uint32_t>(scene.objects.size());
    for (const std::size_t count : {1, 5, 33, 800}) {
      const auto rays = RandomRays<Real>(random, count, primitives);
      CheckLists<Real>(scene, rays, {64, {}, {}, true});
      CheckLists<Real>(scene, rays, {3, {}, {}, true});
      CheckLists<Real>(scene, rays, {3, {}, {}, false});
      CheckLists<Real>(scene, rays, {1, {}, {}, false});
      CheckLists<Real>(scene, rays, {0, {}, {}, true});
    }
  }
}

TEST_CASE_TEMPLATE("lists of rays that go together are no others", Real, float, double) {
  Random random(12);
  Scene scene = RandomScene(random, 400);
  AddDisks(random, scene);
  std::vector<scalar::Ray<Real>> rays;
  for (int i = 0; i < 1200; ++i) {
    scalar::Ray<Real> ray;
    ray.origin = {-9, Real(i % 3), Real(0.5)};
    ray.direction = {1, static_cast<Real>(i % 37) / 100, static_cast<Real>(i / 37) / 80};
    if (i % 5 == 0) ray.t_max = static_cast<Real>(Uniform(random, 0, 12));
    if (i % 7 == 0) ray.source = static_cast<std::uint32_t>(random() % 440);
    rays.push_back(ray);
  }
  for (const std::uint32_t capacity : {0, 1, 2, 64}) {
    CheckLists<Real>(scene, rays, {capacity, {}, {}, true});
    if (capacity > 0) CheckLists<Real>(scene, rays, {capacity, {}, {}, false});
  }
}

TEST_CASE_TEMPLATE("masks and exclusions rule hits out, and a list goes on after a hit", Real,
                   float, double) {
  Random random(7);
  Scene scene = RandomScene(random, 300);
  AddDisks(random, scene);
  const auto primitives = static_cast<std::uint32_t>(scene.objects.size());
  const auto rays = RandomRays<Real>(random, 500, primitives);
  std::vector<std::uint32_t> first, object_mask, ray_mask, excluded;
  // Object 1 is empty, the others have seven primitives each.
  for (std::uint32_t id = 0; id < primitives; id += 7) {
    first.push_back(id);
    if (id == 0) first.push_back(0);
  }
  std::swap(first[0], first[1]);
  first.push_back(primitives);
  for (std::size_t k = 0; k + 1 < first.size(); ++k) {
    object_mask.push_back(static_cast<std::uint32_t>(random()) & 7u);
  }
  for (std::size_t i = 0; i < rays.size(); ++i) {
    ray_mask.push_back(static_cast<std::uint32_t>(random()) & 7u);
    for (int k = 0; k < 5; ++k) {
      excluded.push_back(static_cast<std::uint32_t>(random() % primitives));
    }
  }
  HitRuleView rules;
  rules.object_mask = object_mask.data();
  rules.first = first.data();
  rules.object_count = static_cast<std::uint32_t>(object_mask.size());
  rules.ray_mask = ray_mask.data();
  rules.excluded = excluded.data();
  rules.excluded_count = 5;
  CheckLists<Real>(scene, rays, {64, rules, {}, true});
  CheckLists<Real>(scene, rays, {2, rules, {}, false});

  // Two lists of three, one after the other, are one list of six.
  const CompiledScene<Real> compiled = CompileScene<Real>(scene);
  Lists<Real> six(rays.size(), 6), three(rays.size(), 3), next(rays.size(), 3);
  std::vector<ListedHit<Real>> after;
  std::size_t wrong = 0, seen = 0;
  for (std::uint32_t i = 0; i < rays.size(); ++i) {
    scalar::ListHits(compiled.geometry(), rays[i], i, rules, six.output);
    scalar::ListHits(compiled.geometry(), rays[i], i, rules, three.output);
    after.push_back(three.listed[i] < 3 ? ListedHit<Real>{kDefaultTMax<Real>, kNoPrimitive, 1, 0}
                                        : three.hits[3 * i + 2]);
  }
  CheckLists<Real>(scene, rays, {3, rules, after, false});
  next.output.after = after.data();
  for (std::uint32_t i = 0; i < rays.size(); ++i) {
    scalar::ListHits(compiled.geometry(), rays[i], i, rules, next.output);
    if (three.listed[i] < 3) continue;
    seen += next.listed[i];
    wrong += six.listed[i] != 3 + next.listed[i];
    for (std::size_t k = 0; k < next.listed[i]; ++k) {
      wrong += !Same(six.hits[6 * i + 3 + k], next.hits[3 * i + k]);
    }
  }
  CHECK(wrong == 0);
  CHECK(seen > 50);
}

TEST_CASE("a sphere is entered and left, a tie goes to the lowest primitive") {
  Scene scene;
  scene.materials.push_back({});
  Object object;
  object.shape = Sphere{{0, 0, 5}, 1};
  scene.objects.push_back(object);
  object.shape = Triangle{{Vec3d(-1, -1, 4), Vec3d(1, -1, 4), Vec3d(0, 2, 4)}};
  scene.objects.push_back(object);
  scene.objects.push_back(object);
  const CompiledScene<float> compiled = CompileScene<float>(scene);
  Lists<float> lists(1, 8);
  scalar::Ray<float> ray{{0, 0, 0}, {0, 0, 1}};
  scalar::ListHits(compiled.geometry(), ray, 0, {}, lists.output);
  REQUIRE(lists.listed[0] == 4);
  CHECK(lists.total[0] == 4);
  const std::uint32_t primitive[] = {0, 1, 2, 0};
  const float t[] = {4, 4, 4, 6};
  for (std::size_t k = 0; k < 4; ++k) {
    CHECK(lists.hits[k].primitive == primitive[k]);
    CHECK(lists.hits[k].t == t[k]);
  }
  CHECK(lists.hits[3].u == 1);
}

}  // namespace
}  // namespace sheaf
