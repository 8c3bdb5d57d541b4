// Instances of the C API beside those of C++: the same hits to the bit, and every error a status.
#include <doctest/doctest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <memory>
#include <vector>

#include "random_rays.h"
#include "sheaf/capi.h"
#include "sheaf/instances.h"
#include "tests/c_handles.h"

namespace sheaf {
namespace {

using InstancesOwner = Owner<sheaf_instances, sheaf_instances_destroy>;

void Build(const std::vector<float>& spheres, GeometryOwner& in_c) {
  InputOwner input;
  REQUIRE(sheaf_geometry_input_create(&input.handle) == SHEAF_OK);
  REQUIRE(sheaf_add_spheres(input.handle, spheres.data(), spheres.size() / 4, 0, nullptr) ==
          SHEAF_OK);
  REQUIRE(sheaf_geometry_build(input.handle, nullptr, &in_c.handle) == SHEAF_OK);
}

std::shared_ptr<const Geometry> Build(const std::vector<float>& spheres) {
  GeometryInput input;
  input.AddSpheres(spheres);
  return std::make_shared<Geometry>(Geometry::Build(input).value());
}

// Two geometries in seven places, turned, scaled and mirrored.
struct Both {
  Random random{13};
  std::vector<float> few = RandomObjects<float>(random, 5).spheres,
                     many = RandomObjects<float>(random, 30).spheres;
  std::vector<Place> places;
  std::vector<sheaf_place> places_in_c;
  Instances instances;
  InstancesOwner in_c;
  RayLists<float> lists;
  std::vector<std::uint32_t> source_instance;
  sheaf_rays rays = SHEAF_RAYS_INIT;

  Both() {
    for (std::uint32_t i = 0; i < 7; ++i) {
      const double size = 0.5 + 0.1 * i, side = i % 2 == 0 ? 1 : -1;
      places.push_back(
          {i % 2, {0, -size, 0, 2.0 * i - 6, side * size, 0, 0, 0.5 * i, 0, 0.1, size, 0.25 * i}});
      sheaf_place place = {i % 2, 0, {}};
      std::ranges::copy(places.back().to_world, place.to_world);
      places_in_c.push_back(place);
    }
    const std::shared_ptr<const Geometry> shared[] = {Build(few), Build(many)};
    instances = Instances::Build(shared, places).value();
    {  // the handles may go before the instances
      GeometryOwner owners[2];
      Build(few, owners[0]);
      Build(many, owners[1]);
      const sheaf_geometry* const handles[] = {owners[0].handle, owners[1].handle};
      REQUIRE(sheaf_instances_build(handles, 2, places_in_c.data(), places_in_c.size(), 1,
                                    &in_c.handle) == SHEAF_OK);
    }
    for (std::uint32_t i = 0; i < 500; ++i) {
      scalar::Ray<float> ray = RandomRay<float>(random, 5);
      ray.t_min = 1e-4f;
      ray.t_max = 1e3f;
      lists.Add(ray);
      source_instance.push_back(i % 3 == 0 ? i % 7 : SHEAF_NO_INSTANCE);
    }
    PointAt(lists.view(), lists.size(), rays);
  }
};

TEST_CASE("nearest hits") {
  const Both both;
  const std::size_t count = both.lists.size();
  HitLists<float> expected(count), got(count);
  std::vector<std::uint32_t> instance(count), instance_in_c(count);
  REQUIRE(TraceClosest(both.instances, both.lists.view(), count, expected.view(), instance.data(),
                       {}, {both.source_instance.data()}));
  sheaf_hits into = SHEAF_HITS_INIT;
  into.t = got.t.data();
  into.primitive = got.primitive.data();
  into.object = got.object.data();
  into.u = got.u.data();
  into.v = got.v.data();
  REQUIRE(sheaf_instances_trace_closest(both.in_c.handle, &both.rays, both.source_instance.data(),
                                        &into, instance_in_c.data(), nullptr) == SHEAF_OK);
  CHECK(expected.t == got.t);
  CHECK(expected.primitive == got.primitive);
  CHECK(expected.object == got.object);
  CHECK(expected.u == got.u);
  CHECK(expected.v == got.v);
  CHECK(instance == instance_in_c);
  const auto hit = [](std::uint32_t i) { return i != SHEAF_NO_INSTANCE; };
  CHECK(std::ranges::count_if(instance, hit) > 50);
  CHECK(std::ranges::count_if(instance, hit) < static_cast<std::ptrdiff_t>(count));
}

TEST_CASE("occlusion") {
  const Both both;
  const std::size_t count = both.lists.size();
  std::vector<std::uint32_t> expected(count), got(count, 7);
  REQUIRE(TraceOccluded(both.instances, both.lists.view(), count, expected.data(), {},
                        {both.source_instance.data()}));
  REQUIRE(sheaf_instances_trace_occluded(both.in_c.handle, &both.rays, both.source_instance.data(),
                                         got.data(), nullptr) == SHEAF_OK);
  CHECK(expected == got);
}

TEST_CASE("statistics") {
  const Both both;
  sheaf_instance_statistics statistics = SHEAF_INSTANCE_STATISTICS_INIT;
  REQUIRE(sheaf_instances_get_statistics(both.in_c.handle, &statistics) == SHEAF_OK);
  CHECK(statistics.instances == 7);
  CHECK(statistics.geometries == 2);
  CHECK(statistics.bytes == both.instances.statistics().bytes);
  CHECK(statistics.lower[0] == both.instances.lower()[0]);
  CHECK(statistics.upper[2] == both.instances.upper()[2]);
}

TEST_CASE("a geometry that stands in instances is not updated") {
  const std::vector<float> sphere = {0, 0, 0, 1};
  InputOwner input;
  GeometryOwner geometry;
  REQUIRE(sheaf_geometry_input_create(&input.handle) == SHEAF_OK);
  REQUIRE(sheaf_add_spheres(input.handle, sphere.data(), 1, 0, nullptr) == SHEAF_OK);
  REQUIRE(sheaf_geometry_build(input.handle, nullptr, &geometry.handle) == SHEAF_OK);
  const sheaf_geometry* const handles[] = {geometry.handle};
  const sheaf_place place = {0, 0, {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}};
  {
    InstancesOwner instances;
    REQUIRE(sheaf_instances_build(handles, 1, &place, 1, 0, &instances.handle) == SHEAF_OK);
    CHECK(sheaf_geometry_update(geometry.handle, input.handle, nullptr, nullptr) == SHEAF_USAGE);
    CHECK(Says("stands in instances"));
  }
  CHECK(sheaf_geometry_update(geometry.handle, input.handle, nullptr, nullptr) == SHEAF_OK);
}

TEST_CASE("what does not fit is named") {
  InstancesOwner made;
  sheaf_place place = {0, 0, {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}};
  const sheaf_geometry* const none[] = {nullptr};
  CHECK(sheaf_instances_build(none, 1, &place, 1, 0, nullptr) == SHEAF_USAGE);
  CHECK(Says("instances is NULL"));
  CHECK(sheaf_instances_build(none, 1, &place, 1, 0, &made.handle) == SHEAF_USAGE);
  CHECK(made.handle == nullptr);
  CHECK(sheaf_instances_build(nullptr, 1, &place, 1, 0, &made.handle) == SHEAF_USAGE);
  CHECK(Says("geometries is NULL"));
  CHECK(sheaf_instances_build(nullptr, 0, nullptr, 1, 0, &made.handle) == SHEAF_USAGE);
  CHECK(Says("places is NULL"));
  CHECK(sheaf_instances_build(nullptr, 0, nullptr, 0, -1, &made.handle) == SHEAF_USAGE);
  CHECK(Says("threads"));
  place.reserved = 1;
  CHECK(sheaf_instances_build(nullptr, 0, &place, 1, 0, &made.handle) == SHEAF_USAGE);
  CHECK(Says("place 0: reserved"));
  place.reserved = 0;
  CHECK(sheaf_instances_build(nullptr, 0, &place, 1, 0, &made.handle) == SHEAF_USAGE);
  std::uint32_t occluded = 7;
  sheaf_rays rays = SHEAF_RAYS_INIT;
  CHECK(sheaf_instances_trace_occluded(nullptr, &rays, nullptr, &occluded, nullptr) == SHEAF_USAGE);
  CHECK(Says("instances is NULL"));
  // Without places every ray misses.
  REQUIRE(sheaf_instances_build(nullptr, 0, nullptr, 0, 0, &made.handle) == SHEAF_OK);
  const float zero = 0, one = 1;
  rays.count = 1;
  rays.origin_x = rays.origin_y = rays.origin_z = &zero;
  rays.direction_x = rays.direction_y = rays.direction_z = &one;
  REQUIRE(sheaf_instances_trace_occluded(made.handle, &rays, nullptr, &occluded, nullptr) ==
          SHEAF_OK);
  CHECK(occluded == 0);
}

}  // namespace
}  // namespace sheaf
