// Queries of the C API beside those of C++: the same results to the bit, and every error a status.
#include <doctest/doctest.h>

#include <cstddef>
#include <cstdint>
#include <vector>

#include "random_rays.h"
#include "sheaf/capi.h"
#include "sheaf/queries.h"
#include "tests/c_handles.h"

namespace sheaf {
namespace {

// The same objects for both languages.
struct Both {
  Random random{11};
  RandomObjects<float> objects{random, 60};
  Geometry geometry = Geometry::Build(objects.Input()).value();
  GeometryOwner in_c;
  RayLists<float> lists;
  sheaf_rays rays = SHEAF_RAYS_INIT;
  sheaf_trace_options options = SHEAF_TRACE_OPTIONS_INIT;
  RuledTraceOptions expected_options;

  Both() {
    InputOwner input;
    REQUIRE(sheaf_geometry_input_create(&input.handle) == SHEAF_OK);
    sheaf_triangles mesh = SHEAF_TRIANGLES_INIT;
    mesh.indices = objects.indices.data();
    mesh.triangle_count = objects.indices.size() / 3;
    mesh.vertex_count = objects.vertices.size() / 3;
    REQUIRE(sheaf_add_spheres(input.handle, objects.spheres.data(), 60, 0, nullptr) == SHEAF_OK);
    mesh.vertices = objects.vertices.data();
    REQUIRE(sheaf_add_triangles(input.handle, &mesh, nullptr) == SHEAF_OK);
    REQUIRE(sheaf_add_disks(input.handle, objects.disks.data(), 60, 0, nullptr) == SHEAF_OK);
    mesh.vertices = objects.bare.data();
    REQUIRE(sheaf_add_triangles(input.handle, &mesh, nullptr) == SHEAF_OK);
    REQUIRE(sheaf_geometry_build(input.handle, nullptr, &in_c.handle) == SHEAF_OK);
    for (int i = 0; i < 400; ++i) lists.Add(RandomRay<float>(random, 240));
    PointAt(lists.view(), lists.size(), rays);
    options.t_min = lists.t_min.data();
    options.t_max = lists.t_max.data();
    expected_options.interval = lists.interval();
  }
};

sheaf_hits InC(HitLists<float>& hits) {
  sheaf_hits in_c = SHEAF_HITS_INIT;
  in_c.t = hits.t.data();
  in_c.primitive = hits.primitive.data();
  in_c.object = hits.object.data();
  in_c.u = hits.u.data();
  in_c.v = hits.v.data();
  return in_c;
}

bool Same(const HitLists<float>& a, const HitLists<float>& b) {
  for (std::size_t i = 0; i < a.t.size(); ++i) {
    const bool same_t = a.t[i] == b.t[i] || (a.t[i] != a.t[i] && b.t[i] != b.t[i]);
    if (!same_t || a.primitive[i] != b.primitive[i] || a.object[i] != b.object[i] ||
        a.u[i] != b.u[i] || a.v[i] != b.v[i]) {
      return false;
    }
  }
  return true;
}

TEST_CASE("all hits") {
  Both both;
  const std::size_t count = both.lists.size();
  HitLists<float> expected(3 * count), got(3 * count);
  std::vector<std::uint32_t> listed(count), total(count), in_c_listed(count), in_c_total(count);
  REQUIRE(TraceAll(both.geometry, both.lists.view(), count,
                   {3, expected.view(), listed.data(), total.data()}, both.expected_options));
  const sheaf_hits arrays = InC(got);
  sheaf_all_hits all = SHEAF_ALL_HITS_INIT;
  all.capacity = 3;
  all.hits = &arrays;
  all.listed = in_c_listed.data();
  all.total = in_c_total.data();
  REQUIRE(sheaf_trace_all(both.in_c.handle, &both.rays, &all, &both.options, nullptr) == SHEAF_OK);
  CHECK(Same(expected, got));
  CHECK(listed == in_c_listed);
  CHECK(total == in_c_total);
  CHECK(sheaf_trace_all(both.in_c.handle, &both.rays, nullptr, nullptr, nullptr) == SHEAF_USAGE);
  CHECK(Says("hits is NULL"));
}

TEST_CASE("rules and filters") {
  Both both;
  const std::size_t count = both.lists.size();
  const std::vector<std::uint32_t> masks = {1, 2, 3, 0};
  std::vector<std::uint32_t> of_rays, excluded;
  for (std::uint32_t i = 0; i < count; ++i) {
    of_rays.push_back(i % 4);
    excluded.insert(excluded.end(), {i % 240, 7 * i % 240});
  }
  sheaf_hit_rules rules = SHEAF_HIT_RULES_INIT;
  rules.object_mask = masks.data();
  rules.ray_mask = of_rays.data();
  rules.excluded = excluded.data();
  rules.excluded_per_ray = 2;
  both.expected_options.rules = {masks.data(), of_rays.data(), 0, excluded.data(), 2};
  const sheaf_hit_filter every_other = [](const sheaf_candidates* hits, std::uint8_t* accepted,
                                          void* calls) {
    ++*static_cast<int*>(calls);
    for (std::size_t k = 0; k < hits->count; ++k) accepted[k] = hits->primitive[k] % 2;
  };
  const HitFilter expected_filter = [](const CandidateHits& hits, std::uint8_t* accepted) {
    for (std::size_t k = 0; k < hits.count; ++k) accepted[k] = hits.primitive[k] % 2;
  };
  for (const bool is_filtered : {false, true}) {
    int calls = 0;
    HitLists<float> expected(count), got(count);
    std::vector<std::uint32_t> occluded(count), got_occluded(count);
    const HitFilter chosen = is_filtered ? expected_filter : nullptr;
    REQUIRE(TraceRuledClosest(both.geometry, both.lists.view(), count, expected.view(),
                              both.expected_options, chosen));
    REQUIRE(TraceRuledOccluded(both.geometry, both.lists.view(), count, occluded.data(),
                               both.expected_options, chosen));
    const sheaf_hits arrays = InC(got);
    const sheaf_hit_filter filter = is_filtered ? every_other : nullptr;
    REQUIRE(sheaf_trace_ruled_closest(both.in_c.handle, &both.rays, &arrays, &both.options, &rules,
                                      filter, &calls) == SHEAF_OK);
    REQUIRE(sheaf_trace_ruled_occluded(both.in_c.handle, &both.rays, got_occluded.data(),
                                       &both.options, &rules, filter, &calls) == SHEAF_OK);
    CHECK(Same(expected, got));
    CHECK(occluded == got_occluded);
    CHECK((calls > 0) == is_filtered);
  }
  rules.excluded = nullptr;
  CHECK(sheaf_trace_ruled_occluded(both.in_c.handle, &both.rays, of_rays.data(), nullptr, &rules,
                                   nullptr, nullptr) == SHEAF_USAGE);
  CHECK(Says("excluded is null"));
}

TEST_CASE("places") {
  Both both;
  const sheaf_geometry* const geometry = both.in_c.handle;
  const std::vector<float>& x = both.objects.vertices;  // rows of three numbers
  constexpr std::size_t kCount = 180, kRow = 3 * sizeof(float);
  const PointArrays points = {&x[0], &x[1], &x[2], kRow};
  sheaf_points in_c = SHEAF_POINTS_INIT;
  in_c.count = kCount;
  in_c.x = &x[0], in_c.y = &x[1], in_c.z = &x[2];
  in_c.stride = kRow;
  std::vector<std::uint32_t> expected(kCount), got(kCount);

  REQUIRE(CountCrossings(both.geometry, both.lists.view(), kCount, expected.data(),
                         both.expected_options));
  both.rays.count = kCount;
  REQUIRE(sheaf_count_crossings(geometry, &both.rays, got.data(), &both.options, nullptr) ==
          SHEAF_OK);
  CHECK(expected == got);
  REQUIRE(FindInside(both.geometry, points, kCount, expected.data()));
  REQUIRE(sheaf_find_inside(geometry, &in_c, got.data(), nullptr, "scalar") == SHEAF_OK);
  CHECK(expected == got);
  CHECK(sheaf_find_inside(geometry, &in_c, got.data(), nullptr, "none") == SHEAF_USAGE);
  CHECK(Says("this processor has"));

  std::vector<float> distance(kCount), got_distance(kCount), y(kCount), got_y(kCount);
  sheaf_nearest nearest = SHEAF_NEAREST_INIT;
  nearest.distance = got_distance.data();
  nearest.primitive = got.data();
  nearest.position[1] = got_y.data();
  const NearestArrays arrays = {
      distance.data(), expected.data(), nullptr, {nullptr, y.data(), nullptr}};
  sheaf_nearest_options options = SHEAF_NEAREST_OPTIONS_INIT;
  options.is_signed = 1;
  options.all_max_distance = 0.25f;
  const std::vector<std::uint32_t> masks = {1, 0, 1, 1};
  sheaf_hit_rules rules = SHEAF_HIT_RULES_INIT;
  rules.object_mask = masks.data();
  REQUIRE(FindNearest(both.geometry, points, kCount, arrays,
                      {.all_max_distance = 0.25f,
                       .rules = {.object_mask = masks.data()},
                       .sign = DistanceSign::kInside}));
  REQUIRE(sheaf_find_nearest(geometry, &in_c, &nearest, &options, &rules) == SHEAF_OK);
  CHECK(expected == got);
  CHECK(distance == got_distance);
  CHECK(y == got_y);
  CHECK(sheaf_find_nearest(geometry, nullptr, &nearest, nullptr, nullptr) == SHEAF_USAGE);
  CHECK(Says("points is NULL"));

  std::vector<std::uint32_t> ids(4 * kCount), got_ids(4 * kCount);
  const OverlapLists lists = {4, ids.data(), nullptr, expected.data()};
  sheaf_overlaps overlaps = SHEAF_OVERLAPS_INIT;
  overlaps.capacity = 4;
  overlaps.primitive = got_ids.data();
  overlaps.total = got.data();
  std::vector<float> radius(3 * kCount, 0.75f);
  REQUIRE(FindInBalls(both.geometry, points, radius.data(), kCount, lists));
  REQUIRE(sheaf_find_in_balls(geometry, &in_c, radius.data(), &overlaps) == SHEAF_OK);
  CHECK(ids == got_ids);
  CHECK(expected == got);
  std::vector<float> corner = x;
  for (float& c : corner) c += 0.5f;
  sheaf_points upper = in_c;
  upper.x = &corner[0], upper.y = &corner[1], upper.z = &corner[2];
  REQUIRE(FindInBoxes(both.geometry,
                      BoxArrays{{&x[0], &x[1], &x[2]}, {&corner[0], &corner[1], &corner[2]}, kRow},
                      kCount, lists));
  REQUIRE(sheaf_find_in_boxes(geometry, &in_c, &upper, &overlaps) == SHEAF_OK);
  CHECK(ids == got_ids);
  CHECK(expected == got);
  upper.count = 1;
  CHECK(sheaf_find_in_boxes(geometry, &in_c, &upper, &overlaps) == SHEAF_USAGE);
}

}  // namespace
}  // namespace sheaf
