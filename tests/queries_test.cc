// All hits, masks, exclusions and filters as a user of the library asks for them.
#include "sheaf/queries.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "bits.h"
#include "random_rays.h"
#include "random_scene.h"
#include "src/bvh/geometry_access.h"
#include "src/scalar/trace_all.h"
#include "targets.h"

namespace sheaf {
namespace {

// A geometry, rays, and every hit of each by brute force.
template <typename Real>
struct World {
  RandomObjects<Real> objects;
  GeometryOf<Real> geometry;
  RayLists<Real> rays;
  std::vector<std::vector<ListedHit<Real>>> hits;

  World(std::uint64_t seed, std::uint32_t primitives, std::size_t count)
      : World(Random(seed), primitives, count) {}
  World(Random random, std::uint32_t primitives, std::size_t count) : objects(random, primitives) {
    const GeometryInput input = objects.Input();
    geometry = std::move(GeometryOf<Real>::Build(input)).value();
    const FlatInputOf<Real> flat = GeometryAccess::FlattenTo<Real>(input, {}).value();
    const GeometryView<Real> view = flat.arrays.view();
    for (std::size_t i = 0; i < count; ++i) {
      const auto ray = RandomRay<Real>(random, 4 * primitives);
      rays.Add(ray);
      std::vector<ListedHit<Real>> list(2000);
      std::uint32_t listed = 0;
      const HitListOutput<Real> output = {list.data(), 2000, &listed, nullptr};
      scalar::ListHits(view, ray, 0, {}, output);
      list.resize(listed);
      hits.push_back(list);
    }
  }
  RuledTraceOptionsOf<Real> options(Target target = {}) const {
    return {.interval = rays.interval(), .target = target};
  }
};

template <typename Real>
bool IsHit(HitLists<Real>& hits, std::size_t at, const ListedHit<Real>& want,
           const GeometryOf<Real>& geometry) {
  return SameBits(hits.t[at], want.t) && hits.primitive[at] == want.primitive &&
         SameBits(hits.u[at], want.u) && SameBits(hits.v[at], want.v) &&
         hits.object[at] == geometry.object_of(want.primitive);
}

template <typename Real>
void CheckAll(World<Real>& world, Target target, std::uint32_t capacity) {
  const std::size_t count = world.rays.size();
  HitLists<Real> hits(count * capacity);
  std::vector<std::uint32_t> listed(count), total(count);
  const AllHitsOf<Real> into = {capacity, hits.view(), listed.data(), total.data()};
  REQUIRE(TraceAll(world.geometry, world.rays.view(), count, into, world.options(target)));
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const auto& want = world.hits[i];
    wrong += total[i] != want.size();
    wrong += listed[i] != std::min<std::size_t>(want.size(), capacity);
    // The element after the last is a miss.
    for (std::size_t k = 0; k < capacity && k <= listed[i]; ++k) {
      const std::size_t at = i * capacity + k;
      wrong += k < listed[i] ? !IsHit(hits, at, want[k], world.geometry)
                             : hits.primitive[at] != kNoPrimitive || hits.u[at] != 0 ||
                                   hits.object[at] != kNoPrimitive;
    }
  }
  CHECK(wrong == 0);
}

TEST_CASE_TEMPLATE("all hits are those of every primitive in turn", Real, float, double) {
  World<Real> world(3, 150, 700);
  std::size_t most = 0;
  for (const auto& list : world.hits) most = std::max(most, list.size());
  CHECK(most > 8);
  ForEachTarget([&](Target target) {
    for (const std::uint32_t capacity : {0, 1, 4, 64}) CheckAll(world, target, capacity);
  });
  CheckAll(world, *Target::Named("scalar"), 4);
}

TEST_CASE("what is not wanted is not written, and structures are as good as arrays") {
  World<float> world(4, 80, 300);
  const std::size_t count = world.rays.size();
  struct Row {
    float t, u, v;
    std::uint32_t primitive, object, filler;
  };
  std::vector<Row> rows(3 * count, {0, 0, 0, 0, 0, 77});
  AllHits into = {.capacity = 3};
  into.hits = {&rows[0].t, &rows[0].primitive, nullptr, &rows[0].u, &rows[0].v, sizeof(Row)};
  REQUIRE(TraceAll(world.geometry, world.rays.view(), count, into, world.options()));
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Row& row = rows[3 * i + k];
      const auto& want = world.hits[i];
      if (k > want.size()) continue;
      wrong += row.filler != 77 || row.object != 0;
      wrong += k < want.size() ? !SameBits(row.t, want[k].t) || row.primitive != want[k].primitive
                               : row.primitive != kNoPrimitive;
    }
  }
  CHECK(wrong == 0);
}

TEST_CASE("runs have no limit but the one that is asked for") {
  World<float> world(12, 400, 300);
  const std::size_t count = world.rays.size();
  std::size_t longest = 0;
  for (const std::uint32_t most : {0xffffffffu, 0u, 1u, 33u}) {
    const auto runs =
        ListAllHits(world.geometry, world.rays.view(), count, world.options(), most).value();
    REQUIRE(runs.first.size() == count + 1);
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const auto& want = world.hits[i];
      const std::size_t first = runs.first[i], size = runs.first[i + 1] - first;
      longest = std::max(longest, size);
      wrong += size != std::min<std::size_t>(want.size(), most);
      for (std::size_t k = 0; k < size && k < want.size(); ++k) {
        wrong += !SameBits(runs.t[first + k], want[k].t) ||
                 runs.primitive[first + k] != want[k].primitive ||
                 !SameBits(runs.u[first + k], want[k].u);
      }
    }
    CHECK(wrong == 0);
  }
  CHECK(longest > 64);
}

// Rules, and what they admit.
struct RandomRules {
  std::vector<std::uint32_t> object_mask, ray_mask, excluded;

  RandomRules(Random& random, std::size_t rays, std::uint32_t primitives) {
    for (int k = 0; k < 4; ++k) object_mask.push_back(static_cast<std::uint32_t>(random()) & 7u);
    for (std::size_t i = 0; i < rays; ++i) {
      ray_mask.push_back(static_cast<std::uint32_t>(random()) & 7u);
      for (int k = 0; k < 3; ++k) {
        excluded.push_back(static_cast<std::uint32_t>(random() % primitives));
      }
    }
  }
  HitRules view() const {
    return {.object_mask = object_mask.data(),
            .ray_mask = ray_mask.data(),
            .excluded = excluded.data(),
            .excluded_per_ray = 3};
  }
  bool Admits(std::size_t ray, std::uint32_t primitive, std::uint32_t object) const {
    if ((object_mask[object] & ray_mask[ray]) == 0) return false;
    const auto* first = excluded.data() + 3 * ray;
    return std::find(first, first + 3, primitive) == first + 3;
  }
};

// Which hits a filter of the tests accepts.
template <typename Real>
bool Accepts(std::size_t ray, std::uint32_t primitive, Real u) {
  return (ray * 7 + primitive * 13 + (u > Real(0.5))) % 5 == 0;
}

enum class Filter { kNone, kSome };

template <typename Real>
void CheckFirst(World<Real>& world, const RandomRules* rules, Filter filter, Target target) {
  const std::size_t count = world.rays.size();
  auto options = world.options(target);
  if (rules) options.rules = rules->view();
  std::size_t asked_twice = 0, disordered = 0;
  std::vector<std::vector<std::pair<std::uint32_t, Real>>> asked(count);
  const HitFilterOf<Real> some = [&](const CandidateHitsOf<Real>& hits, std::uint8_t* accepted) {
    for (std::size_t k = 0; k < hits.count; ++k) {
      auto& before = asked[hits.ray[k]];
      const std::pair<std::uint32_t, Real> hit = {hits.primitive[k], hits.u[k]};
      asked_twice += std::find(before.begin(), before.end(), hit) != before.end();
      before.push_back(hit);
      disordered += k > 0 && hits.ray[k] == hits.ray[k - 1] && hits.t[k] < hits.t[k - 1];
      accepted[k] = Accepts(hits.ray[k], hits.primitive[k], hits.u[k]);
    }
  };
  const HitFilterOf<Real> chosen = filter == Filter::kSome ? some : nullptr;
  HitLists<Real> hits(count);
  std::vector<std::uint32_t> occluded(count, 9);
  REQUIRE(
      TraceRuledClosest(world.geometry, world.rays.view(), count, hits.view(), options, chosen));
  asked.assign(count, {});
  REQUIRE(TraceRuledOccluded(world.geometry, world.rays.view(), count, occluded.data(), options,
                             chosen));
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const auto& all = world.hits[i];
    const auto want = std::find_if(all.begin(), all.end(), [&](const ListedHit<Real>& hit) {
      const std::uint32_t object = world.geometry.object_of(hit.primitive);
      return (!rules || rules->Admits(i, hit.primitive, object)) &&
             (filter == Filter::kNone || Accepts(i, hit.primitive, hit.u));
    });
    const bool is_hit = want != all.end();
    wrong += is_hit ? !IsHit(hits, i, *want, world.geometry) : hits.primitive[i] != kNoPrimitive;
    wrong += occluded[i] != (is_hit ? 1u : 0u);
  }
  CHECK(wrong == 0);
  CHECK(asked_twice == 0);
  CHECK(disordered == 0);
}

TEST_CASE_TEMPLATE("rules and filters leave the nearest of what they admit", Real, float, double) {
  World<Real> world(5, 150, 600);
  Random random(6);
  const RandomRules rules(random, world.rays.size(), 600);
  ForEachTarget([&](Target target) {
    for (const Filter filter : {Filter::kNone, Filter::kSome}) {
      CheckFirst<Real>(world, nullptr, filter, target);
      CheckFirst(world, &rules, filter, target);
    }
  });
}

TEST_CASE("one mask for all rays, and what is wrong is named") {
  World<float> world(8, 40, 200);
  const std::size_t count = world.rays.size();
  const std::vector<std::uint32_t> masks = {1, 2, 4, 8};
  RuledTraceOptions options = world.options();
  options.rules.object_mask = masks.data();
  options.rules.all_ray_mask = 2 | 8;
  HitLists<float> hits(count);
  REQUIRE(TraceRuledClosest(world.geometry, world.rays.view(), count, hits.view(), options));
  std::size_t seen[4] = {}, wrong = 0;
  for (std::size_t i = 0; i < count; ++i) {
    if (hits.object[i] == kNoPrimitive) continue;
    ++seen[hits.object[i]];
    wrong += hits.object[i] % 2 == 0;
  }
  CHECK(wrong == 0);
  CHECK(seen[1] > 0);
  CHECK(seen[3] > 0);

  options.rules.excluded_per_ray = 2;
  const Status failed =
      TraceRuledClosest(world.geometry, world.rays.view(), count, hits.view(), options);
  REQUIRE(!failed);
  CHECK(failed.error().message == "excluded is null");
  CHECK(failed.error().kind == ErrorKind::kUsage);
  RayArrays none;
  CHECK(TraceAll(world.geometry, none, 1, {}).error().message == "origin_x is null");
  CHECK(TraceAll(world.geometry, none, 0, {}).ok());
  CHECK(TraceRuledOccluded(world.geometry, world.rays.view(), 1, nullptr, {}).error().message ==
        "occluded is null");
}

TEST_CASE("a geometry without objects has no hits") {
  const Geometry empty;
  World<float> world(9, 2, 5);
  std::uint32_t listed[5] = {9, 9, 9, 9, 9}, total[5] = {9, 9, 9, 9, 9};
  REQUIRE(TraceAll(empty, world.rays.view(), 5, {.listed = listed, .total = total}));
  for (int i = 0; i < 5; ++i) CHECK(listed[i] + total[i] == 0);
}

}  // namespace
}  // namespace sheaf
