// What used to be tested against every primitive: giants in a geometry, intervals behind the
// origin, directions of odd length. And the stack that a trace takes.
#include <doctest/doctest.h>
#include <pthread.h>

#include <cmath>
#include <limits>
#include <vector>

#include "bits.h"
#include "random_scene.h"
#include "sheaf/geometry.h"
#include "src/bvh/geometry_access.h"
#include "src/bvh/validate_tree.h"
#include "src/scalar/trace.h"
#include "src/scalar/trace_tree.h"
#include "targets.h"

namespace sheaf {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr RayCoherence kHints[] = {RayCoherence::kUnknown, RayCoherence::kCommonOrigin,
                                   RayCoherence::kCoherent, RayCoherence::kIncoherent};

// A hilly square of 2 * kSide^2 triangles, 0 to kSide along x and z.
constexpr std::uint32_t kSide = 24;
struct Terrain {
  std::vector<float> vertices;
  std::vector<std::uint32_t> indices;

  Terrain() {
    for (std::uint32_t j = 0; j <= kSide; ++j) {
      for (std::uint32_t i = 0; i <= kSide; ++i) {
        const float x = static_cast<float>(i), z = static_cast<float>(j);
        vertices.insert(vertices.end(), {x, static_cast<float>((i * 7 + j * 13) % 5) / 8, z});
      }
    }
    for (std::uint32_t j = 0; j < kSide; ++j) {
      for (std::uint32_t i = 0; i < kSide; ++i) {
        const std::uint32_t at = j * (kSide + 1) + i;
        indices.insert(indices.end(),
                       {at, at + 1, at + kSide + 2, at, at + kSide + 2, at + kSide + 1});
      }
    }
  }
};

const std::vector<float> kSpheres = {5, 1, 5, 0.5f, 9, 2, 11, 1};
const std::vector<float> kGiantSpheres = {12, 0, 12, 1e12f, 0, 0, 0, 3e18f};
const std::vector<float> kGiantGround = {-1e12f, -1, -1e12f, 1e12f,  -1, -1e12f,
                                         1e12f,  -1, 1e12f,  -1e12f, -1, 1e12f};
const std::vector<std::uint32_t> kTwoTriangles = {0, 1, 2, 0, 2, 3};
const std::vector<float> kGiantDisk = {0, -2, 0, 1e13f, 0, 1, 0};

struct Rays {
  std::vector<float> numbers[6], t_min;

  void Add(Vec3<float> origin, Vec3<float> direction, float from = 0x1p-126f) {
    for (int axis = 0; axis < 3; ++axis) {
      numbers[axis].push_back(origin[axis]);
      numbers[3 + axis].push_back(direction[axis]);
    }
    t_min.push_back(from);
  }
  std::uint32_t count() const { return static_cast<std::uint32_t>(t_min.size()); }
  RayArrays arrays() const {
    return {numbers[0].data(), numbers[1].data(), numbers[2].data(),
            numbers[3].data(), numbers[4].data(), numbers[5].data()};
  }
  scalar::Ray<float> at(std::uint32_t i) const {
    scalar::Ray<float> ray;
    ray.origin = {numbers[0][i], numbers[1][i], numbers[2][i]};
    ray.direction = {numbers[3][i], numbers[4][i], numbers[5][i]};
    ray.t_min = t_min[i];
    return ray;
  }
};

// Downwards from above the terrain, each direction times `scale`.
Rays RaysFromAbove(Random& random, float scale, float t_min) {
  Rays rays;
  for (int i = 0; i < 500; ++i) {
    const auto number = [&](double low, double high) {
      return static_cast<float>(Uniform(random, low, high));
    };
    rays.Add({number(-2, kSide + 2), number(-1, 8), number(-2, kSide + 2)},
             {number(-1, 1) * scale, -scale, number(-1, 1) * scale}, t_min);
  }
  return rays;
}

// On every target with every hint, and by the baseline, bit by bit what the specification finds
// over every primitive. Returns how many hit.
std::uint32_t CheckEverywhere(const GeometryInput& input, const Rays& rays) {
  const Result<Geometry> built = Geometry::Build(input, 1);
  REQUIRE(built.ok());
  const Result<FlatInput> flat = GeometryAccess::Flatten(input, 1);
  REQUIRE(flat.ok());
  const GeometryView<float> primitives = flat.value().arrays.view();
  const TreeView<float>& tree = GeometryAccess::TreeOf(built.value());
  CHECK(FindTreeDefect(tree, primitives) == "");
  const std::uint32_t n = rays.count();
  std::vector<scalar::Hit<float>> want;
  std::uint32_t hit_count = 0, wrong_baseline = 0;
  for (std::uint32_t i = 0; i < n; ++i) {
    want.push_back(scalar::TraceClosest(primitives, rays.at(i)));
    hit_count += want[i].primitive != kNoPrimitive;
    const scalar::Hit<float> hit = scalar::TraceClosest(tree, rays.at(i));
    wrong_baseline += !SameBits(hit.t, want[i].t) || hit.primitive != want[i].primitive;
  }
  CHECK(wrong_baseline == 0);
  ForEachTarget([&](Target target) {
    for (const RayCoherence hint : kHints) {
      TraceOptions options;
      options.interval.t_min = rays.t_min.data();
      options.coherence = hint;
      options.target = target;
      std::vector<float> t(n), u(n), v(n);
      std::vector<std::uint32_t> primitive(n), occluded(n);
      TraceClosest(built.value(), rays.arrays(), n,
                   {.t = t.data(), .primitive = primitive.data(), .u = u.data(), .v = v.data()},
                   options)
          .value();
      TraceOccluded(built.value(), rays.arrays(), n, occluded.data(), options).value();
      std::uint32_t wrong = 0;
      for (std::uint32_t i = 0; i < n; ++i) {
        wrong += !SameBits(t[i], want[i].t) || primitive[i] != want[i].primitive ||
                 !SameBits(u[i], want[i].u) || !SameBits(v[i], want[i].v) ||
                 (occluded[i] != 0) != (want[i].primitive != kNoPrimitive);
      }
      CHECK(wrong == 0);
    }
  });
  return hit_count;
}

TEST_CASE("intervals behind the origin and directions of any length") {
  const Terrain terrain;
  GeometryInput input;
  input.AddTriangles(terrain.vertices, terrain.indices);
  input.AddSpheres(kSpheres);
  Random random(1);
  for (const float t_min : {-1e-4f, -3.0f, -kInfinity, 0.0f}) {
    CAPTURE(t_min);
    CHECK(CheckEverywhere(input, RaysFromAbove(random, 1, t_min)) > 100);
  }
  for (const float scale : {1e-21f, 1e-30f, 1e21f, 1e30f}) {
    CAPTURE(scale);
    CHECK(CheckEverywhere(input, RaysFromAbove(random, scale, 0x1p-126f)) > 100);
    CHECK(CheckEverywhere(input, RaysFromAbove(random, scale, -1 / scale)) > 100);
  }
  // t overflows: nothing is hit, by anyone.
  CheckEverywhere(input, RaysFromAbove(random, 1e-40f, 0x1p-126f));
}

TEST_CASE("giants beside small things") {
  const Terrain terrain;
  const auto with_giants = [&](auto... add) {
    GeometryInput input;
    input.AddTriangles(terrain.vertices, terrain.indices);
    (add(input), ...);
    return input;
  };
  const auto spheres = [](GeometryInput& input) { input.AddSpheres(kGiantSpheres); };
  const auto ground = [](GeometryInput& input) { input.AddTriangles(kGiantGround, kTwoTriangles); };
  const auto disk = [](GeometryInput& input) { input.AddDisks(kGiantDisk); };
  Random random(2);
  Rays rays = RaysFromAbove(random, 1, 0x1p-126f);
  for (int axis = 0; axis < 3; ++axis) {  // along the axes, up and down
    for (int i = 0; i < 40; ++i) {
      float direction[3] = {};
      direction[axis] = i % 2 ? 1.0f : -1.0f;
      rays.Add({static_cast<float>(i) / 2, 0.25f, static_cast<float>(i) / 3},
               {direction[0], direction[1], direction[2]});
    }
  }
  for (int i = 0; i < 40; ++i) {  // from far away, within and beyond the limits of box tests
    rays.Add({12, i % 2 ? 1e11f : 1e12f, 12}, {static_cast<float>(i) * 1e-12f, -1, 0});
  }
  CHECK(CheckEverywhere(with_giants(spheres), rays) == rays.count());
  CheckEverywhere(with_giants(ground), rays);
  CheckEverywhere(with_giants(disk, ground, spheres), rays);
  GeometryInput giants;
  spheres(giants);
  ground(giants);
  disk(giants);
  CheckEverywhere(giants, rays);
}

TEST_CASE("giants leave the boxes of other primitives as they are") {
  const Terrain terrain;
  GeometryInput without, with;
  without.AddTriangles(terrain.vertices, terrain.indices);
  with.AddTriangles(terrain.vertices, terrain.indices);
  with.AddSpheres(kGiantSpheres);
  const Result<Geometry> small = Geometry::Build(without, 1), large = Geometry::Build(with, 1);
  REQUIRE(small.ok());
  REQUIRE(large.ok());
  const TreeView<float>&a = GeometryAccess::TreeOf(small.value()),
        &b = GeometryAccess::TreeOf(large.value());
  for (int axis = 0; axis < 3; ++axis) {
    CHECK(SameBits(a.lower[axis], b.lower[axis]));
    CHECK(SameBits(a.upper[axis], b.upper[axis]));
  }
  // The geometry tells its own bounds, with them.
  CHECK(small.value().upper()[1] < 1);
  CHECK(large.value().upper()[1] >= 3e18f);
  // Boxes of giants: of their leaf and of the nodes above.
  std::uint32_t giant_boxes = 0;
  for (std::uint32_t i = 0; i < b.node_count; ++i) {
    for (std::uint32_t slot = 0; slot < kTreeWidth; ++slot) {
      giant_boxes +=
          b.nodes[i].child[slot] != kNoChild && b.nodes[i].bounds[3][slot] == kMaxBoxCoordinate;
    }
  }
  CHECK(giant_boxes <= 2);
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
struct StackJob {
  const Geometry* geometry;
  const Rays* rays;
  TraceOptions options;
};

void* TraceOnSmallStack(void* argument) {
  const StackJob& job = *static_cast<StackJob*>(argument);
  const std::uint32_t n = job.rays->count();
  std::vector<float> t(n);
  std::vector<std::uint32_t> occluded(n);
  TraceClosest(*job.geometry, job.rays->arrays(), n, {.t = t.data()}, job.options).value();
  TraceOccluded(*job.geometry, job.rays->arrays(), n, occluded.data(), job.options).value();
  return nullptr;
}

// Less crashes: the pages below the stack are not there.
TEST_CASE("a trace takes at most 64 KiB of stack") {
  const Terrain terrain;
  GeometryInput input;
  input.AddTriangles(terrain.vertices, terrain.indices);
  input.AddSpheres(kSpheres);
  const Result<Geometry> geometry = Geometry::Build(input, 1);
  REQUIRE(geometry.ok());
  Random random(3);
  // Strays; a pinhole's frusta; a sun's sheets.
  Rays strays = RaysFromAbove(random, 1, 0x1p-126f), pinhole, sun;
  for (std::uint32_t i = 0; i < 1024; ++i) {
    const std::uint32_t x = (i & 15) + (i >> 8 & 1) * 16, y = (i >> 4 & 15) + (i >> 9) * 16;
    const float a = static_cast<float>(x) / 32, b = static_cast<float>(y) / 32;
    pinhole.Add({12, 20, 12}, {a * 0.3f + 0.01f, -1, b * 0.3f + 0.01f});
    sun.Add({a * 20, 20, b * 20}, {0.25f, -1, 0.125f});
  }
  ForEachTarget([&](Target target) {
    for (const Rays* rays : {&strays, &pinhole, &sun}) {
      StackJob job{&geometry.value(), rays, {}};
      job.options.target = target;
      pthread_attr_t attributes;
      REQUIRE(pthread_attr_init(&attributes) == 0);
      REQUIRE(pthread_attr_setstacksize(&attributes, 64 << 10) == 0);
      pthread_t thread;
      REQUIRE(pthread_create(&thread, &attributes, TraceOnSmallStack, &job) == 0);
      REQUIRE(pthread_join(thread, nullptr) == 0);
      pthread_attr_destroy(&attributes);
    }
  });
}
#endif

}  // namespace
}  // namespace sheaf
