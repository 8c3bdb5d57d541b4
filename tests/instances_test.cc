// Geometries in many places: the hits of every target are those of rays against each instance in
// turn, whatever the map and the ray.
#include "sheaf/instances.h"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "bits.h"
#include "src/bvh/build_instances.h"
#include "src/bvh/geometry_access.h"
#include "src/bvh/instances_access.h"
#include "src/scalar/instances.h"
#include "targets.h"

namespace sheaf {
namespace {

template <typename Real>
using Shared = std::shared_ptr<const GeometryOf<Real>>;

// A bumpy ball of triangles around (2, 0, 0).
GeometryInput Ball(std::vector<float>& vertices, std::vector<std::uint32_t>& indices) {
  constexpr std::uint32_t kRings = 12, kSegments = 18;
  constexpr double kPi = 3.14159265358979323846;
  for (std::uint32_t ring = 0; ring <= kRings; ++ring) {
    for (std::uint32_t segment = 0; segment < kSegments; ++segment) {
      const double a = kPi * ring / kRings, b = 2 * kPi * segment / kSegments;
      const double r = 1 + 0.1 * ((ring * 7 + segment * 5) % 4);
      vertices.push_back(static_cast<float>(2 + r * std::sin(a) * std::cos(b)));
      vertices.push_back(static_cast<float>(r * std::cos(a)));
      vertices.push_back(static_cast<float>(r * std::sin(a) * std::sin(b)));
      if (ring == kRings) continue;
      const std::uint32_t at = ring * kSegments + segment;
      const std::uint32_t next = ring * kSegments + (segment + 1) % kSegments;
      indices.insert(indices.end(),
                     {at, at + kSegments, next, next, at + kSegments, next + kSegments});
    }
  }
  GeometryInput input;
  input.AddTriangles(vertices, indices);
  return input;
}

template <typename Real>
Shared<Real> Built(const GeometryInput& input) {
  return std::make_shared<const GeometryOf<Real>>(GeometryOf<Real>::Build(input).value());
}

// A ball, spheres with disks, one triangle at a tiny scale, and nothing at all.
template <typename Real>
std::vector<Shared<Real>> Geometries() {
  std::vector<Shared<Real>> geometries;
  std::vector<float> vertices;
  std::vector<std::uint32_t> indices;
  geometries.push_back(Built<Real>(Ball(vertices, indices)));
  const std::vector<float> spheres = {0, 0, 0, 0.5f, 1, 1, 0, 0.25f};
  const std::vector<float> disks = {0, -1, 0, 1.5f, 0.1f, 1, 0.2f};
  GeometryInput round;
  round.AddSpheres(spheres);
  round.AddDisks(disks);
  geometries.push_back(Built<Real>(round));
  const std::vector<float> tiny = {0, 0, 0, 1e-25f, 0, 0, 0, 1e-25f, 0};
  const std::vector<std::uint32_t> corners = {0, 1, 2};
  GeometryInput one;
  one.AddTriangles(tiny, corners);
  geometries.push_back(Built<Real>(one));
  geometries.push_back(std::make_shared<const GeometryOf<Real>>());
  return geometries;
}

// Turned about an axis, scaled unevenly, sheared, mirrored at times, and moved.
std::array<double, 12> RandomMap(std::mt19937& random, double scale, double reach) {
  std::uniform_real_distribution<double> part(-1, 1), size(0.2, 2);
  std::array<double, 12> map;
  for (std::size_t k = 0; k < 12; ++k) {
    const bool is_move = k % 4 == 3, is_diagonal = k % 5 == 0;
    map[k] = is_move ? reach * part(random) : 0.4 * scale * part(random);
    if (is_diagonal) map[k] += scale * size(random) * (random() % 4 == 0 ? -1 : 1);
  }
  return map;
}

std::vector<Place> RandomPlaces(std::size_t count, double reach) {
  std::mt19937 random(7);
  std::vector<Place> places;
  for (std::size_t i = 0; i < count; ++i) {
    const auto geometry = static_cast<std::uint32_t>(random() % 4);
    const double scale = reach / 6 * (geometry == 2 ? 1e25 : 1);
    places.push_back({geometry, RandomMap(random, scale, reach)});
    // Some twice at one place: the lower number counts.
    if (i % 10 == 0) places.push_back(places.back());
  }
  return places;
}

template <typename Real>
struct Rays {
  std::vector<Real> numbers[6], t_min, t_max;
  std::vector<std::uint32_t> source, source_instance;

  void Add(std::array<double, 3> origin, std::array<double, 3> direction,
           double from = static_cast<double>(kDefaultTMin<Real>),
           double to = static_cast<double>(kDefaultTMax<Real>)) {
    for (std::size_t k = 0; k < 3; ++k) {
      numbers[k].push_back(static_cast<Real>(origin[k]));
      numbers[3 + k].push_back(static_cast<Real>(direction[k]));
    }
    t_min.push_back(static_cast<Real>(from));
    t_max.push_back(static_cast<Real>(to));
    source.push_back(kNoPrimitive);
    source_instance.push_back(kNoInstance);
  }
  std::size_t count() const { return t_min.size(); }
  RayArraysOf<Real> arrays() const {
    return {numbers[0].data(), numbers[1].data(), numbers[2].data(), numbers[3].data(),
            numbers[4].data(), numbers[5].data(), source.data()};
  }
  TraceOptionsOf<Real> options(Target target) const {
    TraceOptionsOf<Real> options;
    options.interval.t_min = t_min.data();
    options.interval.t_max = t_max.data();
    options.target = target;
    return options;
  }
  scalar::Ray<Real> at(std::size_t i) const {
    return {{numbers[0][i], numbers[1][i], numbers[2][i]},
            {numbers[3][i], numbers[4][i], numbers[5][i]},
            source[i],
            t_min[i],
            t_max[i],
            source_instance[i]};
  }
};

// A camera's, which go together; then such as go anywhere; then odd ones.
template <typename Real>
Rays<Real> ManyRays(double reach) {
  Rays<Real> rays;
  for (int y = 0; y < 40; ++y) {
    for (int x = 0; x < 40; ++x) {
      rays.Add({0.1 * reach, 0.2 * reach, 2.5 * reach}, {(x - 20) * 0.02, (20 - y) * 0.02, -1});
    }
  }
  std::mt19937 random(3);
  std::uniform_real_distribution<double> part(-1, 1);
  const auto anywhere = [&](double size) -> std::array<double, 3> {
    return {size * part(random), size * part(random), size * part(random)};
  };
  for (int i = 0; i < 1500; ++i) rays.Add(anywhere(1.2 * reach), anywhere(1));
  for (int i = 0; i < 300; ++i) rays.Add(anywhere(reach), anywhere(1), 0.1, reach * part(random));
  for (int i = 0; i < 100; ++i) rays.Add(anywhere(reach), anywhere(1), -3 * reach);
  for (int i = 0; i < 100; ++i) rays.Add(anywhere(reach), anywhere(1e-30));
  for (int i = 0; i < 100; ++i) rays.Add(anywhere(reach), anywhere(1e30));
  for (int i = 0; i < 50; ++i) rays.Add({0, 1e13, 0}, {0.3 * reach * part(random), -1e13, 0});
  for (int i = 0; i < 100; ++i) {
    std::array<double, 3> along = {};
    along[random() % 3] = random() % 2 ? 1 : -1;
    rays.Add(anywhere(reach), along);
  }
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  rays.Add({nan, 0, 0}, {1, 0, 0});
  rays.Add({0, 0, 0}, {0, 0, 0});
  rays.Add({0, 0, 0}, {infinity, 0, 0});
  rays.Add({0, 0, 0}, {1, 1, 0}, nan);
  rays.Add({0, 0, 0}, {1, 1, 0}, 0, nan);
  rays.Add({0, 0, 0}, {1, 1, 0}, 0, infinity);
  rays.Add({0, 0, 0}, {1, 1, 0}, 1, 0.5);
  return rays;
}

template <typename Real>
struct Hits {
  std::vector<Real> t, u, v;
  std::vector<std::uint32_t> primitive, object, instance;

  explicit Hits(std::size_t n) : t(n), u(n), v(n), primitive(n), object(n), instance(n) {}
  HitArraysOf<Real> arrays() {
    return {t.data(), primitive.data(), object.data(), u.data(), v.data()};
  }
};

// Without any tree over instances.
template <typename Real>
scalar::Hit<Real> NearestOfEvery(const InstanceTree<Real>& tree, const scalar::Ray<Real>& ray) {
  scalar::Ray<Real> finite = ray;
  scalar::MakeFinite(finite);
  scalar::Hit<Real> nearest = {finite.t_max};
  if (!scalar::IsTraceable(finite)) return nearest;
  for (std::uint32_t i = 0; i < tree.count; ++i) {
    auto hit = scalar::TraceClosest(tree.trees[tree.object[i]], scalar::MapRay(tree, i, ray));
    if (hit.primitive == kNoPrimitive) continue;
    hit.instance = i;
    if (nearest.primitive == kNoPrimitive || hit.t < nearest.t) nearest = hit;
  }
  return nearest;
}

template <typename Real>
void CheckAgainstEvery(double reach) {
  const auto geometries = Geometries<Real>();
  const auto places = RandomPlaces(150, reach);
  const auto instances = InstancesOf<Real>::Build(geometries, places).value();
  const InstanceTree<Real> tree = InstancesAccess::DataOf(instances)->forest.view();
  Rays<Real> rays = ManyRays<Real>(reach);
  // Some start on what others hit.
  for (std::size_t i = 0; i < 800; ++i) {
    const auto hit = NearestOfEvery(tree, rays.at(i));
    if (hit.primitive == kNoPrimitive) continue;
    rays.source[i] = hit.primitive;
    rays.source_instance[i] = i % 3 == 0 ? hit.instance + 1 : hit.instance;
  }
  std::vector<scalar::Hit<Real>> expected;
  int hit_count = 0;
  for (std::size_t i = 0; i < rays.count(); ++i) {
    expected.push_back(NearestOfEvery(tree, rays.at(i)));
    hit_count += expected.back().primitive != kNoPrimitive ? 1 : 0;
  }
  CHECK(hit_count > 1000);
  CHECK(hit_count < static_cast<int>(rays.count()) - 500);

  const auto check = [&](Target target) {
    Hits<Real> hits(rays.count());
    std::vector<std::uint32_t> occluded(rays.count());
    const InstanceRayArrays sources = {rays.source_instance.data()};
    const auto options = rays.options(target);
    REQUIRE(TraceClosest(instances, rays.arrays(), rays.count(), hits.arrays(),
                         hits.instance.data(), options, sources)
                .ok());
    REQUIRE(TraceOccluded(instances, rays.arrays(), rays.count(), occluded.data(), options, sources)
                .ok());
    int differing = 0;
    for (std::size_t i = 0; i < rays.count(); ++i) {
      const scalar::Hit<Real>& hit = expected[i];
      const bool is_hit = hit.primitive != kNoPrimitive;
      differing += !SameBits(hits.t[i], hit.t) || !SameBits(hits.u[i], hit.u) ||
                   !SameBits(hits.v[i], hit.v) || hits.primitive[i] != hit.primitive ||
                   hits.instance[i] != hit.instance || occluded[i] != (is_hit ? 1u : 0u);
      if (is_hit) {
        const auto& geometry = *geometries[places[hit.instance].geometry];
        differing += hits.object[i] != geometry.object_of(hit.primitive);
      } else {
        differing += hits.object[i] != kNoPrimitive;
      }
    }
    CHECK_MESSAGE(differing == 0, target.name());
  };
  ForEachTarget(check);
  check(Target::Scalar());
}

TEST_CASE("every target finds what rays hit in each instance in turn") {
  CheckAgainstEvery<float>(6);
  CheckAgainstEvery<float>(4000);
  CheckAgainstEvery<double>(6);
}

TEST_CASE("a moved and scaled instance is hit where the numbers say") {
  const auto geometries = Geometries<float>();
  // The unit of the sphere of radius 1/2 is 4 here, 10 up.
  Place place;
  place.geometry = 1;
  place.to_world = {4, 0, 0, 0, 0, 4, 0, 10, 0, 0, 4, 0};
  const auto instances = Instances::Build(geometries, {&place, 1}).value();
  const float ox = 0, oy = 10, oz = 100, dx = 0, dy = 0, dz = -2;
  float t = 0;
  std::uint32_t primitive = 0, instance = 7;
  TraceClosest(instances, {&ox, &oy, &oz, &dx, &dy, &dz}, 1, {.t = &t, .primitive = &primitive},
               &instance)
      .value();
  CHECK(t == 49);  // (100 - 2) / 2
  CHECK(primitive == 0);
  CHECK(instance == 0);
  CHECK(instances.lower()[1] < 6);  // the disk, 4 below and a little tilted
  CHECK(instances.lower()[1] > 4.5f);
  CHECK(instances.statistics().instances == 1);
}

TEST_CASE("what cannot be placed is named") {
  const auto geometries = Geometries<float>();
  const auto fault = [&](Place place) {
    const Place places[] = {{}, place};
    const auto built = Instances::Build(geometries, places);
    return built.ok() ? std::string() : built.error().message;
  };
  CHECK(fault({}).empty());
  CHECK(fault({.geometry = 4}) == "place 1: geometry 4 of 4");
  Place flat;
  flat.to_world[10] = 0;
  CHECK(fault(flat) == "place 1: its transform flattens it");
  flat.to_world[10] = 1e-7;
  CHECK(fault(flat).empty());  // a scale a coordinate is no shear
  flat.to_world = {1, 1, 0, 0, 1, 1.0000001, 0, 0, 0, 0, 1, 0};
  CHECK(fault(flat) == "place 1: its transform flattens it");
  flat.to_world = {};
  CHECK(fault(flat) == "place 1: its transform flattens it");
  flat.to_world[3] = std::numeric_limits<double>::infinity();
  CHECK(fault(flat) == "place 1: a number of its transform is not finite");
  const std::vector<Shared<float>> none(1);
  const auto built = Instances::Build(none, {});
  REQUIRE(!built.ok());
  CHECK(built.error().message == "geometry 0 is null");
}

TEST_CASE("nothing is hit where nothing is") {
  const Instances empty;
  const float number = 1;
  float t = 0;
  std::uint32_t instance = 0, occluded = 1;
  const RayArrays rays = {&number, &number, &number, &number, &number, &number};
  TraceClosest(empty, rays, 1, {.t = &t}, &instance).value();
  CHECK(t == std::numeric_limits<float>::max());
  CHECK(instance == Instances::kNoInstance);
  TraceOccluded(empty, rays, 1, &occluded).value();
  CHECK(occluded == 0);
  CHECK(empty.lower()[0] > empty.upper()[0]);
  CHECK(!TraceClosest(empty, RayArrays{}, 1, HitArrays{}, nullptr).ok());
}

}  // namespace
}  // namespace sheaf
