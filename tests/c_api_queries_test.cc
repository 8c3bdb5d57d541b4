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
    const RayArrays view = lists.view();
    rays.count = lists.size();
    rays.origin_x = view.origin_x, rays.origin_y = view.origin_y, rays.origin_z = view.origin_z;
    rays.direction_x = view.direction_x, rays.direction_y = view.direction_y;
    rays.direction_z = view.direction_z;
    rays.source = view.source;
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

}  // namespace
}  // namespace sheaf
