// Geometry without the renderer: what Build accepts, what it says of itself, and rays in arrays of
// any length.
#include "sheaf/geometry.h"

#include <doctest/doctest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "bits.h"
#include "random_scene.h"
#include "simd/query.h"
#include "simd/streams.h"
#include "simd/tree.h"
#include "src/bvh/geometry_access.h"
#include "src/bvh/validate_tree.h"
#include "src/scalar/trace.h"

namespace sheaf {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

const std::vector<float> kSquare = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
const std::vector<std::uint32_t> kTwoTriangles = {0, 1, 2, 0, 2, 3};
const std::vector<float> kTwoSpheres = {0, 0, 2, 0.5f, 3, 0, 2, 1};

std::string ErrorOf(const GeometryInput& input) {
  const Result<Geometry> built = Geometry::Build(input, 2);
  if (built.ok()) return "";
  CHECK(built.error().kind == ErrorKind::kUsage);
  return built.error().message;
}

// The message for a mesh that follows a sound object.
std::string MeshError(const std::vector<float>& vertices,
                      const std::vector<std::uint32_t>& indices) {
  GeometryInput input;
  input.AddSpheres(kTwoSpheres);
  input.AddTriangles(vertices, indices);
  return ErrorOf(input);
}

std::string SphereError(const std::vector<float>& spheres) {
  GeometryInput input;
  input.AddTriangles(kSquare, kTwoTriangles);
  input.AddSpheres(spheres);
  return ErrorOf(input);
}

TEST_CASE("what is wrong is named") {
  CHECK(MeshError(kSquare, kTwoTriangles) == "");
  CHECK(MeshError(kSquare, {0, 1, 2, 0, 4, 3}) == "object 1, triangle 1: vertex 4 of 4");
  CHECK(MeshError(kSquare, {0, 1, 2, 0}) == "object 1: 4 indices do not divide by 3");
  CHECK(MeshError({0, 0, 0, 1}, {}) == "object 1: 4 vertex coordinates do not divide by 3");
  CHECK(MeshError({}, {0, 0, 0}) == "object 1, triangle 0: vertex 0 of 0");
  for (const float odd : {kNaN, kInfinity, -kInfinity}) {
    std::vector<float> vertices = kSquare;
    vertices[10] = odd;
    CHECK(MeshError(vertices, kTwoTriangles) == "object 1, triangle 1: a coordinate is not finite");
    CHECK(SphereError({0, 0, 0, 1, 0, odd, 0, 1}) ==
          "object 1, sphere 1: a coordinate is not finite");
    CHECK(SphereError({0, 0, 0, odd}) == "object 1, sphere 0: the radius is not finite");
  }
  CHECK(SphereError({0, 0, 0, -1}) == "object 1, sphere 0: the radius is negative");
  CHECK(SphereError({0, 0, 0, -0.0f}) == "");
  CHECK(SphereError({0, 0, 0, 1, 0}) == "object 1: 5 numbers do not divide by 4");
  // Of several, the first is named, on any number of threads.
  std::vector<std::uint32_t> indices(300'000, 0);
  for (const std::size_t wrong : {299'999u, 200'000u, 100'001u}) indices[wrong] = 9;
  CHECK(MeshError(kSquare, indices) == "object 1, triangle 33333: vertex 9 of 4");
}

TEST_CASE("objects and primitives are numbered in the order of the calls") {
  GeometryInput input;
  CHECK(input.AddSpheres({}) == 0);
  CHECK(input.AddTriangles(kSquare, kTwoTriangles) == 1);
  CHECK(input.AddTriangles({}, {}) == 2);
  CHECK(input.AddSpheres(kTwoSpheres) == 3);
  CHECK(input.AddTriangles(kSquare, kTwoTriangles) == 4);
  CHECK(input.AddSpheres({}) == 5);
  const std::vector<float> disks = {0, 0, 1, 1, 0, 0, 1, 0, 0, 2, 1, 0, 0, 1, 0, 0, 3, 0, 0, 0, 1};
  CHECK(input.AddDisks(disks) == 6);
  const Result<Geometry> built = Geometry::Build(input);
  REQUIRE(built.ok());
  const Geometry& geometry = built.value();
  CHECK(geometry.object_count() == 7);
  const std::uint32_t want[] = {1, 1, 3, 3, 4, 4};
  for (std::uint32_t i = 0; i < 6; ++i) CHECK(geometry.object_of(i) == want[i]);
  CHECK(geometry.first_primitive(1) == 0);
  CHECK(geometry.first_primitive(3) == 2);
  CHECK(geometry.first_primitive(4) == 4);
  const GeometryStatistics statistics = geometry.statistics();
  CHECK(statistics.primitives == 8);
  CHECK(statistics.triangles == 4);
  CHECK(statistics.spheres == 2);
  CHECK(statistics.disks == 2);
  CHECK(statistics.never_hit == 1);  // the disk of radius 0
  CHECK(statistics.nodes == 1);
  CHECK(statistics.leaves == 3);
  CHECK(statistics.depth == 1);
  CHECK(statistics.bytes > sizeof(TreeNode));
  CHECK(geometry.lower()[2] <= 0);
  CHECK(geometry.lower()[2] >= -1e-5f);
  CHECK(geometry.upper()[0] >= 4);
  CHECK(geometry.upper()[0] <= 4 + 1e-5f);
}

TEST_CASE("what no ray may hit is counted and left out") {
  const std::vector<float> line = {0, 0, 0, 1, 1, 1, 2, 2, 2, 1, 1, 1.5f};
  const std::vector<std::uint32_t> indices = {0, 1, 2, 1, 1, 3, 0, 1, 3};
  const std::vector<float> spheres = {0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, -0.0f};
  GeometryInput input;
  input.AddTriangles(line, indices);
  input.AddSpheres(spheres);
  const Result<Geometry> built = Geometry::Build(input);
  REQUIRE(built.ok());
  const GeometryStatistics statistics = built.value().statistics();
  CHECK(statistics.triangles == 1);
  CHECK(statistics.spheres == 1);
  CHECK(statistics.never_hit == 4);
  CHECK(built.value().object_of(5) == 1);

  const Result<Geometry> empty = Geometry::Build(GeometryInput());
  REQUIRE(empty.ok());
  CHECK(empty.value().object_count() == 0);
  CHECK(empty.value().statistics().depth == 0);
  CHECK(empty.value().lower()[0] > empty.value().upper()[0]);
}

// A random geometry, beside the arrays that the scalar specification takes.
struct Model {
  CompiledScene<float> scene;
  std::vector<float> vertices, spheres;
  std::vector<std::uint32_t> indices;
  std::vector<Geometry> geometry;

  // Ids of the geometry: the spheres are object 0, the triangles object 1.
  std::vector<std::uint32_t> sphere_id, triangle_id;

  explicit Model(Random& random, int count)
      : scene(CompileScene<float>(RandomScene(random, count))) {
    const GeometryView<float> view = scene.geometry();
    for (std::uint32_t i = 0; i < view.spheres.count; ++i) {
      const float radius = view.spheres.radius[i];
      spheres.insert(spheres.end(), {view.spheres.center_x[i], view.spheres.center_y[i],
                                     view.spheres.center_z[i], radius > 0 ? radius : 0});
      sphere_id.push_back(i);
    }
    for (std::uint32_t i = 0; i < view.triangles.count; ++i) {
      // What has no area repeats a vertex.
      const bool never = std::isnan(view.triangles.vertex[0][0][i]);
      for (int k = 0; k < 9; ++k) {
        if (k % 3 == 0) indices.push_back(static_cast<std::uint32_t>(vertices.size() / 3));
        vertices.push_back(view.triangles.vertex[never ? 1 : k / 3][k % 3][i]);
      }
      triangle_id.push_back(view.spheres.count + i);
    }
    GeometryInput input;
    input.AddSpheres(spheres);
    input.AddTriangles(vertices, indices);
    Result<Geometry> built = Geometry::Build(input);
    REQUIRE(built.ok());
    geometry.push_back(std::move(built).value());
  }

  GeometryView<float> view() const {
    GeometryView<float> view = scene.geometry();
    view.spheres.id = sphere_id.data();
    view.triangles.id = triangle_id.data();
    return view;
  }
};

TEST_CASE("Build makes a sound tree of what it was given") {
  Random random(1);
  for (int round = 0; round < 20; ++round) {
    const Model model(random, round * round);
    CHECK(FindTreeDefect(GeometryAccess::TreeOf(model.geometry[0]), model.view()) == "");
    const GeometryStatistics statistics = model.geometry[0].statistics();
    CHECK(statistics.triangles + statistics.spheres + statistics.never_hit ==
          model.sphere_id.size() + model.triangle_id.size());
  }
}

// An array of exactly `count` elements on the heap, so that a sanitizer sees one too many.
template <typename T>
std::unique_ptr<T[]> Exact(std::uint32_t count) {
  return std::make_unique<T[]>(count);
}

struct Rays {
  std::uint32_t count;
  std::unique_ptr<float[]> number[6], t_min, t_max;
  std::unique_ptr<std::uint32_t[]> source;

  explicit Rays(const std::vector<scalar::Ray<float>>& from)
      : count(static_cast<std::uint32_t>(from.size())),
        t_min(Exact<float>(count)),
        t_max(Exact<float>(count)),
        source(Exact<std::uint32_t>(count)) {
    for (auto& n : number) n = Exact<float>(count);
    for (std::uint32_t i = 0; i < count; ++i) {
      const auto& [origin, direction] = std::pair(from[i].origin, from[i].direction);
      const float numbers[6] = {origin.x,    origin.y,    origin.z,
                                direction.x, direction.y, direction.z};
      for (int k = 0; k < 6; ++k) number[k][i] = numbers[k];
      t_min[i] = from[i].t_min;
      t_max[i] = from[i].t_max;
      source[i] = from[i].source;
    }
  }

  RayArrays view() const {
    return {number[0].get(), number[1].get(), number[2].get(), number[3].get(),
            number[4].get(), number[5].get(), source.get()};
  }
};

// Traces `rays` and asks only for the results whose bit is set in `wanted`.
void CheckTraces(const Model& model, const std::vector<scalar::Ray<float>>& from, unsigned wanted) {
  const Rays rays(from);
  const Geometry& geometry = model.geometry[0];
  const GeometryView<float> view = model.view();
  const auto t = Exact<float>(rays.count), u = Exact<float>(rays.count),
             v = Exact<float>(rays.count);
  const auto primitive = Exact<std::uint32_t>(rays.count),
             object = Exact<std::uint32_t>(rays.count), occluded = Exact<std::uint32_t>(rays.count);
  const auto ask = [&](unsigned bit, auto* array) { return wanted >> bit & 1 ? array : nullptr; };
  const TraceOptions options{.interval = {rays.t_min.get(), rays.t_max.get()}};
  TraceClosest(geometry, rays.view(), rays.count,
               {ask(0, t.get()), ask(1, primitive.get()), ask(2, object.get()), ask(3, u.get()),
                ask(4, v.get())},
               options)
      .value();
  TraceOccluded(geometry, rays.view(), rays.count, occluded.get(), options).value();
  std::uint32_t wrong = 0;
  for (std::uint32_t i = 0; i < rays.count; ++i) {
    const scalar::Hit<float> want = scalar::TraceClosest(view, from[i]);
    const bool is_miss = want.primitive == kNoPrimitive;
    const std::uint32_t want_object =
        is_miss ? kNoPrimitive : (want.primitive < model.sphere_id.size() ? 0u : 1u);
    // The interval of a missing ray may be NaN, whose bits are nobody's promise.
    wrong += (wanted & 1) && !SameBits(t[i], want.t) && !(t[i] != t[i] && want.t != want.t);
    wrong += (wanted & 2) && primitive[i] != want.primitive;
    wrong += (wanted & 4) && object[i] != want_object;
    wrong += (wanted & 8) && !SameBits(u[i], want.u);
    wrong += (wanted & 16) && !SameBits(v[i], want.v);
    wrong += occluded[i] != (scalar::TraceOccluded(view, from[i]) ? 1u : 0u);
  }
  CHECK(wrong == 0);
}

TEST_CASE("arrays of any length and any selection of results") {
  Random random(2);
  const Model model(random, 60);
  const auto primitives =
      static_cast<std::uint32_t>(model.sphere_id.size() + model.triangle_id.size());
  const auto random_rays = [&](std::uint32_t count) {
    std::vector<scalar::Ray<float>> rays;
    for (std::uint32_t i = 0; i < count; ++i) rays.push_back(RandomRay<float>(random, primitives));
    return rays;
  };
  for (std::uint32_t count = 0; count <= 40; ++count) {
    CAPTURE(count);
    CheckTraces(model, random_rays(count), 31);
    CheckTraces(model, random_rays(count), count % 32);
  }
  for (const std::uint32_t count : {1023u, 1024u, 1025u, 3001u}) {
    for (const unsigned wanted : {31u, 30u, 6u, 4u}) CheckTraces(model, random_rays(count), wanted);
  }
}

TEST_CASE("one interval for all, no sources, no geometry") {
  GeometryInput input;
  input.AddTriangles(kSquare, kTwoTriangles);
  const Result<Geometry> built = Geometry::Build(input);
  const Result<Geometry> empty = Geometry::Build(GeometryInput());
  REQUIRE(built.ok());
  REQUIRE(empty.ok());
  const float x[2] = {0.25f, 0.75f}, z[2] = {-1, -3}, zero[2] = {0, 0}, one[2] = {1, 1};
  const RayArrays rays = {x, one, z, zero, zero, one, nullptr};
  const float y[2] = {0.5f, 0.5f};
  RayArrays inside = rays;
  inside.origin_y = y;
  float t[2];
  std::uint32_t primitive[2], occluded[2];
  TraceClosest(built.value(), inside, 2, {.t = t, .primitive = primitive}).value();
  CHECK(t[0] == 1);
  CHECK(t[1] == 3);
  CHECK(primitive[0] == 1);
  CHECK(primitive[1] == 0);
  const TraceOptions near = {.interval = {.all_t_max = 2}};
  TraceClosest(built.value(), inside, 2, {.t = t, .primitive = primitive}, near).value();
  TraceOccluded(built.value(), inside, 2, occluded, near).value();
  CHECK(t[0] == 1);
  CHECK(t[1] == 2);
  CHECK(primitive[1] == kNoPrimitive);
  CHECK(occluded[0] == 1);
  CHECK(occluded[1] == 0);
  TraceClosest(empty.value(), inside, 2, {.t = t, .primitive = primitive}, near).value();
  TraceOccluded(empty.value(), inside, 2, occluded).value();
  CHECK(t[0] == 2);
  CHECK(primitive[0] == kNoPrimitive);
  CHECK(occluded[0] == 0);
}

TEST_CASE("a geometry that was moved from is empty") {
  GeometryInput input;
  input.AddTriangles(kSquare, kTwoTriangles);
  Result<Geometry> built = Geometry::Build(input);
  REQUIRE(built.ok());
  const Geometry taken = std::move(built).value();
  const Geometry& left = built.value();
  const float x[1] = {0.25f}, z[1] = {-1}, zero[1] = {0}, one[1] = {1};
  const RayArrays ray = {x, x, z, zero, zero, one};
  float t[1];
  std::uint32_t primitive[1], object[1], occluded[1];
  TraceClosest(left, ray, 1, {.t = t, .primitive = primitive, .object = object}).value();
  CHECK(t[0] == std::numeric_limits<float>::max());
  CHECK(primitive[0] == Geometry::kNoPrimitive);
  CHECK(object[0] == Geometry::kNoPrimitive);
  TraceOccluded(left, ray, 1, occluded).value();
  CHECK(occluded[0] == 0);
  CHECK(left.object_count() == 0);
  CHECK(left.first_primitive(0) == 0);
  CHECK(left.lower()[2] > left.upper()[2]);
  CHECK(left.statistics().nodes == 0);
  TraceOccluded(taken, ray, 1, occluded).value();
  CHECK(occluded[0] == 1);
  CHECK(taken.object_count() == 1);
}

}  // namespace
}  // namespace sheaf
