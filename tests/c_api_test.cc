// Geometries and rays of the C API beside those of C++: the same hits to the bit, and every error a
// status.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "sheaf/capi.h"
#include "sheaf/sheaf.h"
#include "tests/c_handles.h"
#include "tests/run_command.h"

namespace sheaf {
namespace {

// A soup of triangles, with spheres and disks among them.
struct Soup {
  std::vector<float> vertices, normals, spheres, disks;
  std::vector<std::uint32_t> indices;

  Soup() {
    std::minstd_rand random(7);
    std::uniform_real_distribution<float> place(-3, 3), size(0.1f, 0.4f);
    for (std::uint32_t i = 0; i < 300; ++i) {
      for (int k = 0; k < 3; ++k) vertices.push_back(place(random) * (i % 3 == 0 ? 1.0f : 0.9f));
      normals.insert(normals.end(), {place(random), place(random), 1});
      indices.push_back(i);
    }
    for (int i = 0; i < 40; ++i) {
      for (int k = 0; k < 3; ++k) spheres.push_back(place(random));
      spheres.push_back(size(random));
      for (int k = 0; k < 3; ++k) disks.push_back(place(random));
      disks.insert(disks.end(), {size(random), place(random), place(random), 1});
    }
  }

  Geometry Build() const {
    GeometryInput input;
    input.AddTriangles(vertices, indices, normals);
    input.AddSpheres(spheres);
    input.AddDisks(disks);
    return Geometry::Build(input).value();
  }

  sheaf_triangles mesh() const {
    sheaf_triangles triangles = SHEAF_TRIANGLES_INIT;
    triangles.vertices = vertices.data();
    triangles.vertex_count = vertices.size() / 3;
    triangles.indices = indices.data();
    triangles.triangle_count = indices.size() / 3;
    triangles.normals = normals.data();
    return triangles;
  }

  void BuildInC(GeometryOwner& geometry) const {
    InputOwner input;
    const sheaf_triangles triangles = mesh();
    std::uint32_t object = 9;
    REQUIRE(sheaf_geometry_input_create(&input.handle) == SHEAF_OK);
    REQUIRE(sheaf_add_triangles(input.handle, &triangles, &object) == SHEAF_OK);
    CHECK(object == 0);
    REQUIRE(sheaf_add_spheres(input.handle, spheres.data(), 40, 0, nullptr) == SHEAF_OK);
    REQUIRE(sheaf_add_disks(input.handle, disks.data(), 40, 0, &object) == SHEAF_OK);
    CHECK(object == 2);
    REQUIRE(sheaf_geometry_build(input.handle, nullptr, &geometry.handle) == SHEAF_OK);
  }
};

constexpr std::size_t kCount = 1000;

struct RayLists {
  std::vector<float> numbers[6];

  RayLists() {
    std::minstd_rand random(11);
    std::uniform_real_distribution<float> place(-4, 4);
    for (auto& list : numbers) {
      list.resize(kCount);
      for (float& number : list) number = place(random);
    }
  }
  sheaf_rays in_c() const {
    sheaf_rays rays = SHEAF_RAYS_INIT;
    rays.count = kCount;
    rays.origin_x = numbers[0].data();
    rays.origin_y = numbers[1].data();
    rays.origin_z = numbers[2].data();
    rays.direction_x = numbers[3].data();
    rays.direction_y = numbers[4].data();
    rays.direction_z = numbers[5].data();
    return rays;
  }
  RayArrays arrays() const {
    return {numbers[0].data(), numbers[1].data(), numbers[2].data(),
            numbers[3].data(), numbers[4].data(), numbers[5].data()};
  }
};

struct HitLists {
  std::vector<float> t, u, v;
  std::vector<std::uint32_t> primitive, object;
  HitLists() : t(kCount), u(kCount), v(kCount), primitive(kCount), object(kCount) {}
  bool operator==(const HitLists& other) const = default;
  sheaf_hits in_c() {
    sheaf_hits hits = SHEAF_HITS_INIT;
    hits.t = t.data();
    hits.primitive = primitive.data();
    hits.object = object.data();
    hits.u = u.data();
    hits.v = v.data();
    return hits;
  }
  HitArrays arrays() { return {t.data(), primitive.data(), object.data(), u.data(), v.data()}; }
};

TEST_CASE("an update has the hits of a build of C++") {
  Soup soup;
  const RayLists rays;
  GeometryOwner in_c;
  soup.BuildInC(in_c);
  for (float& x : soup.vertices) x += x > 0 ? 0.01f : -0.01f;
  for (const bool is_rebuilt : {false, true}) {
    InputOwner input;
    REQUIRE(sheaf_geometry_input_create(&input.handle) == SHEAF_OK);
    const sheaf_triangles mesh = soup.mesh();
    REQUIRE(sheaf_add_triangles(input.handle, &mesh, nullptr) == SHEAF_OK);
    REQUIRE(sheaf_add_spheres(input.handle, soup.spheres.data(), 40, 0, nullptr) == SHEAF_OK);
    REQUIRE(sheaf_add_disks(input.handle, soup.disks.data(), 40, 0, nullptr) == SHEAF_OK);
    int32_t rebuilt = 7;
    REQUIRE(sheaf_geometry_update(in_c.handle, input.handle, nullptr, &rebuilt) == SHEAF_OK);
    CHECK(rebuilt == (is_rebuilt ? 1 : 0));
    HitLists expected, found;
    REQUIRE(TraceClosest(soup.Build(), rays.arrays(), kCount, expected.arrays()));
    const sheaf_rays batch = rays.in_c();
    const sheaf_hits hits = found.in_c();
    REQUIRE(sheaf_trace_closest(in_c.handle, &batch, &hits, nullptr) == SHEAF_OK);
    CHECK(found == expected);
    soup.indices.resize(270);
    sheaf_update_options options = SHEAF_UPDATE_OPTIONS_INIT;
    options.rebuild_ratio = 0;
    REQUIRE(sheaf_geometry_update(in_c.handle, input.handle, &options, &rebuilt) == SHEAF_OK);
    CHECK(rebuilt == 1);
    CHECK(sheaf_geometry_update(nullptr, input.handle, nullptr, nullptr) == SHEAF_USAGE);
    CHECK(sheaf_geometry_update(in_c.handle, nullptr, nullptr, nullptr) == SHEAF_USAGE);
  }
}

TEST_CASE("hits and hit points are those of C++, on every target") {
  const Soup soup;
  const RayLists rays;
  const Geometry geometry = soup.Build();
  GeometryOwner in_c;
  soup.BuildInC(in_c);
  HitLists expected;
  REQUIRE(TraceClosest(geometry, rays.arrays(), kCount, expected.arrays()));
  CHECK(std::count(expected.object.begin(), expected.object.end(), 2) > 0);
  std::vector<std::uint32_t> expected_occluded(kCount);
  const TraceOptions near = {.interval = {.all_t_max = 0.5f}};
  REQUIRE(TraceOccluded(geometry, rays.arrays(), kCount, expected_occluded.data(), near));
  std::vector<float> expected_front(kCount), expected_normal(kCount);
  REQUIRE(FindHitPoints(geometry, rays.arrays(), expected.arrays(), kCount,
                        {.normal = {nullptr, expected_normal.data(), nullptr},
                         .front = {expected_front.data(), nullptr, nullptr}}));

  std::vector<const char*> names = {nullptr, "scalar", "auto"};
  for (std::size_t i = 0; i < sheaf_target_count(); ++i) names.push_back(sheaf_target_name(i));
  CHECK(sheaf_target_count() > 0);
  CHECK(sheaf_target_name(sheaf_target_count()) == nullptr);
  for (const char* name : names) {
    CAPTURE(std::string(name == nullptr ? "the best" : name));
    const sheaf_rays batch = rays.in_c();
    HitLists found;
    const sheaf_hits hits = found.in_c();
    sheaf_trace_options options = SHEAF_TRACE_OPTIONS_INIT;
    options.target = name;
    REQUIRE(sheaf_trace_closest(in_c.handle, &batch, &hits, &options) == SHEAF_OK);
    CHECK(found == expected);
    options.all_t_max = 0.5f;
    std::vector<std::uint32_t> occluded(kCount, 7);
    REQUIRE(sheaf_trace_occluded(in_c.handle, &batch, occluded.data(), &options) == SHEAF_OK);
    CHECK(occluded == expected_occluded);
    std::vector<float> front(kCount), normal(kCount);
    sheaf_hit_points points = SHEAF_HIT_POINTS_INIT;
    points.normal[1] = normal.data();
    points.front[0] = front.data();
    REQUIRE(sheaf_find_hit_points(in_c.handle, &batch, &hits, &points, name) == SHEAF_OK);
    CHECK(front == expected_front);
    CHECK(normal == expected_normal);
  }
}

TEST_CASE("an interval a ray, and rays as structures") {
  const Soup soup;
  const RayLists rays;
  const Geometry geometry = soup.Build();
  GeometryOwner in_c;
  soup.BuildInC(in_c);
  std::vector<float> t_max(kCount);
  for (std::size_t i = 0; i < kCount; ++i) t_max[i] = 0.001f * static_cast<float>(i);
  HitLists expected, found;
  REQUIRE(TraceClosest(geometry, rays.arrays(), kCount, expected.arrays(),
                       {.interval = {.t_max = t_max.data()}}));
  std::vector<std::array<float, 7>> structures(kCount);
  for (std::size_t i = 0; i < kCount; ++i) {
    for (std::size_t k = 0; k < 6; ++k) structures[i][k] = rays.numbers[k][i];
    structures[i][6] = t_max[i];
  }
  sheaf_rays batch = SHEAF_RAYS_INIT;
  batch.count = kCount;
  batch.origin_x = &structures[0][0];
  batch.origin_y = &structures[0][1];
  batch.origin_z = &structures[0][2];
  batch.direction_x = &structures[0][3];
  batch.direction_y = &structures[0][4];
  batch.direction_z = &structures[0][5];
  batch.stride = sizeof(structures[0]);
  sheaf_trace_options options = SHEAF_TRACE_OPTIONS_INIT;
  options.t_max = &structures[0][6];
  options.interval_stride = sizeof(structures[0]);
  const sheaf_hits hits = found.in_c();
  REQUIRE(sheaf_trace_closest(in_c.handle, &batch, &hits, &options) == SHEAF_OK);
  CHECK(found == expected);
  CHECK(std::count(found.primitive.begin(), found.primitive.end(), SHEAF_NO_PRIMITIVE) > 10);
}

TEST_CASE("a mesh with strides is the mesh without") {
  const Soup soup;
  const RayLists rays;
  // Vertices and normals of one structure, as a graphics program has them; ids of four a triangle.
  std::vector<float> mixed;
  for (std::size_t i = 0; i < soup.vertices.size(); i += 3) {
    for (std::size_t k = 0; k < 3; ++k) mixed.push_back(soup.vertices[i + k]);
    for (std::size_t k = 0; k < 3; ++k) mixed.push_back(soup.normals[i + k]);
  }
  std::vector<std::uint32_t> fours;
  for (std::size_t i = 0; i < soup.indices.size(); i += 3) {
    for (std::size_t k = 0; k < 3; ++k) fours.push_back(soup.indices[i + k]);
    fours.push_back(0xffffffffu);
  }
  sheaf_triangles triangles = soup.mesh();
  triangles.vertices = mixed.data();
  triangles.normals = mixed.data() + 3;
  triangles.vertex_stride = triangles.normal_stride = 6 * sizeof(float);
  triangles.indices = fours.data();
  triangles.index_stride = 4 * sizeof(std::uint32_t);
  InputOwner input;
  GeometryOwner strided;
  REQUIRE(sheaf_geometry_input_create(&input.handle) == SHEAF_OK);
  REQUIRE(sheaf_add_triangles(input.handle, &triangles, nullptr) == SHEAF_OK);
  // They were copied: what happens to the caller's arrays now does not matter.
  std::fill(mixed.begin(), mixed.end(), std::nanf(""));
  REQUIRE(sheaf_geometry_build(input.handle, nullptr, &strided.handle) == SHEAF_OK);
  GeometryInput plain;
  plain.AddTriangles(soup.vertices, soup.indices, soup.normals);
  const Geometry geometry = Geometry::Build(plain).value();
  HitLists expected, found;
  REQUIRE(TraceClosest(geometry, rays.arrays(), kCount, expected.arrays()));
  const sheaf_rays batch = rays.in_c();
  const sheaf_hits hits = found.in_c();
  REQUIRE(sheaf_trace_closest(strided.handle, &batch, &hits, nullptr) == SHEAF_OK);
  CHECK(found == expected);
}

TEST_CASE("statistics of a geometry, and what a caller of an older header gets of them") {
  const Soup soup;
  const GeometryStatistics expected = soup.Build().statistics();
  GeometryOwner geometry;
  soup.BuildInC(geometry);
  sheaf_geometry_statistics statistics = SHEAF_GEOMETRY_STATISTICS_INIT;
  REQUIRE(sheaf_geometry_get_statistics(geometry.handle, &statistics) == SHEAF_OK);
  CHECK(statistics.objects == 3);
  CHECK(statistics.triangles == expected.triangles);
  CHECK(statistics.nodes == expected.nodes);
  CHECK(statistics.bytes == expected.bytes);
  CHECK(statistics.lower[0] < statistics.upper[0]);
  std::uint32_t first = 0;
  REQUIRE(sheaf_geometry_first_primitive(geometry.handle, 1, &first) == SHEAF_OK);
  CHECK(first == 100);
  CHECK(sheaf_geometry_first_primitive(geometry.handle, 4, &first) == SHEAF_USAGE);
  CHECK(Says("object 4 of 3"));

  sheaf_geometry_statistics old = SHEAF_GEOMETRY_STATISTICS_INIT;
  old.size = offsetof(sheaf_geometry_statistics, nodes);
  old.nodes = 12345;
  REQUIRE(sheaf_geometry_get_statistics(geometry.handle, &old) == SHEAF_OK);
  CHECK(old.triangles == expected.triangles);
  CHECK(old.nodes == 12345);
  CHECK(old.size == offsetof(sheaf_geometry_statistics, nodes));
}

TEST_CASE("structures of an older and of a newer header") {
  GeometryOwner geometry;
  Soup().BuildInC(geometry);
  const RayLists rays;
  const sheaf_rays batch = rays.in_c();
  HitLists found, older;
  sheaf_hits hits = found.in_c();
  struct Newer {
    sheaf_trace_options known = SHEAF_TRACE_OPTIONS_INIT;
    std::uint64_t later = 0;
  } newer;
  newer.known.size = sizeof(newer);
  REQUIRE(sheaf_trace_closest(geometry.handle, &batch, &hits, &newer.known) == SHEAF_OK);
  newer.later = 1;
  CHECK(sheaf_trace_closest(geometry.handle, &batch, &hits, &newer.known) == SHEAF_USAGE);
  CHECK(Says("does not know"));
  // One that ends before the coherence and the target: what lies there is not read.
  sheaf_trace_options old = SHEAF_TRACE_OPTIONS_INIT;
  old.size = offsetof(sheaf_trace_options, coherence);
  old.coherence = static_cast<sheaf_coherence>(3);
  old.target = "none such";
  hits = older.in_c();
  REQUIRE(sheaf_trace_closest(geometry.handle, &batch, &hits, &old) == SHEAF_OK);
  CHECK(found == older);
  old.size = 0;
  CHECK(sheaf_trace_closest(geometry.handle, &batch, &hits, &old) == SHEAF_USAGE);
  CHECK(Says("size is not set"));
  // A number that the enumeration does not have, as C lets it be.
  old = SHEAF_TRACE_OPTIONS_INIT;
  const unsigned number = 1000;
  std::memcpy(&old.coherence, &number, sizeof(number));
  CHECK(sheaf_trace_closest(geometry.handle, &batch, &hits, &old) == SHEAF_USAGE);
  CHECK(Says("none of sheaf_coherence"));
}

TEST_CASE("misuse is a status and a message") {
  InputOwner input;
  GeometryOwner geometry;
  CHECK(sheaf_geometry_input_create(nullptr) == SHEAF_USAGE);
  REQUIRE(sheaf_geometry_input_create(&input.handle) == SHEAF_OK);
  sheaf_triangles triangles = SHEAF_TRIANGLES_INIT;
  const float corners[] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  const std::uint32_t faces[] = {0, 1, 3};
  CHECK(sheaf_add_triangles(nullptr, &triangles, nullptr) == SHEAF_USAGE);
  CHECK(sheaf_add_triangles(input.handle, nullptr, nullptr) == SHEAF_USAGE);
  triangles.vertex_count = 3;
  CHECK(sheaf_add_triangles(input.handle, &triangles, nullptr) == SHEAF_USAGE);
  CHECK(Says("vertices is NULL"));
  triangles.vertices = corners;
  triangles.vertex_stride = 7;
  CHECK(sheaf_add_triangles(input.handle, &triangles, nullptr) == SHEAF_USAGE);
  CHECK(Says("stride of 7 bytes"));
  triangles.vertex_stride = 0;
  triangles.indices = faces;
  triangles.triangle_count = 1;
  REQUIRE(sheaf_add_triangles(input.handle, &triangles, nullptr) == SHEAF_OK);
  geometry.handle = reinterpret_cast<sheaf_geometry*>(&triangles);
  CHECK(sheaf_geometry_build(input.handle, nullptr, &geometry.handle) == SHEAF_USAGE);
  CHECK(geometry.handle == nullptr);
  CHECK(Says("3"));  // the index
  CHECK(sheaf_geometry_build(nullptr, nullptr, &geometry.handle) == SHEAF_USAGE);
  CHECK(sheaf_geometry_build(input.handle, nullptr, nullptr) == SHEAF_USAGE);

  Soup().BuildInC(geometry);
  const RayLists rays;
  sheaf_rays batch = rays.in_c();
  HitLists found;
  const sheaf_hits hits = found.in_c();
  CHECK(sheaf_trace_closest(nullptr, &batch, &hits, nullptr) == SHEAF_USAGE);
  CHECK(Says("geometry is NULL"));
  CHECK(sheaf_trace_closest(geometry.handle, nullptr, &hits, nullptr) == SHEAF_USAGE);
  CHECK(sheaf_trace_closest(geometry.handle, &batch, nullptr, nullptr) == SHEAF_USAGE);
  CHECK(sheaf_trace_occluded(geometry.handle, &batch, nullptr, nullptr) == SHEAF_USAGE);
  CHECK(sheaf_find_hit_points(geometry.handle, &batch, &hits, nullptr, nullptr) == SHEAF_USAGE);
  sheaf_trace_options options = SHEAF_TRACE_OPTIONS_INIT;
  options.target = "mmx";
  CHECK(sheaf_trace_closest(geometry.handle, &batch, &hits, &options) == SHEAF_USAGE);
  CHECK(Says("target \"mmx\": this processor has scalar"));
  batch.direction_y = nullptr;
  CHECK(sheaf_trace_closest(geometry.handle, &batch, &hits, nullptr) == SHEAF_USAGE);

  // Another thread's message is its own.
  std::string other = "none";
  std::thread([&] { other = sheaf_error_message(); }).join();
  CHECK(other.empty());
  CHECK(!std::string(sheaf_error_message()).empty());
  CHECK(sheaf_version() == std::string(kVersion));
  CHECK(Contains(sheaf_build_info(), std::string("sheaf ") + kVersion + "\n"));
}

}  // namespace
}  // namespace sheaf
