// Geometries of doubles, and geometries in files, of the C API beside those of C++: the same hits
// to the bit, and every error a status.
#include <doctest/doctest.h>

#include <cstddef>
#include <cstdint>
#include <vector>

#include "random_rays.h"
#include "sheaf/capi.h"
#include "sheaf/geometry.h"
#include "tests/c_handles.h"
#include "tests/folder.h"

namespace sheaf {
namespace {

using GeometryDOwner = Owner<sheaf_geometry_d, sheaf_geometry_destroy_d>;

// The same objects of doubles for both languages, no coordinate of which is a float.
struct Both {
  Random random{12};
  RandomObjects<double> objects{random, 60};
  GeometryD geometry;
  InputOwner input;
  GeometryDOwner in_c;
  RayLists<double> lists;
  sheaf_rays_d rays = SHEAF_RAYS_D_INIT;
  sheaf_trace_options_d options = SHEAF_TRACE_OPTIONS_D_INIT;

  Both() {
    for (double& number : objects.vertices) number *= 1.1;
    geometry = GeometryD::Build(objects.Input()).value();
    REQUIRE(sheaf_geometry_input_create(&input.handle) == SHEAF_OK);
    REQUIRE(sheaf_add_spheres_d(input.handle, objects.spheres.data(), 60, 0, nullptr) == SHEAF_OK);
    sheaf_triangles_d mesh = SHEAF_TRIANGLES_D_INIT;
    mesh.indices = objects.indices.data();
    mesh.triangle_count = objects.indices.size() / 3;
    mesh.vertex_count = objects.vertices.size() / 3;
    mesh.vertices = objects.vertices.data();
    mesh.normals = objects.normals.data();
    REQUIRE(sheaf_add_triangles_d(input.handle, &mesh, nullptr) == SHEAF_OK);
    REQUIRE(sheaf_add_disks_d(input.handle, objects.disks.data(), 60, 0, nullptr) == SHEAF_OK);
    // Of structures: copied when they are added.
    std::vector<double> apart;
    for (std::size_t i = 0; i < objects.bare.size(); i += 3) {
      apart.insert(apart.end(), {objects.bare[i], objects.bare[i + 1], objects.bare[i + 2], 99});
    }
    mesh.vertices = apart.data();
    mesh.vertex_stride = 4 * sizeof(double);
    mesh.normals = nullptr;
    REQUIRE(sheaf_add_triangles_d(input.handle, &mesh, nullptr) == SHEAF_OK);
    REQUIRE(sheaf_geometry_build_d(input.handle, nullptr, &in_c.handle) == SHEAF_OK);
    for (int i = 0; i < 400; ++i) lists.Add(RandomRay<double>(random, 240));
    PointAt(lists.view(), lists.size(), rays);
    options.t_min = lists.t_min.data();
    options.t_max = lists.t_max.data();
  }
};

// Without t where rays miss: it may be a NaN that was given.
template <typename Real>
bool Same(const HitLists<Real>& a, const HitLists<Real>& b) {
  for (std::size_t i = 0; i < a.t.size(); ++i) {
    if (a.primitive[i] != b.primitive[i] || a.object[i] != b.object[i]) return false;
    if (a.primitive[i] == Geometry::kNoPrimitive) continue;
    if (a.t[i] != b.t[i] || a.u[i] != b.u[i] || a.v[i] != b.v[i]) return false;
  }
  return true;
}

HitLists<double> Closest(const Both& both, const sheaf_geometry_d* geometry) {
  HitLists<double> got(both.lists.size());
  sheaf_hits_d into = SHEAF_HITS_D_INIT;
  into.t = got.t.data();
  into.primitive = got.primitive.data();
  into.object = got.object.data();
  into.u = got.u.data();
  into.v = got.v.data();
  REQUIRE(sheaf_trace_closest_d(geometry, &both.rays, &into, &both.options) == SHEAF_OK);
  return got;
}

TEST_CASE("rays of doubles") {
  const Both both;
  const std::size_t count = both.lists.size();
  HitLists<double> expected(count);
  REQUIRE(TraceClosest(both.geometry, both.lists.view(), count, expected.view(),
                       {.interval = both.lists.interval()}));
  CHECK(Same(expected, Closest(both, both.in_c.handle)));

  std::vector<std::uint32_t> occluded(count), in_c(count, 7);
  REQUIRE(TraceOccluded(both.geometry, both.lists.view(), count, occluded.data(),
                        {.interval = both.lists.interval()}));
  REQUIRE(sheaf_trace_occluded_d(both.in_c.handle, &both.rays, in_c.data(), &both.options) ==
          SHEAF_OK);
  CHECK(occluded == in_c);

  sheaf_geometry_statistics statistics = SHEAF_GEOMETRY_STATISTICS_INIT;
  REQUIRE(sheaf_geometry_get_statistics_d(both.in_c.handle, &statistics) == SHEAF_OK);
  CHECK(statistics.objects == 4);
  CHECK(statistics.spheres == 60);
  std::uint32_t first = 0;
  REQUIRE(sheaf_geometry_first_primitive_d(both.in_c.handle, 2, &first) == SHEAF_OK);
  CHECK(first == both.geometry.first_primitive(2));
  CHECK(first > 60);
}

TEST_CASE("what is moved in doubles is hit where it is") {
  Both both;
  for (double& number : both.objects.vertices) number += 0.01;
  const GeometryD expected_of = GeometryD::Build(both.objects.Input()).value();
  std::int32_t rebuilt = 7;
  REQUIRE(sheaf_geometry_update_d(both.in_c.handle, both.input.handle, nullptr, &rebuilt) ==
          SHEAF_OK);
  CHECK(rebuilt == 0);
  HitLists<double> expected(both.lists.size());
  REQUIRE(TraceClosest(expected_of, both.lists.view(), both.lists.size(), expected.view(),
                       {.interval = both.lists.interval()}));
  CHECK(Same(expected, Closest(both, both.in_c.handle)));
}

TEST_CASE("geometries in files") {
  const Both both;
  const Folder folder;
  const std::string path = folder / "objects.sheaf";
  REQUIRE(sheaf_geometry_save_d(both.in_c.handle, path.c_str()) == SHEAF_OK);
  for (const sheaf_map_check check : {SHEAF_MAP_CHECK_ALL, SHEAF_MAP_CHECK_HEADER}) {
    GeometryDOwner mapped;
    REQUIRE(sheaf_geometry_map_d(path.c_str(), check, &mapped.handle) == SHEAF_OK);
    CHECK(Same(Closest(both, both.in_c.handle), Closest(both, mapped.handle)));
  }
  // The other kind of numbers.
  GeometryOwner floats;
  CHECK(sheaf_geometry_map(path.c_str(), SHEAF_MAP_CHECK_ALL, &floats.handle) ==
        SHEAF_INPUT_OUTPUT);
  CHECK(Says(path));
  CHECK(floats.handle == nullptr);
  REQUIRE(sheaf_geometry_build(both.input.handle, nullptr, &floats.handle) == SHEAF_OK);
  REQUIRE(sheaf_geometry_save(floats.handle, path.c_str()) == SHEAF_OK);
  GeometryOwner mapped;
  REQUIRE(sheaf_geometry_map(path.c_str(), SHEAF_MAP_CHECK_ALL, &mapped.handle) == SHEAF_OK);
  sheaf_geometry_statistics statistics = SHEAF_GEOMETRY_STATISTICS_INIT;
  REQUIRE(sheaf_geometry_get_statistics(mapped.handle, &statistics) == SHEAF_OK);
  CHECK(statistics.disks == 60);
}

TEST_CASE("what does not fit is named") {
  const Both both;
  GeometryDOwner made;
  CHECK(sheaf_geometry_map_d(nullptr, SHEAF_MAP_CHECK_ALL, &made.handle) == SHEAF_USAGE);
  CHECK(Says("path is NULL"));
  CHECK(sheaf_geometry_map_d("/nowhere/at.all", SHEAF_MAP_CHECK_ALL, &made.handle) ==
        SHEAF_INPUT_OUTPUT);
  CHECK(Says("/nowhere/at.all"));
  CHECK(sheaf_geometry_save_d(nullptr, "x") == SHEAF_USAGE);
  CHECK(Says("geometry is NULL"));
  CHECK(sheaf_geometry_save_d(both.in_c.handle, nullptr) == SHEAF_USAGE);
  CHECK(Says("path is NULL"));
  CHECK(sheaf_trace_closest_d(nullptr, &both.rays, nullptr, nullptr) == SHEAF_USAGE);
  CHECK(Says("geometry is NULL"));
  CHECK(sheaf_trace_closest_d(both.in_c.handle, &both.rays, nullptr, nullptr) == SHEAF_USAGE);
  CHECK(Says("hits is NULL"));
  InputOwner input;
  REQUIRE(sheaf_geometry_input_create(&input.handle) == SHEAF_OK);
  const double sphere[4] = {0, 0, 0, 1};
  CHECK(sheaf_add_spheres_d(input.handle, sphere, 1, 12, nullptr) == SHEAF_USAGE);
  CHECK(Says("a stride of 12 bytes, which 8 does not divide"));
  CHECK(sheaf_add_disks_d(input.handle, nullptr, 1, 0, nullptr) == SHEAF_USAGE);
  CHECK(Says("disks is NULL"));
}

}  // namespace
}  // namespace sheaf
